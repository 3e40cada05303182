//! Every argument of the command line that names a file. `commands::tests` compares it with clap's definitions.

/// An argument that names a file or folder to write.
pub(crate) struct Output {
    /// The command and the name of the argument, as clap has them.
    pub(crate) argument: &'static str,
    /// A command line, in which `IN` is an input and `OUT` is the output. Empty if it takes a board, a person or a
    /// signal, or measures times.
    pub(crate) run: &'static str,
    /// The input of that command line, one of the files that the tests make; empty without one.
    pub(crate) input: &'static str,
    /// What is written.
    pub(crate) written: &'static [&'static str],
}

const fn out(
    argument: &'static str,
    run: &'static str,
    input: &'static str,
    written: &'static [&'static str],
) -> Output {
    Output { argument, run, input, written }
}

/// What a play writes.
pub(crate) const PLAY: [&str; 4] = ["OUT/felt.csv", "OUT/summary.json", "OUT/felt.svg", "OUT/scene.png"];
const SCORE: [&str; 3] = ["OUT/score.csv", "OUT/score-layers.csv", "OUT/score.svg"];
const SWEEP: [&str; 4] = ["OUT/layers.csv", "OUT/fingers.parquet", "OUT/numbers.csv", "OUT/sweep.svg"];

/// Every output.
pub(crate) const OUTPUTS: [Output; 15] = [
    out("demo out", "demo --out OUT", "", &PLAY),
    out("new name", "new OUT.toml --picture IN", "picture.png", &["OUT.toml"]),
    out("play out", "play scene.toml --seconds 0.3 --stroke IN --out OUT", "stroke.csv", &PLAY),
    out("play record", "play IN --seconds 0.1 --out OUT --record OUT.parquet", "scene.toml", &["OUT.parquet"]),
    out("preview output", "preview IN -o OUT.png", "scene.toml", &["OUT.png"]),
    out("score out", "score scene.toml --stroke IN --seeds 1 --out OUT", "stroke.csv", &SCORE),
    out("sweep out", "sweep IN -o OUT", "plan.toml", &SWEEP),
    out("sim out", "", "", &[]),
    out("board record output", "", "", &[]),
    out("board selftest output", "", "", &[]),
    out("finger calibrate output", "finger calibrate --strokes 9 -o OUT", "", &["OUT"]),
    out("model eval output", "model eval --input IN --output OUT", "points.csv", &["OUT"]),
    out("model invert output", "model invert --input IN --output OUT", "frictions.csv", &["OUT"]),
    out("finger fit output", "finger fit IN -o OUT.toml", "data.csv", &["OUT.toml", "OUT.svg"]),
    out("report out", "", "", &[]),
];

/// Every argument that names a file to read, or a port, by the type of a path.
#[allow(dead_code, reason = "only the test of the command line reads it")]
pub(crate) const INPUTS: [&str; 20] = [
    "finger calibrate forces",
    "finger fit data",
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
    "check scene",
    "preview scene",
    "score scene",
    "sim scenario",
    "sim stroke",
    "studio page",
    "sweep merge out",
    "sweep plan",
];
