//! `cargo xtask test`: all checks that must pass before a change is merged.

use std::fs;

use crate::bench::programs::{self, Pace};
use crate::command::{M4F, add_target, cargo_in, root, run};
use crate::outcome::{Outcome, skip};
use crate::stages::Stages;
use crate::{bench, budgets, portability, stamps, studio_tests, test_programs};

/// Inputs of the images and of the budgets.
const FIRMWARE_INPUTS: [&str; 6] = ["budgets.toml", "Cargo.lock", "Cargo.toml", "firmware", "model", "xtask"];
/// Inputs of the portability checks.
const PORTABILITY_INPUTS: [&str; 8] =
    ["Cargo.lock", "Cargo.toml", "firmware", "hil-sim", "host", "model", "scenes", "xtask/src/portability.rs"];
/// Inputs of the browser tests of the studio.
const STUDIO_INPUTS: [&str; 8] =
    ["Cargo.lock", "Cargo.toml", "firmware", "hil-sim", "host", "model", "scenes", "xtask"];
/// The crate whose features an image selects.
const SESSION: &str = "firmware/session";

/// A firmware image outside the workspace.
struct Image {
    folder: &'static str,
    /// The target folder in which its size is measured and its emulator expects it.
    target_folder: &'static str,
    /// Further sets of features to check: additional ones, and replacements of the default ones.
    more: &'static [&'static [&'static str]],
}

const IMAGES: [Image; 4] = [
    Image {
        folder: "firmware/board-nucleo-g474re",
        target_folder: "target/full",
        more: &[
            &["--features", "optical-frame"],
            &["--no-default-features"],
            &["--no-default-features", "--features", "grating"],
            &["--no-default-features", "--features", "bitmap,store,panic-message"],
        ],
    },
    Image { folder: "firmware/board-mps2-an386", target_folder: "target", more: &[] },
    Image { folder: "firmware/bench", target_folder: "target", more: &[] },
    Image { folder: "firmware/table-cortex-m3", target_folder: "target", more: &[] },
];

/// Runs every check, and prints the run time of each stage.
pub(crate) fn test() -> Result<(), String> {
    let mut stages = Stages::new();
    stages.run("format", || passed(cargo("format", ".", &["fmt", "--all", "--check"], &[])))?;
    let lints = ["clippy", "--workspace", "--all-targets", "--locked", "--", "-D", "warnings"];
    stages.run("lints", || passed(cargo("lints", ".", &lints, &[])))?;
    stages.run("feature sets", || unless_firmware_unchanged("feature-sets", || passed(feature_sets())))?;
    stages.run("images", || unless_firmware_unchanged("images", || passed(images())))?;
    stages.run("tests", test_programs::run_all)?;
    stages.run("portability", || {
        stamps::unless_unchanged("portability", &PORTABILITY_INPUTS.map(str::to_owned), || passed(portability::check()))
    })?;
    stages.run("studio in a browser", || {
        stamps::unless_unchanged("studio", &STUDIO_INPUTS.map(str::to_owned), studio_tests::run_all)
    })?;
    stages.run("documentation tests", test_programs::run_documentation)?;
    let docs = ["doc", "--workspace", "--no-deps", "--locked"];
    let flags = [("RUSTDOCFLAGS", "-D warnings")];
    stages.run("documentation", || passed(cargo("documentation", ".", &docs, &flags)))?;
    stages.run("budgets", || unless_firmware_unchanged("budgets", budgets))?;
    eprint!("{}", stages.table());
    Ok(())
}

/// The outcome of a check that never skips anything.
fn passed(result: Result<(), String>) -> Result<Outcome, String> {
    result.map(|()| Outcome::Passed)
}

/// Runs the tests that take too long for every change, because they are exhaustive.
pub(crate) fn soak() -> Result<(), String> {
    let mut stages = Stages::new();
    let sweeps = ["test", "--release", "--locked", "--package", "frixel-model", "--", "--ignored", "--nocapture"];
    stages.run("every f32", || passed(cargo("soak", ".", &sweeps, &[])))?;
    let felt =
        ["test", "--release", "--locked", "--package", "frixel", "--test", "felt", "--", "--ignored", "--nocapture"];
    stages.run("textures on many strokes", || passed(cargo("soak", ".", &felt, &[])))?;
    let people =
        ["test", "--release", "--locked", "--package", "frixel", "--test", "fit", "--", "--ignored", "--nocapture"];
    stages.run("fits of 200 people", || passed(cargo("soak", ".", &people, &[])))?;
    let ports =
        ["test", "--locked", "--package", "frixel", "--test", "designer", "--", "--ignored", "--test-threads", "1"];
    stages.run("experiments in real time", || passed(cargo("soak", ".", &ports, &[])))?;
    stages.run("random scenes", || {
        passed(Pace::ALL.into_iter().try_for_each(|pace| programs::check(pace, programs::FEW, programs::MANY)))
    })?;
    eprint!("{}", stages.table());
    Ok(())
}

fn unless_firmware_unchanged(name: &str, check: impl FnOnce() -> Result<Outcome, String>) -> Result<Outcome, String> {
    stamps::unless_unchanged(name, &FIRMWARE_INPUTS.map(str::to_owned), check)
}

/// Checks the session without features, and with each feature alone, with warnings as errors. Also runs the tests of
/// the layers without features.
fn feature_sets() -> Result<(), String> {
    add_target(M4F)?;
    let path = root().join(SESSION).join("Cargo.toml");
    let text = fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
    let manifest: toml::Table = toml::from_str(&text).map_err(|error| format!("{}: {error}", path.display()))?;
    let features = manifest.get("features").and_then(toml::Value::as_table);
    let features = features.ok_or_else(|| format!("{} has no features", path.display()))?;
    let all = ["check", "--quiet", "--locked", "--target", M4F, "--target-dir", "../../target/cross"];
    let none = [&all[..], &["--no-default-features"]].concat();
    let flags = [("RUSTFLAGS", "-D warnings")];
    cargo("session with all features", SESSION, &all, &flags)?;
    cargo("session without features", SESSION, &none, &flags)?;
    for feature in features.keys().filter(|feature| *feature != "default") {
        let alone = [&none[..], &["--features", feature]].concat();
        cargo(&format!("session with {feature}"), SESSION, &alone, &flags)?;
    }
    let package = ["test", "--quiet", "--locked", "--package", "frixel-layers", "--no-default-features"];
    let tests = [&package[..], &["--lib", "--test", "disabled"]].concat();
    cargo("layers without features", ".", &tests, &[])
}

/// Checks format and lints of every image, and builds it.
fn images() -> Result<(), String> {
    for Image { folder, target_folder, more } in &IMAGES {
        cargo(&format!("format of {folder}"), folder, &["fmt", "--check"], &[])?;
        for features in [&[][..]].iter().chain(*more) {
            let lints = ["clippy", "--quiet", "--release", "--locked", "--target-dir", target_folder];
            let lints = [&lints[..], features, &["--", "-D", "warnings"]].concat();
            cargo(&format!("lints of {folder} {}", features.join(" ")), folder, &lints, &[])?;
        }
        let build = ["build", "--release", "--locked", "--target-dir", target_folder];
        cargo(&format!("build of {folder}"), folder, &build, &[])?;
    }
    Ok(())
}

/// Counts instructions, measures sizes and compares them with their limits. Also checks that an image that
/// deliberately exceeds its budget is detected.
pub(crate) fn budgets() -> Result<Outcome, String> {
    if let Err(missing) = bench::emulator() {
        return skip("budgets", missing);
    }
    let figures = bench::bench()?;
    eprint!("{}", figures.table());
    let limits = budgets::read(&root().join("budgets.toml"))?;
    budgets::check(&limits, &figures)?;
    bench::costs::check(&figures)?;
    Pace::ALL.into_iter().try_for_each(|pace| programs::check(pace, 0, programs::FEW))?;
    let broken = budgets::only(&limits, bench::BROKEN)?;
    match budgets::check(&broken, &bench::breach()?) {
        Err(_) => Ok(Outcome::Passed),
        Ok(()) => Err(format!("an image that breaks the budget of {} was not noticed", bench::BROKEN)),
    }
}

fn cargo(name: &str, folder: &str, arguments: &[&str], variables: &[(&str, &str)]) -> Result<(), String> {
    run(name, cargo_in(folder).args(arguments).envs(variables.iter().copied()))
}
