//! `cargo xtask ci`: the checks that must pass, beside `cargo test`, before a change is merged.

use std::fs;
use std::path::PathBuf;
use std::process::Command;
use std::time::Instant;

use crate::bench::programs::{self, Pace};
use crate::command::{IMAGES_TARGET_FOLDER, M0_PLUS, M3, M4F, M33, WASM, absolute, cargo_in, root, run, target_folder};
use crate::fuzz::Extent;
use crate::needs::{Machine, Missing, Need};
use crate::{bench, budgets, fuzz, numbers, pico_rig, portability, python, studio_tests};

/// The crate whose features an image selects.
const SESSION: &str = "firmware/session";
/// Packages whose tests `cargo test` leaves out. Without the two that have none, these are compiled with the same
/// features as for `cargo test`, and so only once.
const BESIDE_DEFAULT: [&str; 7] =
    ["frixel-board", "frixel-drivers", "frixel-exchange", "frixel-fuzz", "frixel-studio", "frixel-testkit", "xtask"];

/// One check.
struct Step {
    name: &'static str,
    needs: &'static [Need],
    run: fn() -> Result<(), String>,
}

pub(crate) const CLIPPY: Need = Need::Component("clippy", "clippy");
const FORMAT: Need = Need::Component("fmt", "rustfmt");
pub(crate) const M4F_TARGET: Need = Need::Target(M4F);
pub(crate) const M3_TARGET: Need = Need::Target(M3);
pub(crate) const M0_PLUS_TARGET: Need = Need::Target(M0_PLUS);
pub(crate) const M33_TARGET: Need = Need::Target(M33);
pub(crate) const WASM_TARGET: Need = Need::Target(WASM);
/// Needs of the steps that run firmware in an emulator.
pub(crate) const EMULATED: [Need; 5] = [M4F_TARGET, M3_TARGET, M0_PLUS_TARGET, M33_TARGET, Need::Emulator];

/// All steps, in the order in which they run: a cheap one fails first.
const STEPS: [Step; 14] = [
    Step { name: "format", needs: &[FORMAT], run: || cargo("format", ".", &["fmt", "--all", "--check"], &[]) },
    Step { name: "lints", needs: &[CLIPPY], run: lints },
    Step { name: "features", needs: &[M4F_TARGET, CLIPPY], run: features },
    Step { name: "images", needs: &[M4F_TARGET, M3_TARGET, M0_PLUS_TARGET, M33_TARGET, CLIPPY, FORMAT], run: images },
    Step { name: "tests", needs: &[], run: tests },
    Step { name: "docs", needs: &[], run: docs },
    Step { name: "wasm", needs: &[WASM_TARGET, CLIPPY], run: portability::page_crates },
    Step { name: "scripts", needs: &studio_tests::SCRIPT_NEEDS, run: studio_tests::check_scripts },
    Step { name: "studio", needs: &studio_tests::NEEDS, run: studio_tests::run_page },
    Step {
        name: "emulators",
        needs: &[M4F_TARGET, M3_TARGET, M0_PLUS_TARGET, M33_TARGET, Need::Emulator, Need::Node, Need::Npm],
        run: emulators,
    },
    Step { name: "budgets", needs: &EMULATED, run: check_budgets },
    Step { name: "python", needs: &python::NEEDS, run: python::check },
    Step { name: "other-systems", needs: &portability::NEEDS, run: portability::other_systems },
    Step { name: "fuzz", needs: &[Need::CppCompiler], run: || fuzz::run_all(Extent::Fixed) },
];

/// Checks what the machine has, runs every step, and prints the time of each. A step whose needs are missing is skipped;
/// in continuous integration that is an error.
pub(crate) fn run_all() -> Result<(), String> {
    let needs: Vec<(&str, &[Need])> = STEPS.iter().map(|step| (step.name, step.needs)).collect();
    eprintln!("what the steps need of this machine:");
    let missing = Missing::look(&Machine::this(), &needs, &mut |line| eprintln!("{line}"))?;
    let mut times = Vec::new();
    for step in &STEPS {
        if missing.among(step.needs).is_some() {
            continue;
        }
        eprintln!("== {}", step.name);
        let begin = Instant::now();
        (step.run)().map_err(|error| format!("step {} failed (`cargo xtask ci {0}`): {error}", step.name))?;
        times.push((step.name, begin.elapsed()));
    }
    for (name, time) in &times {
        eprintln!("{:>8.1} s  {name}", time.as_secs_f64());
    }
    println!("steps: {} passed, 0 failed, {} skipped", times.len(), STEPS.len() - times.len());
    Ok(())
}

/// Runs the step of this name.
pub(crate) fn run_step(name: &str) -> Result<(), String> {
    let step = STEPS.iter().find(|step| step.name == name).ok_or_else(|| {
        let names: Vec<&str> = STEPS.iter().map(|step| step.name).collect();
        format!("there is no step `{name}`: expected one of {}", names.join(", "))
    })?;
    crate::needs::require(step.needs).and_then(|()| (step.run)())
}

/// Checks the lints of everything, with the test programs that `cargo test` leaves out.
fn lints() -> Result<(), String> {
    let targets = ["--all-targets", "--test", "emulated", "--test", "real_time"];
    cargo(
        "lints",
        ".",
        &[&["clippy", "--workspace", "--locked"], &targets[..], &["--", "-D", "warnings"]].concat(),
        &[],
    )
}

/// The tests that `cargo test` leaves out and that need no other program. Those in real time run one by one.
fn tests() -> Result<(), String> {
    run("tests", &mut beside_default("test"))?;
    let one_by_one = ["test", "--locked", "--test", "real_time", "--", "--test-threads", "1"];
    cargo("tests in real time", ".", &one_by_one, &[])
}

/// This command of cargo for the packages beside the default ones: with their features, so that nothing is compiled
/// once more than for [`tests`].
pub(crate) fn beside_default(command: &str) -> Command {
    let mut cargo = cargo_in(".");
    cargo.args([command, "--locked"]).args(BESIDE_DEFAULT.iter().flat_map(|package| ["--package", package]));
    cargo
}

/// Builds the command, and returns its path. With tests beside it, it has the features of `cargo test`, so that nothing
/// is compiled twice.
pub(crate) fn command() -> Result<PathBuf, String> {
    run("command", cargo_in(".").args(["build", "--quiet", "--locked", "--bin", "frixel", "--test", "main"]))?;
    let command = target_folder().join("debug/frixel");
    absolute(&command)
}

/// The test programs named `emulated`, which plain `cargo test` leaves out.
fn emulators() -> Result<(), String> {
    pico_rig::test_scripts()?;
    cargo("tests on emulators", ".", &["test", "--locked", "--test", "emulated"], &[])
}

fn docs() -> Result<(), String> {
    cargo("docs", ".", &["doc", "--workspace", "--no-deps", "--locked"], &[("RUSTDOCFLAGS", "-D warnings")])
}

/// Checks the lints of the session without features, and with each feature alone, with warnings as errors. Also runs
/// the tests of the layers and of the session without features.
fn features() -> Result<(), String> {
    let path = root().join(SESSION).join("Cargo.toml");
    let text = fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
    let manifest: toml::Table = toml::from_str(&text).map_err(|error| format!("{}: {error}", path.display()))?;
    let features = manifest.get("features").and_then(toml::Value::as_table);
    let features = features.ok_or_else(|| format!("{} has no features", path.display()))?;
    // As the images are built, so that they share what the compiler itself takes.
    let all = ["clippy", "--quiet", "--release", "--locked", "--target", M4F, "--target-dir", IMAGES_TARGET_FOLDER];
    let none = [&all[..], &["--no-default-features"]].concat();
    let flags = [("RUSTFLAGS", "-D warnings")];
    cargo("session with all features", SESSION, &all, &flags)?;
    cargo("session without features", SESSION, &none, &flags)?;
    for feature in features.keys().filter(|feature| *feature != "default") {
        let alone = [&none[..], &["--features", feature]].concat();
        cargo(&format!("session with {feature}"), SESSION, &alone, &flags)?;
    }
    for (package, tests) in [("frixel-layers", &["--lib", "--test", "disabled"][..]), ("frixel-session", &["--tests"])]
    {
        let test = ["test", "--quiet", "--locked", "--no-default-features", "--package", package];
        run(&format!("{package} without features"), cargo_in(".").args(test).args(tests))?;
    }
    Ok(())
}

/// A firmware image outside the workspace.
pub(crate) struct Image {
    pub(crate) folder: &'static str,
    /// Further sets of features to check: additional ones, and replacements of the default ones.
    more: &'static [&'static [&'static str]],
}

/// The image whose series resistance a build may name.
const NUCLEO: &str = "firmware/board-nucleo-g474re";

pub(crate) const IMAGES: [Image; 4] = [
    Image {
        folder: NUCLEO,
        more: &[
            &["--features", "optical-frame"],
            &["--no-default-features"],
            &["--no-default-features", "--features", "grating"],
            &["--no-default-features", "--features", "bitmap,panic-message"],
        ],
    },
    Image {
        folder: "firmware/board-pico",
        more: &[
            &["--no-default-features", "--features", "rp2350,grating"],
            &["--features", "optical-frame"],
            &["--target", M0_PLUS, "--no-default-features", "--features", "rp2040,everything"],
            &["--target", M0_PLUS, "--no-default-features", "--features", "rp2040,grating,optical-frame,log"],
        ],
    },
    Image { folder: "firmware/board-mps2-an386", more: &[&["--target", M33]] },
    Image { folder: "firmware/bench", more: &[&["--target", M33]] },
];

/// Checks format and lints of every image, and builds it.
fn images() -> Result<(), String> {
    let into = ["--quiet", "--release", "--locked", "--target-dir", IMAGES_TARGET_FOLDER];
    for Image { folder, more } in &IMAGES {
        cargo(&format!("format of {folder}"), folder, &["fmt", "--check"], &[])?;
        for features in [&[][..]].iter().chain(*more) {
            let lints = [&["clippy"], &into[..], features, &["--", "-D", "warnings"]].concat();
            cargo(&format!("lints of {folder} {}", features.join(" ")), folder, &lints, &[])?;
        }
        cargo(&format!("build of {folder}"), folder, &[&["build"], &into[..]].concat(), &[])?;
    }
    let programs = [&["check"], &into[..], &["--bins"]].concat();
    cargo("NUCLEO behind 374 kOhm", NUCLEO, &programs, &[("FRIXEL_SERIES_KOHM", "374")])
}

/// Counts instructions, measures sizes and compares them with their limits and with the committed figures. Also checks
/// that an image that deliberately exceeds its budget is detected.
fn check_budgets() -> Result<(), String> {
    let figures = bench::bench()?;
    eprint!("{}", figures.table());
    let limits = budgets::read(&root().join("budgets.toml"))?;
    budgets::check(&limits, &figures)?;
    numbers::check(&figures)?;
    bench::costs::check(&figures)?;
    Pace::ALL.into_iter().try_for_each(|pace| programs::check(pace, 0, programs::FEW))?;
    let broken = budgets::only(&limits, bench::BROKEN)?;
    match budgets::check(&broken, &bench::breach()?) {
        Err(_) => Ok(()),
        Ok(()) => Err(format!("an image that breaks the budget of {} was not noticed", bench::BROKEN)),
    }
}

fn cargo(name: &str, folder: &str, arguments: &[&str], variables: &[(&str, &str)]) -> Result<(), String> {
    run(name, cargo_in(folder).args(arguments).envs(variables.iter().copied()))
}
#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;
    use crate::command::text_of;

    /// Packages without a test.
    const WITHOUT_TESTS: [&str; 2] = ["frixel-cortex-m", "frixel-python"];

    #[test]
    fn every_package_is_tested_here_or_by_cargo_test() {
        let metadata = text_of(cargo_in(".").args(["metadata", "--locked", "--no-deps", "--format-version", "1"]));
        let metadata: serde_json::Value = serde_json::from_str(&metadata.unwrap()).unwrap();
        let defaults = metadata["workspace_default_members"].as_array().unwrap();
        let packages = metadata["packages"].as_array().unwrap();
        let beside = packages.iter().filter(|package| !defaults.contains(&package["id"]));
        let beside: BTreeSet<&str> = beside.map(|package| package["name"].as_str().unwrap()).collect();
        assert_eq!(beside, BESIDE_DEFAULT.into_iter().chain(WITHOUT_TESTS).collect());
    }

    fn manifest(folder: &str, name: &str) -> toml::Table {
        toml::from_str(&fs::read_to_string(root().join(folder).join(name)).unwrap()).unwrap()
    }

    /// Images of equal profiles take what they have in common from one folder.
    #[test]
    fn all_images_have_one_target_folder_and_one_profile() {
        let of = |folder: &str| {
            let profile = manifest(folder, "Cargo.toml")["profile"]["release"].clone();
            let profile = profile.as_table().unwrap().clone();
            let own = |(key, _): &(String, toml::Value)| key != "package";
            let shared: toml::Table = profile.into_iter().filter(own).collect();
            (shared, manifest(folder, ".cargo/config.toml")["build"]["target-dir"].clone())
        };
        let first = of(IMAGES[0].folder);
        assert_eq!(first.1.as_str(), Some(IMAGES_TARGET_FOLDER));
        for image in &IMAGES {
            assert_eq!(of(image.folder), first, "{}", image.folder);
        }
        for folder in [NUCLEO, "firmware/board-pico", "firmware/board-mps2-an386", "firmware/bench"] {
            let packages = manifest(folder, "Cargo.toml")["profile"]["release"]["package"].clone();
            assert_eq!(packages["frixel-control"]["opt-level"].as_integer(), Some(3), "{folder}");
        }
    }

    /// Version 2.7 of `half` takes `zerocopy` with its derive macro, half of an image's compile time. Other packages
    /// may take `zerocopy` without it.
    #[test]
    fn no_lock_file_has_half_with_zerocopy() {
        for folder in IMAGES.iter().map(|image| image.folder).chain(["."]) {
            let lock = manifest(folder, "Cargo.lock");
            let half =
                lock["package"].as_array().unwrap().iter().filter(|package| package["name"].as_str() == Some("half"));
            let has = half.into_iter().any(|half| {
                let dependencies = half["dependencies"].as_array().unwrap().iter().filter_map(toml::Value::as_str);
                dependencies.into_iter().any(|name| name.starts_with("zerocopy"))
            });
            assert!(!has, "{folder}/Cargo.lock: `cargo update -p half --precise 2.6.0` takes zerocopy out of it");
        }
    }
}
