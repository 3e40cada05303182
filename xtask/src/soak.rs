//! `cargo xtask soak`: what takes too long for `cargo xtask ci`, in parts that take an hour at most.

use std::fmt::Write;
use std::time::Duration;

use crate::bench::programs::{self, Pace};
use crate::ci::{M0_PLUS_TARGET, M4F_TARGET};
use crate::command::{WASM, cargo_in, run as run_command};
use crate::fuzz::Extent;
use crate::needs::{self, Need};
use crate::{fuzz, packages, studio_tests};

/// How long each fuzz target runs.
const FUZZ_TIME: Duration = Duration::from_mins(15);

/// One part.
struct Part {
    name: &'static str,
    what: &'static str,
    needs: &'static [Need],
    run: fn() -> Result<(), String>,
}

const PARTS: [Part; 10] = [
    Part {
        name: "tables",
        what: "every f32 and every 32-bit code through the inverse tables",
        needs: &[],
        run: tables,
    },
    Part { name: "strokes", what: "textures under many strokes of people", needs: &[], run: strokes },
    Part {
        name: "people",
        what: "fits of 200 simulated people and of 600 tables of means, and what they cover",
        needs: &[],
        run: people,
    },
    Part {
        name: "fit",
        what: "`frixel finger calibrate` and `frixel finger fit` of 200 people with 20 seeds each, against steady friction",
        needs: &[],
        run: fit,
    },
    Part {
        name: "scenes",
        what: "12,000 random scenes in the emulator: no tick above the loader's estimate",
        needs: &[M4F_TARGET, Need::Emulator],
        run: scenes,
    },
    Part {
        name: "pico",
        what: "the Pico's image: a hundred random instructions of a play for each way to end it",
        needs: &[M0_PLUS_TARGET, Need::Node, Need::Npm],
        run: pico,
    },
    Part {
        name: "fuzz",
        what: "each fuzz target for 15 minutes, with libFuzzer",
        needs: &[Need::CppCompiler],
        run: fuzz_targets,
    },
    Part { name: "faults", what: "what holds in every tick whatever goes wrong", needs: &[], run: faults },
    Part {
        name: "firefox",
        what: "the studio's site in Firefox: plays, is felt, opens again without the server",
        needs: &[Need::Target(WASM), Need::Node, Need::Npm, Need::Firefox],
        run: studio_tests::run_in_firefox,
    },
    Part {
        name: "packages",
        what: "every crate that others use, compiled from its package as cargo publishes it",
        needs: &[],
        run: packages::check,
    },
];

/// Runs the part of this name.
pub(crate) fn run(name: &str) -> Result<(), String> {
    let part = PARTS.iter().find(|part| part.name == name);
    let part = part.ok_or_else(|| format!("the soak has no part `{name}`; it has:\n{}", list()))?;
    needs::require(part.needs)?;
    (part.run)()
}

/// The parts and what they do, a line each.
pub(crate) fn list() -> String {
    PARTS.iter().fold(String::new(), |mut list, part| {
        // Writing to a string cannot fail.
        let _ = writeln!(list, "  {:12} {}", part.name, part.what);
        list
    })
}

/// Runs the ignored tests of a package that have this filter in their name.
fn ignored(name: &str, build: &[&str], run: &[&str]) -> Result<(), String> {
    let arguments = [&["test", "--locked"], build, &["--", "--ignored", "--nocapture"], run].concat();
    run_command(name, cargo_in(".").args(arguments))
}

fn tables() -> Result<(), String> {
    ignored("every f32", &["--release", "--package", "frixel-model"], &[])
}

fn strokes() -> Result<(), String> {
    ignored("textures on many strokes", &["--release", "--package", "frixel", "--test", "main"], &["felt::"])
}

fn people() -> Result<(), String> {
    let floors = ["run", "--locked", "--release", "--package", "frixel-lab", "--example", "fit_floors"];
    run_command("floors of fits", cargo_in(".").args(floors))?;
    ignored("fits of odd recordings", &["--release", "--package", "frixel-lab", "--test", "main"], &["coverage::"])?;
    ignored("fits of 600 tables of means", &["--release", "--package", "frixel-lab", "--lib"], &["fit::means"])
}

fn fit() -> Result<(), String> {
    ignored("fits through the commands", &["--release", "--package", "frixel", "--lib"], &["calibrate::coverage"])
}

fn faults() -> Result<(), String> {
    let in_every_tick = &["--release", "--package", "frixel-hil-sim", "--test", "main"];
    ignored("what holds in every tick", in_every_tick, &["properties::"])
}

fn scenes() -> Result<(), String> {
    Pace::ALL.into_iter().try_for_each(|pace| programs::check(pace, programs::FEW, programs::MANY))
}

fn pico() -> Result<(), String> {
    ignored("the Pico's image", &["--package", "frixel-hil-sim", "--test", "emulated"], &["pico::"])
}

fn fuzz_targets() -> Result<(), String> {
    fuzz::run_all(Extent::For(FUZZ_TIME))
}
