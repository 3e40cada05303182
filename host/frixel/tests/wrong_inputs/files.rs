//! Pictures, profiles, strokes, streams and tables of numbers.

use super::{CASE, Case, Content};

pub(super) const PICTURES: &[Case] = &[
    Case {
        what: "no such picture",
        scene: "[[layer]]\n\
             kind = \"bitmap\"\n\
             picture = \"wood.png\"\n\
             x_mm = 0\n\
             y_mm = 0\n\
             width_mm = 40\n",
        says: "s.toml:4:11: picture \"wood.png\" was not found in this folder: paths start from the folder of \
             the file that names it",
        ..CASE
    },
    Case {
        what: "a misspelt picture",
        scene: "[[layer]]\n\
             kind = \"bitmap\"\n\
             picture = \"wod.png\"\n\
             x_mm = 0\n\
             y_mm = 0\n\
             width_mm = 40\n",
        files: &[("wood.png", Content::Bytes(b"x"))],
        says: "s.toml:4:11: picture \"wod.png\" was not found in this folder, which has \"wood.png\": paths \
             start from the folder of the file that names it",
        ..CASE
    },
    Case {
        what: "a picture in a home folder",
        scene: "[[layer]]\n\
             kind = \"bitmap\"\n\
             picture = \"~/wood.png\"\n\
             x_mm = 0\n\
             y_mm = 0\n\
             width_mm = 40\n",
        says: "s.toml:4:11: picture \"~/wood.png\" was not found in ~: only a shell replaces `~` by your \
             folder, so write that folder's path in full",
        ..CASE
    },
    Case {
        what: "no name",
        scene: "[[layer]]\n\
             kind = \"bitmap\"\n\
             picture = \"\"\n\
             x_mm = 0\n\
             y_mm = 0\n\
             width_mm = 40\n",
        says: "s.toml:4:11: `picture` names no file: write its name between the quotation marks",
        ..CASE
    },
    Case {
        what: "a folder for a picture",
        scene: "[[layer]]\n\
             kind = \"bitmap\"\n\
             picture = \".\"\n\
             x_mm = 0\n\
             y_mm = 0\n\
             width_mm = 40\n",
        says: "s.toml:4:11: picture \".\" cannot be used: it cannot be read (it is a folder)",
        ..CASE
    },
    Case {
        what: "a text for a picture",
        scene: "[[layer]]\n\
             kind = \"bitmap\"\n\
             picture = \"wood.png\"\n\
             x_mm = 0\n\
             y_mm = 0\n\
             width_mm = 40\n",
        files: &[("wood.png", Content::Text("wood"))],
        says: "s.toml:4:11: picture \"wood.png\" cannot be used: it is neither a PNG nor a JPEG file: save it as PNG",
        ..CASE
    },
    Case {
        what: "an empty file for a picture",
        scene: "[[layer]]\n\
             kind = \"bitmap\"\n\
             picture = \"wood.png\"\n\
             x_mm = 0\n\
             y_mm = 0\n\
             width_mm = 40\n",
        files: &[("wood.png", Content::Text(""))],
        says: "s.toml:4:11: picture \"wood.png\" cannot be used: it is neither a PNG nor a JPEG file: save it as PNG",
        ..CASE
    },
    Case {
        what: "a damaged picture",
        scene: "[[layer]]\n\
             kind = \"bitmap\"\n\
             picture = \"cut.png\"\n\
             x_mm = 0\n\
             y_mm = 0\n\
             width_mm = 40\n",
        files: &[("cut.png", Content::HalfBrick)],
        says: "s.toml:4:11: picture \"cut.png\" cannot be used: it is damaged (unexpected end of file): save \
             it again",
        ..CASE
    },
    Case {
        what: "too many bytes",
        scene: "[[layer]]\n\
             kind = \"bitmap\"\n\
             picture = \"brick.png\"\n\
             x_mm = 0\n\
             y_mm = 0\n\
             width_mm = 40\n\
             pitch_mm = 0.05\n",
        files: &[("brick.png", Content::Brick)],
        says: "s.toml:8:12: the pictures up to this one need 640000 bytes, and the board has 65536: a pitch_mm \
             of 0.16 would fit",
        ..CASE
    },
    Case {
        what: "a pitch out of range",
        scene: "[[layer]]\n\
             kind = \"bitmap\"\n\
             picture = \"brick.png\"\n\
             x_mm = 0\n\
             y_mm = 0\n\
             width_mm = 40\n\
             pitch_mm = 0\n",
        files: &[("brick.png", Content::Brick)],
        says: "s.toml:8:12: `pitch_mm = 0` is out of range: expected 0.02 to 10 mm",
        ..CASE
    },
];

pub(super) const PROFILES: &[Case] = &[
    Case {
        what: "a bundled finger, misspelt",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_fraction = 0.3\n",
        run: "scene check s.toml --finger drie",
        says: "drie: this finger cannot be read (No such file or directory (os error 2)): did you mean `dry`?",
        ..CASE
    },
    Case {
        what: "a bundled screen, misspelt",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_fraction = 0.3\n",
        run: "scene check s.toml --screen Exmple",
        says: "Exmple: this screen cannot be read (No such file or directory (os error 2)): did you mean `example`?",
        ..CASE
    },
    Case {
        what: "no such finger",
        run: "scene check s.toml --finger nobody",
        says: "nobody: this finger cannot be read (No such file or directory (os error 2)): give its file, or \
             a bundled one: example, dry, moist, light",
        ..CASE
    },
    Case {
        what: "no such finger in a scene",
        scene: "finger = \"mosit\"\n",
        says: "s.toml:2:10: no finger \"mosit\" is bundled, and the name of a file has an ending such as \
             .toml; did you mean `moist`?",
        ..CASE
    },
    Case {
        what: "no such file of a finger",
        scene: "finger = \"anna.toml\"\n",
        says: "s.toml:2:10: finger \"anna.toml\" was not found in this folder: paths start from the folder of \
             the file that names it",
        ..CASE
    },
    Case {
        what: "a finger without a load",
        files: &[(
            "f.toml",
            Content::Text(
                "friction_coefficient = 0.5\n\
             radius_mm = 8\n\
             stiffness_pa_per_m = 1.8e7\n\
             skin_gap_um = 4\n",
            ),
        )],
        run: "scene check s.toml --finger f.toml",
        says: "f.toml:1:1: this finger profile has no `normal_load_n`: add it",
        ..CASE
    },
    Case {
        what: "a finger without skin",
        scene: "[finger]\n\
             friction_coefficient = 0.5\n\
             normal_load_n = 0.5\n\
             radius_mm = 8\n\
             stiffness_pa_per_m = 1.8e7\n\
             skin_gap_um = 0\n",
        says: "s.toml:2:1: at 150.0 V rms the contact would have a radius of 51.9 mm under a finger of 8 mm, \
             where the model is not valid: a skin gap is missing, since 0.26 um between electrode and finger \
             are too few; give the finger a `skin_gap_um` of some micrometres (in version 1 another slab of \
             [[coating]]), or lower `voltage_max_v_rms`",
        ..CASE
    },
    Case {
        what: "a measured finger without its experiment",
        scene: "[finger]\n\
             friction_coefficient = 0.5\n\
             normal_load_n = 0.5\n\
             radius_mm = 8\n\
             stiffness_pa_per_m = 1.8e7\n\
             skin_gap_um = 4\n\
             origin = \"measured\"\n",
        lines: 7,
        says: "s.toml:2:1: [finger] has no `date`: add it",
        ..CASE
    },
    Case {
        what: "a day that is none",
        scene: "[finger]\n\
             friction_coefficient = 0.5\n\
             normal_load_n = 0.5\n\
             radius_mm = 8\n\
             stiffness_pa_per_m = 1.8e7\n\
             skin_gap_um = 4\n\
             origin = \"perceptual\"\n\
             date = \"yesterday\"\n\
             method = \"a\"\n\
             screen = \"b\"\n\
             threshold_v_rms = 10\n\
             threshold_interval_v_rms = [5, 20]\n",
        says: "s.toml:9:8: `date = \"yesterday\"` is not a day: write it as \"YYYY-MM-DD\"",
        ..CASE
    },
    Case {
        what: "no such screen",
        run: "scene check s.toml --screen tablet.toml",
        says: "tablet.toml: this screen cannot be read (No such file or directory (os error 2)): give its \
             file, or a bundled one: example",
        ..CASE
    },
    Case {
        what: "a screen without a width",
        files: &[("t.toml", Content::Text("height_mm = 80\n"))],
        run: "scene check s.toml --screen t.toml",
        says: "t.toml:1:1: this screen has no `width_mm`: add it",
        ..CASE
    },
];

pub(super) const STROKES: &[Case] = &[
    Case {
        what: "no such stroke",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_n = 0.3\n",
        run: "play s.toml --stroke pen.csv",
        says: "pen.csv cannot be read (No such file or directory (os error 2)): check the path",
        ..CASE
    },
    Case {
        what: "an empty stroke",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_n = 0.3\n",
        files: &[("pen.csv", Content::Text(""))],
        run: "play s.toml --stroke pen.csv",
        says: "pen.csv: the stroke is empty: expected a header `t_s,x_mm,y_mm` and at least two rows below it",
        ..CASE
    },
    Case {
        what: "a stroke without a column",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_n = 0.3\n",
        files: &[(
            "pen.csv",
            Content::Text(
                "t_s,x_mm\n\
             0,1\n\
             1,2\n",
            ),
        )],
        run: "play s.toml --stroke pen.csv",
        says: "pen.csv: line 1: no column `y_mm` in the header `t_s,x_mm`: expected `t_s,x_mm,y_mm`",
        ..CASE
    },
    Case {
        what: "a stroke of one row",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_n = 0.3\n",
        files: &[(
            "pen.csv",
            Content::Text(
                "t_s,x_mm,y_mm\n\
             0,1,1\n",
            ),
        )],
        run: "play s.toml --stroke pen.csv",
        says: "pen.csv: line 2: the stroke has one row only: expected at least two, so that the finger moves \
             in time",
        ..CASE
    },
    Case {
        what: "a word for a number",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_n = 0.3\n",
        files: &[(
            "pen.csv",
            Content::Text(
                "t_s,x_mm,y_mm\n\
             0,1,1\n\
             1,left,1\n",
            ),
        )],
        run: "play s.toml --stroke pen.csv",
        says: "pen.csv: line 3, column `x_mm`: `left` is no number: expected one such as `12.5`",
        ..CASE
    },
    Case {
        what: "time that goes back",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_n = 0.3\n",
        files: &[(
            "pen.csv",
            Content::Text(
                "t_s,x_mm,y_mm\n\
             0,1,1\n\
             2,2,2\n\
             1,3,3\n",
            ),
        )],
        run: "play s.toml --stroke pen.csv",
        says: "pen.csv: line 4, column `t_s`: 1 comes after 2: expected time to rise from row to row",
        ..CASE
    },
    Case {
        what: "time before the start",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_n = 0.3\n",
        files: &[(
            "pen.csv",
            Content::Text(
                "t_s,x_mm,y_mm\n\
             -1,1,1\n\
             2,2,2\n",
            ),
        )],
        run: "play s.toml --stroke pen.csv",
        says: "pen.csv: line 2, column `t_s`: -1 is below 0: expected time from the start of the stroke",
        ..CASE
    },
    Case {
        what: "time in milliseconds",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_n = 0.3\n",
        files: &[(
            "pen.csv",
            Content::Text(
                "t_s,x_mm,y_mm\n\
             0,1,1\n\
             200000,2,2\n",
            ),
        )],
        run: "play s.toml --stroke pen.csv",
        says: "pen.csv lasts 200000 s, longer than a day (86400 s): give a shorter stroke; its times are in \
             seconds",
        ..CASE
    },
    Case {
        what: "a stroke off the screen",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_n = 0.3\n",
        files: &[(
            "pen.csv",
            Content::Text(
                "t_s,x_mm,y_mm\n\
             0,500,1\n\
             1,600,2\n",
            ),
        )],
        run: "play s.toml --stroke pen.csv",
        says: "pen.csv is nowhere on the screen, which is 120 by 80 mm: give places in mm from its top left \
             corner",
        ..CASE
    },
    Case {
        what: "a load that is none",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_n = 0.3\n",
        files: &[(
            "pen.csv",
            Content::Text(
                "t_s,x_mm,y_mm,force_n\n\
             0,1,1,0.5\n\
             1,2,2,-3\n",
            ),
        )],
        run: "play s.toml --stroke pen.csv",
        says: "pen.csv: line 3, column `force_n`: -3 is no load of a finger: expected newtons, above 0 and at \
             most 50",
        ..CASE
    },
    Case {
        what: "a row that is too short",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_n = 0.3\n",
        files: &[(
            "pen.csv",
            Content::Text(
                "t_s,x_mm,y_mm\n\
             0,1,1\n\
             1,2\n",
            ),
        )],
        run: "play s.toml --stroke pen.csv",
        says: "pen.csv: line 3, column `y_mm`: empty: expected a number",
        ..CASE
    },
    Case {
        what: "a picture for a stroke",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_n = 0.3\n",
        files: &[("pen.csv", Content::Bytes(b"\x89PNG\xff"))],
        run: "play s.toml --stroke pen.csv",
        says: "pen.csv is not UTF-8 text: save it as UTF-8, a CSV file with the columns t_s,x_mm,y_mm",
        ..CASE
    },
    Case {
        what: "from without to",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_n = 0.3\n",
        run: "play s.toml --from 0,0",
        code: 2,
        says: "the following required arguments were not provided:\n  --to <X,Y>",
        ..CASE
    },
    Case {
        what: "a place that is none",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_n = 0.3\n",
        run: "play s.toml --from 0 --to 1,1",
        code: 2,
        says: "invalid value '0' for '--from <X,Y>': expected a place in mm from the top left corner of the \
             screen, for example 12,34.5",
        ..CASE
    },
    Case {
        what: "from and to alike",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_n = 0.3\n",
        run: "play s.toml --from 5,5 --to 5,5",
        says: "--from and --to are the same place: give two places that differ",
        ..CASE
    },
    Case {
        what: "a speed of zero",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_n = 0.3\n",
        run: "play s.toml --from 0,0 --to 5,5 --speed 0",
        code: 2,
        says: "invalid value '0' for '--speed <MM_PER_S>': expected a speed above 0, at most 10000 mm/s",
        ..CASE
    },
    Case {
        what: "a stroke on a board",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_n = 0.3\n",
        run: "play s.toml --port /dev/null --stroke human",
        says: "a stroke moves the finger of --port sim and --port qemu only; a board at /dev/null has its own: \
             leave out --stroke and --from",
        ..CASE
    },
];

pub(super) const STREAMS: &[Case] = &[
    Case {
        what: "no such file",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_n = 0.3\n",
        run: "play s.toml --stream a.wav",
        says: "a.wav cannot be streamed (No such file or directory (os error 2)): give a WAV file of 8, 16, 24 \
             or 32 bits, or of 32-bit floats",
        ..CASE
    },
    Case {
        what: "no WAV file",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_n = 0.3\n",
        files: &[("a.wav", Content::Text("beep"))],
        run: "play s.toml --stream a.wav",
        says: "a.wav cannot be streamed (Ill-formed WAVE file: no RIFF tag found): give a WAV file of 8, 16, \
             24 or 32 bits, or of 32-bit floats",
        ..CASE
    },
    Case {
        what: "raw samples without a rate",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_n = 0.3\n",
        run: "play s.toml --stream -",
        says: "samples on standard input have no rate of their own: put --stream-hz beside --stream -",
        ..CASE
    },
    Case {
        what: "a rate without samples",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_n = 0.3\n",
        run: "play s.toml --stream-hz 1000",
        says: "--stream-hz says how many samples a second come on standard input: put --stream - before it, or \
             leave it out",
        ..CASE
    },
    Case {
        what: "a rate above the ticks",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_n = 0.3\n",
        run: "play s.toml --stream - --stream-hz 100000",
        says: "a stream of 100000 samples a second cannot be played: give 1 to 40000, the board's ticks a \
             second",
        ..CASE
    },
    Case {
        what: "a stream for no layer",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_n = 0.3\n",
        run: "play s.toml --stream - --stream-hz 1000",
        stdin: "\0\0\0\0",
        says: "s.toml has no layer that plays a stream: add one with `kind = \"stream\"`, or leave --stream \
             out",
        ..CASE
    },
];

pub(super) const DATA: &[Case] = &[
    Case {
        what: "a model without rows",
        run: "model eval",
        says: "standard input: the header has no column variant: name the column so, in a word such as wf-loaded",
        ..CASE
    },
    Case {
        what: "a model row that is invalid",
        run: "model eval",
        stdin: "variant,radius_m\n\
             bound,1\n",
        says: "standard input: the header has no column coating_m: name the column so, in metres",
        ..CASE
    },
    Case {
        what: "a fit without rows",
        files: &[("d.csv", Content::Text("voltage_v_rms,normal_force_n,friction_n\n"))],
        run: "fit d.csv -o f.toml",
        says: "d.csv: 0 strokes are too few for an interval: record at least 8, 60 s of strokes back and forth \
             are best",
        ..CASE
    },
    Case {
        what: "a fit without a column",
        files: &[(
            "d.csv",
            Content::Text(
                "voltage_v_rms,friction_n\n\
             1,2\n",
            ),
        )],
        run: "fit d.csv -o f.toml",
        says: "d.csv: the header has no column normal_force_n: name the column so, in newtons",
        ..CASE
    },
    Case {
        what: "a fit of no file",
        run: "fit d.csv -o f.toml",
        says: "d.csv cannot be read (No such file or directory (os error 2)): check the path",
        ..CASE
    },
    Case {
        what: "a fit of one row",
        files: &[(
            "d.csv",
            Content::Text(
                "voltage_v_rms,normal_force_n,friction_n\n\
             1,1,1\n",
            ),
        )],
        run: "fit d.csv -o f.toml",
        says: "d.csv: 1 row without a column stroke is too few: record at least 120 rows, or number the \
             strokes in a column stroke",
        ..CASE
    },
];
