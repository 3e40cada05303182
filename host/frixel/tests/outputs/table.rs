//! Every argument of the command line that names a file. `commands::tests` compares it with clap's definitions.

/// An argument that names a file or folder to write, with a command line that writes it.
pub(crate) struct Output {
    /// The command and the name of the argument, as clap has them.
    pub(crate) argument: &'static str,
    /// A command line, in which `IN` is an input and `OUT` is the output.
    pub(crate) run: &'static str,
    /// The input of that command line, one of the files that the tests make; empty without one.
    pub(crate) input: &'static str,
    /// What is written, the one first that a reader looks for first.
    pub(crate) written: &'static [&'static str],
    /// Whether it is a recording of a person, which is not replaced.
    pub(crate) is_recording: bool,
    /// Whether equal command lines write equal bytes within a second.
    pub(crate) is_reproducible: bool,
}

const fn result(
    argument: &'static str,
    run: &'static str,
    input: &'static str,
    written: &'static [&'static str],
) -> Output {
    Output { argument, run, input, written, is_recording: false, is_reproducible: true }
}

const fn recording(
    argument: &'static str,
    run: &'static str,
    input: &'static str,
    written: &'static [&'static str],
) -> Output {
    Output { argument, run, input, written, is_recording: true, is_reproducible: true }
}

/// Every output.
pub(crate) const OUTPUTS: [Output; 16] = [
    Output {
        // It never replaces its scene.
        is_reproducible: true,
        ..result(
            "demo out",
            "demo --out OUT",
            "",
            &["OUT/felt.csv", "OUT/summary.json", "OUT/felt.svg", "OUT/scene.png"],
        )
    },
    result("new name", "new OUT.toml --picture IN", "picture.png", &["OUT.toml"]),
    result(
        "play out",
        "play scene.toml --seconds 0.3 --stroke IN --out OUT",
        "stroke.csv",
        &["OUT/felt.csv", "OUT/summary.json", "OUT/felt.svg", "OUT/scene.png"],
    ),
    result(
        "play record",
        "play scene.toml --seconds 0.3 --stroke IN --out OUT --record OUT.parquet",
        "stroke.csv",
        &["OUT.parquet", "OUT/felt.csv", "OUT/summary.json", "OUT/felt.svg", "OUT/scene.png"],
    ),
    result("scene migrate output", "scene migrate IN -o OUT", "old.toml", &["OUT"]),
    result("scene preview output", "scene preview IN -o OUT.png", "scene.toml", &["OUT.png"]),
    result(
        "score out",
        "score scene.toml --stroke IN --seeds 1 --out OUT",
        "stroke.csv",
        &["OUT/score.csv", "OUT/score-layers.csv", "OUT/score.svg"],
    ),
    result(
        "sweep out",
        "sweep IN -o OUT",
        "plan.toml",
        &[
            "OUT/layers.csv",
            "OUT/fingers.csv",
            "OUT/numbers.csv",
            "OUT/layers.parquet",
            "OUT/fingers.parquet",
            "OUT/numbers.parquet",
            "OUT/sweep.svg",
        ],
    ),
    Output {
        // It ends with a signal only.
        is_reproducible: false,
        ..result(
            "sim out",
            "sim --stroke IN --out OUT",
            "stroke.csv",
            &["OUT/felt.csv", "OUT/forces.csv", "OUT/events.csv"],
        )
    },
    Output {
        // It takes a board.
        is_reproducible: false,
        ..recording("record output", "record --port nowhere -o OUT", "", &["OUT"])
    },
    Output {
        // It takes a board.
        is_reproducible: false,
        ..result("selftest output", "selftest --port nowhere --wires -o OUT", "", &["OUT"])
    },
    recording("calibrate output", "calibrate --strokes 9 --forces IN -o OUT", "forces.csv", &["OUT"]),
    result("model eval output", "model eval --input IN --output OUT", "points.csv", &["OUT"]),
    result("model invert output", "model invert --input IN --output OUT", "frictions.csv", &["OUT"]),
    result("fit output", "fit IN -o OUT.toml", "data.csv", &["OUT.toml", "OUT.svg"]),
    Output {
        // It measures times.
        is_reproducible: false,
        ..result("report out", "report --bench IN --out OUT", "bench.json", &["OUT/index.html"])
    },
];

/// Every argument that names a file to read, or a port, by the type of a path.
#[allow(dead_code, reason = "only the test of the command line reads it")]
pub(crate) const INPUTS: [&str; 21] = [
    "calibrate forces",
    "fit data",
    "model eval input",
    "model invert input",
    "new picture",
    "play scene",
    "play stream",
    "play stroke",
    "play with_log",
    "replay recording",
    "report bench",
    "report scene",
    "scene check scene",
    "scene migrate scene",
    "scene preview scene",
    "score scene",
    "sim scenario",
    "sim stroke",
    "studio page",
    "sweep merge out",
    "sweep plan",
];
