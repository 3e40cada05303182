//! Options, control lines and ports.

use super::{CASE, Case, Content};

pub(super) const OPTIONS: &[Case] = &[
    Case {
        what: "no command that is known",
        run: "ply s.toml",
        code: 2,
        says: "unrecognized subcommand 'ply'\n\n  tip: a similar subcommand exists: 'play'",
        ..CASE
    },
    Case {
        what: "an option that is not known",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_n = 0.3\n",
        run: "play s.toml --sed 3",
        code: 2,
        says: "unexpected argument '--sed' found\n\n  tip: a similar argument exists: '--seed'",
        ..CASE
    },
    Case {
        what: "no scene",
        run: "play",
        code: 2,
        says: "the following required arguments were not provided:\n  <SCENE>",
        ..CASE
    },
    Case {
        what: "seconds below zero",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_n = 0.3\n",
        run: "play s.toml --seconds -1",
        code: 2,
        says: "invalid value '-1' for '--seconds <S>': expected a number of seconds above 0, at most a day",
        ..CASE
    },
    Case {
        what: "seconds that are a word",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_n = 0.3\n",
        run: "play s.toml --seconds long",
        code: 2,
        says: "invalid value 'long' for '--seconds <S>': expected a number of seconds above 0, at most a day",
        ..CASE
    },
    Case {
        what: "less than a tick",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_n = 0.3\n",
        run: "play s.toml --seconds 0.00001",
        says: "0.00001 s is shorter than one tick of the board, 0.000025 s: play for longer",
        ..CASE
    },
    Case {
        what: "rows that do not divide the ticks",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_n = 0.3\n",
        run: "play s.toml --csv-hz 300",
        says: "--csv-hz 300 does not divide the board's 40000 ticks a second; give 250 or 320",
        ..CASE
    },
    Case {
        what: "a seed below zero",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_n = 0.3\n",
        run: "play s.toml --seed -1",
        code: 2,
        says: "invalid value '-1' for '--seed <SEED>': expected a whole number from 0 to 18446744073709551615",
        ..CASE
    },
    Case {
        what: "a folder that is a file",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_n = 0.3\n",
        run: "play s.toml --seconds 0.1 --out s.toml",
        says: "s.toml cannot be written (File exists (os error 17)): check the folder and its free space",
        ..CASE
    },
    Case {
        what: "a preview that is no PNG",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_n = 0.3\n",
        run: "scene preview s.toml -o map.jpg",
        says: "map.jpg is no PNG file by its name: give the picture a name that ends in .png",
        ..CASE
    },
    Case {
        what: "a preview in no folder",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_n = 0.3\n",
        run: "scene preview s.toml -o nowhere/map.png",
        says: "nowhere/map.png cannot be written (No such file or directory (os error 2)): check the folder \
             and its free space",
        ..CASE
    },
    Case {
        what: "a speed that is too high",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_n = 0.3\n",
        run: "scene preview s.toml -o m.png --speed-mm-per-s 1e9",
        code: 2,
        says: "invalid value '1e9' for '--speed-mm-per-s <MM_PER_S>': expected a speed from 0 to 10000 mm/s",
        ..CASE
    },
    Case {
        what: "a scene that is there",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_n = 0.3\n",
        run: "new s.toml",
        says: "s.toml is there already, and is not overwritten: give another name, or remove it",
        ..CASE
    },
    Case {
        what: "a scene without a name",
        run: "new .toml",
        says: "\".toml\" has no name for a scene: give one such as wood, or scenes/wood.toml",
        ..CASE
    },
    Case {
        what: "a picture that is not there",
        run: "new s --picture wood.png",
        says: "wood.png cannot be read (No such file or directory (os error 2)): check the path",
        ..CASE
    },
    Case {
        what: "watch and control",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_n = 0.3\n",
        run: "play s.toml --watch --control",
        says: "--watch on the simulator plays anew after each change, and standard input can be read only \
             once: leave out --control or --stream -, or start `frixel sim` and give its port",
        ..CASE
    },
    Case {
        what: "watch on the emulator",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_n = 0.3\n",
        run: "play s.toml --watch --port qemu",
        says: "--watch follows the file while a board plays in real time, --port qemu does not: start `frixel \
             sim` and give its port",
        ..CASE
    },
    Case {
        what: "a log without a port",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_n = 0.3\n",
        run: "play s.toml --with-log a.csv",
        says: "--with-log joins the log of a virtual board at a port, --port sim records what is felt itself: \
             leave it out",
        ..CASE
    },
    Case {
        what: "a part of another command",
        run: "check s.toml",
        code: 2,
        says: "unrecognized subcommand 'check'\n\n  tip: write `frixel scene check`\n",
        ..CASE
    },
    Case {
        what: "a picture that is text",
        files: &[("x.png", Content::Text("no picture"))],
        run: "new s2 --picture x.png",
        says: "x.png is no picture that can be played: it is neither a PNG nor a JPEG file: save it as PNG",
        ..CASE
    },
];

/// Layers that change while they play: one, three copies of another, and bursts.
const LIVE: &str = "[[layer]]\n\
             name = \"OK\"\n\
             kind = \"constant\"\n\
             friction_n = 0.3\n\
             region = { x_mm = 0, y_mm = 0, width_mm = 9, height_mm = 9 }\n\
             live = true\n\
             [[layer]]\n\
             name = \"key\"\n\
             kind = \"grating\"\n\
             wavelength_mm = 4\n\
             low_n = 0.01\n\
             high_n = 0.1\n\
             region = { x_mm = 20, y_mm = 0, width_mm = 9, height_mm = 9 }\n\
             repeat = { columns = 3, dx_mm = 10 }\n\
             live = true\n\
             [[layer]]\n\
             name = \"buzz\"\n\
             kind = \"vibration\"\n\
             frequency_hz = 80\n\
             low_n = 0\n\
             high_n = 0.01\n\
             region = { x_mm = 0, y_mm = 20, width_mm = 9, height_mm = 9 }\n\
             burst = { period_ms = 1000, on_ms = 400 }\n\
             live = true\n";

pub(super) const CONTROLS: &[Case] = &[
    Case {
        what: "an unknown word",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_n = 0.3\n\
             live = true\n",
        run: "play s.toml --control --seconds 0.1",
        stdin: "lyer 1 off\n",
        code: 0,
        says: "line 1 of standard input: `lyer` is no control word: write layer, trigger, replace, wait or \
             quit",
        ..CASE
    },
    Case {
        what: "a layer that is not there",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_n = 0.3\n\
             live = true\n",
        run: "play s.toml --control --seconds 0.1",
        stdin: "layer \"OK\" off\n",
        code: 0,
        says: "line 1 of standard input: the scene has no layer \"OK\": give the name of a layer, or its \
             number, 1",
        ..CASE
    },
    Case {
        what: "a layer that is not live",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_n = 0.3\n",
        run: "play s.toml --control --seconds 0.1",
        stdin: "layer 1 off\n",
        code: 0,
        says: "line 1 of standard input: layer \"1\" may be merged with others: write `live = true` in the \
             file to change it while it plays",
        ..CASE
    },
    Case {
        what: "a line that ends too early",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_n = 0.3\n\
             live = true\n",
        run: "play s.toml --control --seconds 0.1",
        stdin: "layer 1 gain\n",
        code: 0,
        says: "line 1 of standard input: `layer 1 gain` ends too early: write on, off, or gain and a number \
             from -100 to 100",
        ..CASE
    },
    Case {
        what: "a gain that is a word",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_n = 0.3\n\
             live = true\n",
        run: "play s.toml --control --seconds 0.1",
        stdin: "layer 1 gain half\n",
        code: 0,
        says: "line 1 of standard input: `half` is unexpected here: write on, off, or gain and a number from \
             -100 to 100",
        ..CASE
    },
    Case {
        what: "a quotation mark that is not closed",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_n = 0.3\n\
             live = true\n",
        run: "play s.toml --control --seconds 0.1",
        stdin: "layer \"OK off\n",
        code: 0,
        says: "line 1 of standard input: the quotation mark of `\"OK off` is not closed: put one behind the \
             name",
        ..CASE
    },
    Case {
        what: "a wait of no time",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_n = 0.3\n\
             live = true\n",
        run: "play s.toml --control --seconds 0.1",
        stdin: "wait -1\n",
        code: 0,
        says: "line 1 of standard input: `-1` is unexpected here: give a number of seconds above 0, at most an \
             hour",
        ..CASE
    },
    Case {
        what: "another scene that is not there",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_n = 0.3\n\
             live = true\n",
        run: "play s.toml --control --seconds 0.1",
        stdin: "replace b.toml\n",
        code: 0,
        lines: 2,
        says: "b.toml: this scene file cannot be read (No such file or directory (os error 2)): check the \
             path\nfrixel: b.toml is not played: the previous scene keeps playing",
        ..CASE
    },
    Case {
        what: "another scene with a mistake",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_n = 0.3\n\
             live = true\n",
        files: &[(
            "b.toml",
            Content::Text(
                "version = 2\n\
             [[layer]]\n\
             kind = \"constat\"\n",
            ),
        )],
        run: "play s.toml --control --seconds 0.1",
        stdin: "replace b.toml\n",
        code: 0,
        lines: 2,
        says: "b.toml:3:8: `kind = \"constat\"` is not known; did you mean `constant`?\nfrixel: b.toml is not \
             played: the previous scene keeps playing",
        ..CASE
    },
    Case {
        what: "a name in small letters",
        scene: LIVE,
        run: "play s.toml --control --seconds 0.1",
        stdin: "layer \"ok\" off\n",
        code: 0,
        says: "line 1 of standard input: the scene has no layer \"ok\": did you mean \"OK\"?",
        ..CASE
    },
    Case {
        what: "the name of a layer with copies",
        scene: LIVE,
        run: "play s.toml --control --seconds 0.1",
        stdin: "layer \"key\" off\n",
        code: 0,
        says: "line 1 of standard input: \"key\" is repeated: give one of its copies, \"key 1\" to \"key 3\"",
        ..CASE
    },
    Case {
        what: "the name of a layer with copies, misspelt",
        scene: LIVE,
        run: "play s.toml --control --seconds 0.1",
        stdin: "layer \"kye\" off\n",
        code: 0,
        says: "line 1 of standard input: the scene has no layer \"kye\": did you mean one of \"key 1\" to \"key 3\"?",
        ..CASE
    },
    Case {
        what: "the number of a layer with copies",
        scene: LIVE,
        run: "play s.toml --control --seconds 0.1",
        stdin: "layer 2 off\n",
        code: 0,
        says: "line 1 of standard input: \"2\" is repeated: give one of its copies, 2.1 to 2.3",
        ..CASE
    },
    Case {
        what: "a number that is too large",
        scene: LIVE,
        run: "play s.toml --control --seconds 0.1",
        stdin: "layer 4 off\n",
        code: 0,
        says: "line 1 of standard input: the scene has no layer \"4\": give the name of a layer, or its number, 1 to 3",
        ..CASE
    },
    Case {
        what: "a gain above the reach",
        scene: LIVE,
        run: "play s.toml --control --seconds 0.1",
        stdin: "layer 2.1 gain 5\n",
        code: 0,
        says: "line 1 of standard input: gain 5 is refused: layer 2.1 \"key 1\" would ask for up to 0.5 N above natural \
             friction, and 0 to 0.1299 N can be reached; give a gain from 0 to 1.29",
        ..CASE
    },
    Case {
        what: "a gain below natural friction",
        scene: LIVE,
        run: "play s.toml --control --seconds 0.1",
        stdin: "layer 2.1 gain -1\n",
        code: 0,
        says: "line 1 of standard input: gain -1 is refused: layer 2.1 \"key 1\" would ask for down to -0.1 N above natural \
             friction, and 0 to 0.1299 N can be reached; give a gain from 0 to 1.29",
        ..CASE
    },
    Case {
        what: "a trigger of a layer that is on",
        scene: LIVE,
        run: "play s.toml --control --seconds 0.1",
        stdin: "trigger OK\n",
        code: 0,
        says: "line 1 of standard input: layer \"OK\" is on, and a trigger plays a layer that is off: switch it off first, by \
             `layer \"OK\" off`",
        ..CASE
    },
    Case {
        what: "a trigger between bursts",
        scene: LIVE,
        run: "play s.toml --control --seconds 0.1",
        stdin: "layer buzz off\ntrigger buzz\n",
        code: 0,
        says: "line 2 of standard input: layer \"buzz\" comes in bursts, one every 1000 ms, so that a trigger of 100 ms may \
             be silent: leave `burst` out in the file, or trigger it for 1000 ms or more",
        ..CASE
    },
];

pub(super) const PORTS: &[Case] = &[
    Case {
        what: "no such port",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_n = 0.3\n",
        run: "play s.toml --port /dev/ttyNOWHERE",
        says: "there is no port /dev/ttyNOWHERE",
        ..CASE
    },
    Case {
        what: "a file for a port",
        scene: "[[layer]]\n\
             kind = \"constant\"\n\
             friction_n = 0.3\n",
        run: "info --port s.toml",
        says: "s.toml does not open as a serial port",
        ..CASE
    },
    Case {
        what: "no port",
        run: "info",
        code: 2,
        says: "the following required arguments were not provided:\n  --port <PORT>",
        ..CASE
    },
    Case { what: "a folder for a port", run: "info --port .", says: ". does not open as a serial port", ..CASE },
    Case {
        what: "faults of a board at no port",
        run: "faults --port /dev/ttyNOWHERE",
        says: "there is no port /dev/ttyNOWHERE",
        ..CASE
    },
];
