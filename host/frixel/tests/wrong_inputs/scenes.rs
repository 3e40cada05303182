//! Scene files.

use super::{CASE, Case, Content};

pub(super) const SCENES: &[Case] = &[
    Case {
        what: "no such file",
        run: "scene check nowhere.toml",
        says: "nowhere.toml: this scene file cannot be read (No such file or directory (os error 2)): check \
             the path",
        ..CASE
    },
    Case {
        what: "a path with a tilde",
        run: "scene check ~/s.toml",
        says: "~/s.toml: this scene file cannot be read (No such file or directory (os error 2)): only a shell \
             replaces `~` by your folder, so write that folder's path in full",
        ..CASE
    },
    Case {
        what: "a folder in place of a file",
        run: "scene check .",
        says: ".: this scene file cannot be read (Is a directory (os error 21)): check the path",
        ..CASE
    },
    Case {
        what: "not TOML",
        scene: "[[layer]\n",
        says: "s.toml:2:9: this is not TOML: unclosed array table, expected `]`",
        ..CASE
    },
    Case {
        what: "not text",
        files: &[("s.toml", Content::Bytes(b"version = 2\n\xff\n"))],
        says: "s.toml:2:1: this byte is not UTF-8 text: save the file as UTF-8",
        ..CASE
    },
    Case {
        what: "an empty file",
        head: "",
        says: "s.toml:1:1: the scene has no `version`: write `version = 2` at the top",
        ..CASE
    },
    Case {
        what: "another version",
        head: "",
        scene: "version = 3\n",
        says: "s.toml:1:11: this scene file has version 3, and this frixel reads versions 1 and 2: use a \
             frixel that knows it",
        ..CASE
    },
    Case {
        what: "a version that is text",
        head: "",
        scene: "version = \"2\"\n",
        says: "s.toml:1:11: `version` has to be a number, and this is a text",
        ..CASE
    },
    Case {
        what: "a misspelt table",
        scene: "[scren]\n\
             width_mm = 100\n\
             height_mm = 60\n",
        says: "s.toml:2:2: unknown field `scren` in the scene; did you mean `screen`?",
        ..CASE
    },
    Case {
        what: "a misspelt field",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             frction_n = 0.3\n",
        says: "s.toml:4:1: unknown field `frction_n` in layer 1 (constant); did you mean `friction_n`?",
        ..CASE
    },
    Case {
        what: "a misspelt kind",
        scene: "[[layer]]\n\
             kind = \"gratng\"\n\
             wavelength_mm = 2\n",
        says: "s.toml:3:8: `kind = \"gratng\"` is not known; did you mean `grating`?",
        ..CASE
    },
    Case {
        what: "an unknown kind",
        scene: "[[layer]]\n\
             kind = \"xyzzy\"\n",
        says: "s.toml:3:8: `kind = \"xyzzy\"` is not known; expected one of `constant`, `grating`, `bitmap`, \
             `noise`, `edge`, `button`, `vibration`, `speed`, `stream`, `rings`",
        ..CASE
    },
    Case {
        what: "no kind",
        scene: "[[layer]]\n\
             friction_n = 0.3\n",
        says: "s.toml:2:1: layer 1 has no `kind`: write one of `constant`, `grating`,",
        ..CASE
    },
    Case {
        what: "[layer] for [[layer]]",
        scene: "[layer]\n\
             kind = \"constant\"\n\
             friction_n = 0.3\n",
        says: "s.toml:2:1: `layer` has to be a list of tables, and this is a table: write `[[layer]]`, in double \
             brackets, before the fields of each",
        ..CASE
    },
    Case {
        what: "a number in quotation marks",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_n = \"0.3\"\n",
        says: "s.toml:4:14: `friction_n` has to be a number, and this is a text",
        ..CASE
    },
    Case {
        what: "a decimal comma",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_n = 0,3\n",
        says: "s.toml:4:15: this is not TOML: unexpected key or value, expected newline, `#`; a decimal has a \
             point, not a comma",
        ..CASE
    },
    Case {
        what: "not-a-number",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_n = nan\n",
        says: "s.toml:4:14: `friction_n = NaN` is out of range: expected -100 to 100 N",
        ..CASE
    },
    Case {
        what: "infinity",
        scene: "[[layer]]\n\
             kind = \"grating\"\n\
             wavelength_mm = inf\n\
             low_n = 0\n\
             high_n = 0.02\n",
        says: "s.toml:4:17: `wavelength_mm = inf` is out of range: expected 0.05 to 2000 mm",
        ..CASE
    },
    Case {
        what: "a wavelength of zero",
        scene: "[[layer]]\n\
             kind = \"grating\"\n\
             wavelength_mm = 0\n\
             low_n = 0\n\
             high_n = 0.02\n",
        says: "s.toml:4:17: `wavelength_mm = 0` is out of range: expected 0.05 to 2000 mm",
        ..CASE
    },
    Case {
        what: "millinewtons for newtons",
        scene: "[[layer]]\n\
             kind = \"grating\"\n\
             wavelength_mm = 4\n\
             low_n = 0\n\
             high_n = 20\n",
        says: "s.toml:6:10: layer 1 (grating) asks for up to 20 N above natural friction, and at 150 V rms \
             this finger feels at most 0.1299 N above natural friction: were mN meant? 1 mN is 0.001 N; \
             lower it, or write `saturate = true` under [drive] to have it clamped",
        ..CASE
    },
    Case {
        what: "friction out of reach",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_n = 0.9\n",
        says: "s.toml:4:14: layer 1 (constant) asks for up to 0.9 N in total, and at 150 V rms this finger \
             feels at most 0.3799 N in total: lower it, or write `saturate = true` under [drive] to have it \
             clamped",
        ..CASE
    },
    Case {
        what: "less friction than bare glass",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_n = 0.1\n",
        says: "s.toml:4:14: layer 1 (constant) asks for down to 0.1 N in total, and a drive can only add to \
             the finger's natural friction of 0.25 N: raise it, or lower `normal_load_n`, or write `saturate = \
             true` under [drive] to have it clamped",
        ..CASE
    },
    Case {
        what: "low above high",
        scene: "[[layer]]\n\
             kind = \"noise\"\n\
             wavelength_min_mm = 4\n\
             wavelength_max_mm = 1\n\
             low_n = 0\n\
             high_n = 0.02\n",
        says: "s.toml:4:21: `wavelength_min_mm = 4` is above `wavelength_max_mm = 1`: swap them",
        ..CASE
    },
    Case {
        what: "an amount in two units",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_n = 0.3\n\
             friction_fraction = 0.5\n",
        says: "s.toml:5:21: `friction_n` and `friction_fraction` say the same in two units: leave one of them \
             out",
        ..CASE
    },
    Case {
        what: "a factor without multiply",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_factor = 0.5\n",
        says: "s.toml:4:1: unknown field `friction_factor` in layer 1 (constant); did you mean `friction_fraction`?",
        ..CASE
    },
    Case {
        what: "a region past the screen",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_n = 0.3\n\
             region = { x_mm = 100, y_mm = 0, width_mm = 50, height_mm = 10 }\n",
        says: "s.toml:5:10: layer 1 (constant) reaches 30 mm past the right edge of the 120 mm x 80 mm screen: \
             move it or make it smaller",
        ..CASE
    },
    Case {
        what: "a region without a height",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_n = 0.3\n\
             region = { x_mm = 0, y_mm = 0, width_mm = 50 }\n",
        says: "s.toml:5:10: this region has no `height_mm`: add it",
        ..CASE
    },
    Case {
        what: "a polygon of two points",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_n = 0.3\n\
             region = { shape = \"polygon\", points_mm = [[0, 0], [10, 10]] }\n",
        says: "s.toml:5:43: `points_mm` has 2 entries: expected 3 to 32",
        ..CASE
    },
    Case {
        what: "a button without a region",
        scene: "[[layer]]\n\
             kind = \"button\"\n\
             rim_width_mm = 2\n\
             rim_n = 0.02\n\
             face_n = 0\n",
        says: "s.toml:2:1: layer 1 (button) has no `region`: add it",
        ..CASE
    },
    Case {
        what: "a rim and a click out of reach",
        scene: "[[layer]]\n\
             name = \"OK\"\n\
             kind = \"button\"\n\
             region = { x_mm = 0, y_mm = 0, width_mm = 20, height_mm = 20 }\n\
             rim_width_mm = 2\n\
             rim_n = 0.09\n\
             face_n = 0\n\
             click_n = 0.09\n",
        says: "s.toml:7:9: layer 1 \"OK\", with its `rim_n = 0.09` and its `click_n = 0.09` together, asks for up to 0.18 N above \
             natural friction, and at 150 V rms this finger feels at most 0.1299 N above natural friction: lower one of \
             them, raise `voltage_max_v_rms` to 172, or write `saturate = true` under [drive] to have it clamped",
        ..CASE
    },
    Case {
        what: "too many layers",
        times: 65,
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_n = 0.3\n",
        says: "s.toml:194:1: the scene has 65 layers, and the board takes 64: leave some out or draw them into one \
             picture",
        ..CASE
    },
    Case {
        what: "nine layers of noise",
        times: 9,
        scene: "[[layer]]\n\
             kind = \"noise\"\n\
             wavelength_min_mm = 1\n\
             wavelength_max_mm = 4\n\
             low_n = 0\n\
             high_n = 0.001\n\
             region = { x_mm = 0, y_mm = 0, width_mm = 4, height_mm = 4 }\n",
        says: "s.toml:58:1: this is number 9 of the scene's layers of noise, and a board takes 8: leave some \
             out",
        ..CASE
    },
    Case {
        what: "a tick that takes too long",
        times: 5,
        scene: "[[layer]]\n\
             kind = \"noise\"\n\
             blend = \"add\"\n\
             wavelength_min_mm = 1\n\
             wavelength_max_mm = 4\n\
             low_n = 0\n\
             high_n = 0.001\n",
        says: "s.toml:30:1: layer 1 (noise) and layer 2 (noise) and layer 3 (noise) and layer 4 (noise) and \
             layer 5 (noise) meet at x 3.7 mm, y 2.5 mm: a tick there is estimated at 3553 cycles, and the \
             board has time for 2550: move layers apart, or leave some out",
        ..CASE
    },
    Case {
        what: "copies in one place",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_n = 0.3\n\
             repeat = { columns = 3 }\n",
        says: "s.toml:5:10: the columns of this repeat would lie on one another: give the distance from one to \
             the next, `dx_mm`",
        ..CASE
    },
    Case {
        what: "speeds that fall",
        scene: "[[layer]]\n\
             kind = \"speed\"\n\
             speeds_mm_per_s = [100, 20]\n\
             factors = [0, 1]\n",
        says: "s.toml:4:19: the speeds of a curve have to rise, by 0.02 mm/s or more from each to the next, \
             and 20 comes after 100: sort them",
        ..CASE
    },
    Case {
        what: "speeds without factors",
        scene: "[[layer]]\n\
             kind = \"speed\"\n\
             speeds_mm_per_s = [20, 100]\n\
             factors = [0]\n",
        says: "s.toml:5:11: `factors` has 1 entry: expected 2",
        ..CASE
    },
    Case {
        what: "a voltage above the board's peak",
        scene: "[drive]\n\
             voltage_max_v_peak = 500\n",
        says: "s.toml:3:22: `voltage_max_v_peak = 500` is above the board's limit of 220 V peak: lower it or \
             leave it out",
        ..CASE
    },
    Case {
        what: "a carrier that is too fast",
        scene: "[carrier]\n\
             frequency_hz = 20000\n",
        says: "s.toml:3:16: `frequency_hz = 20000` is too fast for 40000 ticks a second: expected at most 5000 \
             Hz",
        ..CASE
    },
    Case {
        what: "a scene of version 1 with another finger",
        head: "",
        scene: "version = 1\n\
             [screen]\n\
             width_mm = 120\n\
             height_mm = 80\n\
             [coating]\n\
             thickness_um = 10\n\
             permittivity = 1\n\
             [finger]\n\
             radius_mm = 8\n\
             stiffness_pa_per_m = 1.8e7\n\
             friction_coefficient = 0.5\n\
             normal_load_n = 0.5\n",
        run: "scene check s.toml --finger moist",
        says: "s.toml:1:11: the coating of a scene of version 1 contains the finger's skin, so that it cannot \
             be played with another finger: `frixel scene migrate s.toml` prints it as version 2",
        ..CASE
    },
    Case {
        what: "migrating a scene of version 2",
        run: "scene migrate s.toml",
        says: "s.toml:1:11: this scene has version 2 already: there is nothing to migrate",
        ..CASE
    },
    Case {
        what: "a region's fields straight in a layer",
        scene: "[[layer]]\n\
             kind = \"button\"\n\
             x_mm = 10\n\
             y_mm = 10\n\
             width_mm = 20\n\
             height_mm = 12.5\n\
             rim_width_mm = 2\n\
             rim_n = 0.02\n\
             face_n = 0\n",
        says: "s.toml:4:1: `x_mm`, `y_mm`, `width_mm` and `height_mm` in layer 1 (button) belong in `region`: write `region = \
             { x_mm = 10, y_mm = 10, width_mm = 20, height_mm = 12.5 }`",
        ..CASE
    },
    Case {
        what: "a region as a list",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             region = [5, 10, 20.5, 30]\n\
             friction_n = 0.3\n",
        says: "s.toml:4:10: `region` has to be a table, and this is a list: write `region = { x_mm = 5, y_mm = 10, width_mm \
             = 20.5, height_mm = 30 }`",
        ..CASE
    },
    Case {
        what: "[layer] twice",
        scene: "[layer]\n\
             kind = \"constant\"\n\
             friction_n = 0.3\n\
             [layer]\n\
             kind = \"constant\"\n\
             friction_n = 0.3\n",
        says: "s.toml:5:2: this is not TOML: duplicate key; write `[[layer]]`, in double brackets, before the fields of each \
             layer",
        ..CASE
    },
    Case {
        what: "a comma in a number",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_n = 0,3\n",
        says: "s.toml:4:15: this is not TOML: unexpected key or value, expected newline, `#`; a decimal has a point, not \
             a comma",
        ..CASE
    },
    Case {
        what: "commas after fields",
        scene: "[[layer]]\n\
             kind = \"constant\",\n\
             friction_n = 0.3,\n",
        says: "s.toml:3:18: this is not TOML: unexpected key or value, expected newline, `#`; leave the comma out: each \
             field has a line of its own",
        ..CASE
    },
    Case {
        what: "saturate at the top",
        scene: "saturate = true\n\
             [[layer]]\n\
             kind = \"constant\"\n\
             friction_n = 0.9\n",
        says: "s.toml:2:1: `saturate` in the scene belongs to [drive]: write it below a line `[drive]`",
        ..CASE
    },
    Case {
        what: "saturate in a layer",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_n = 0.9\n\
             saturate = true\n",
        says: "s.toml:5:1: `saturate` in layer 1 (constant) belongs to [drive]: write it below a line `[drive]`",
        ..CASE
    },
    Case {
        what: "a number of copies",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_n = 0.3\n\
             repeat = 11\n",
        says: "s.toml:5:10: `repeat` has to be a table, and this is a number: write `repeat = { columns = 11, dx_mm = 10 }`, \
             with the distance from a copy to the next",
        ..CASE
    },
    Case {
        what: "a button without the friction of its face",
        scene: "[[layer]]\n\
             kind = \"button\"\n\
             region = { x_mm = 0, y_mm = 0, width_mm = 20, height_mm = 20 }\n\
             rim_width_mm = 2\n\
             rim_fraction = 0.8\n",
        says: "s.toml:2:1: layer 1 (button) has no `face_n` or `face_fraction`: add one of them",
        ..CASE
    },
    Case {
        what: "a kind in capitals",
        scene: "[[layer]]\n\
             kind = \"CONSTANT\"\n\
             friction_n = 0.3\n",
        says: "s.toml:3:8: `kind = \"CONSTANT\"` is not known; did you mean `constant`?",
        ..CASE
    },
    Case {
        what: "a field in capitals",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             Friction_N = 0.3\n",
        says: "s.toml:4:1: unknown field `Friction_N` in layer 1 (constant); did you mean `friction_n`?",
        ..CASE
    },
    Case {
        what: "a face and a click out of reach",
        scene: "[[layer]]\n\
             name = \"OK\"\n\
             kind = \"button\"\n\
             region = { x_mm = 0, y_mm = 0, width_mm = 20, height_mm = 20 }\n\
             rim_width_mm = 2\n\
             rim_fraction = 0.2\n\
             face_fraction = 0.8\n\
             click_fraction = 0.5\n",
        says: "s.toml:8:17: layer 1 \"OK\", with its `face_fraction = 0.8` and its `click_fraction = 0.5` together, asks for up to \
             0.169 N above natural friction (1.3 of the reach), and at 150 V rms this finger feels at most 0.1299 N above \
             natural friction: lower one of them, or write `saturate = true` under [drive] to have it clamped",
        ..CASE
    },
    Case {
        what: "copies that are too many",
        scene: "[[layer]]\n\
             name = \"key\"\n\
             kind = \"constant\"\n\
             friction_n = 0.3\n\
             region = { x_mm = 0, y_mm = 0, width_mm = 1, height_mm = 1 }\n\
             repeat = { columns = 33, rows = 2, dx_mm = 2, dy_mm = 2 }\n",
        says: "s.toml:2:1: the scene has 66 layers, each copy of a `repeat` counted, and the board takes 64: leave some out \
             or draw them into one picture",
        ..CASE
    },
    Case {
        what: "detents whose time is too long",
        scene: "[[layer]]\n\
             name = \"detent\"\n\
             kind = \"edge\"\n\
             x_mm = 20\n\
             y_mm = 10\n\
             width_mm = 2\n\
             ridge_fraction = 0.3\n\
             repeat = { columns = 11, dx_mm = 8 }\n",
        says: "s.toml:2:1: layer 1.1 \"detent 1\" with 10 more copies meet at x",
        ..CASE
    },
    Case {
        what: "three files in a circle",
        scene: "include = [\"a.toml\"]\n",
        files: &[
            ("a.toml", Content::Text("version = 2\ninclude = [\"./b.toml\"]\n")),
            ("b.toml", Content::Text("version = 2\ninclude = [\"s.toml\"]\n")),
        ],
        says: "b.toml:2:12: b.toml includes s.toml, which includes a.toml, which includes b.toml itself: take one of them \
             out",
        ..CASE
    },
    Case {
        what: "one file by two names",
        scene: "include = [\"a.toml\", \".//a.toml\"]\n",
        files: &[("a.toml", Content::Text("version = 2\n"))],
        says: "s.toml:2:22: a.toml is included twice by s.toml: a scene includes each file once, so leave one of them out",
        ..CASE
    },
    Case {
        what: "an included file of a later version",
        scene: "include = [\"a.toml\"]\n",
        files: &[("a.toml", Content::Text("version = 3\n"))],
        says: "a.toml:1:11: s.toml includes a.toml, which has version 3 and not 2: use a frixel that knows it",
        ..CASE
    },
    Case {
        what: "a default that no layer uses, and that no kind takes",
        scene: "[defaults]\n\
             face_fraction = 30\n",
        says: "s.toml:3:17: `face_fraction = 30` is out of range: expected -1 to 1",
        ..CASE
    },
    Case {
        what: "a misspelt default of a field that layers need",
        scene: "[defaults]\n\
             face_fracion = 0.3\n\
             [[layer]]\n\
             kind = \"button\"\n\
             region = { x_mm = 0, y_mm = 0, width_mm = 20, height_mm = 20 }\n\
             rim_width_mm = 2\n\
             rim_fraction = 0.8\n",
        says: "s.toml:3:1: unknown field `face_fracion` in [defaults]; did you mean `face_fraction`?",
        ..CASE
    },
];
