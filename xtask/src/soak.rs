//! `cargo xtask soak`: what takes too long for `cargo xtask ci`, in parts of at most an hour.

use crate::command::run_lines;

/// The parts: a name, what it checks, and its commands.
const PARTS: [(&str, &str, &[&str]); 9] = [
    (
        "tables",
        "every f32 and every 32-bit code through the inverse tables",
        &["cargo test --locked --release -p frixel-model -- --ignored --nocapture"],
    ),
    (
        "people",
        "fits of 200 simulated people and of 600 tables of means, and what they cover",
        &[
            "cargo test --locked --release -p frixel-lab --test main -- --ignored --nocapture coverage:: floors::",
            "cargo test --locked --release -p frixel-lab --lib -- --ignored --nocapture fit::means",
        ],
    ),
    (
        "fit",
        "`frixel finger calibrate` and `frixel finger fit` of 200 people with 20 seeds each, against steady friction",
        &["cargo test --locked --release -p frixel --test main -- --ignored --nocapture fit_command::coverage"],
    ),
    (
        "scenes",
        "12,000 random scenes in the emulator: no tick above the loader's estimate",
        &["cargo xtask programs usual 500 6000", "cargo xtask programs fast 500 6000"],
    ),
    (
        "pico",
        "the Pico's image: a hundred random instructions of a play for each way to end it",
        &["cargo test --locked -p frixel-hil-sim --test emulated -- --ignored --nocapture pico::"],
    ),
    ("fuzz", "each fuzz target for 15 minutes, with libFuzzer", &["cargo xtask fuzz 900"]),
    (
        "faults",
        "what holds in every tick whatever goes wrong",
        &["cargo test --locked --release -p frixel-hil-sim --test main -- --ignored --nocapture properties::"],
    ),
    (
        "firefox",
        "the studio's site in Firefox: plays, is felt, opens again without the server",
        &["cargo xtask studio --firefox"],
    ),
    (
        "packages",
        "every crate that others use, compiled from its package as cargo publishes it",
        &["cargo xtask packages"],
    ),
];

/// Runs the part of this name.
pub(crate) fn run(name: &str) -> Result<(), String> {
    let part = PARTS.iter().find(|(known, ..)| *known == name);
    let (_, _, lines) = part.ok_or_else(|| format!("the soak has no part `{name}`; it has:\n{}", list()))?;
    run_lines(lines)
}

/// The parts and what they check, a line each.
pub(crate) fn list() -> String {
    PARTS.map(|(name, what, _)| format!("  {name:12} {what}")).join("\n")
}
