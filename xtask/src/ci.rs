//! `cargo xtask ci`: the checks that must pass, beside `cargo test`, before a change is merged.

use std::env;
use std::path::PathBuf;
use std::process::Command;
use std::time::Instant;

use crate::bench::programs;
use crate::command::{IMAGES_TARGET_FOLDER, M4F, absolute, cargo_in, root, run, run_lines, target_folder, text};
use crate::fuzz::Extent;
use crate::{bench, budgets, fuzz, needs, numbers, pico_rig, python, studio_tests};

/// The crate whose features an image selects.
const SESSION: &str = "firmware/session";
/// Packages whose tests `cargo test` leaves out. Without the two that have none, these are compiled with the same
/// features as for `cargo test`, and so only once.
const BESIDE_DEFAULT: [&str; 7] =
    ["frixel-board", "frixel-drivers", "frixel-exchange", "frixel-fuzz", "frixel-studio", "frixel-testkit", "xtask"];

/// One check.
struct Step {
    name: &'static str,
    /// Programs that it needs besides cargo and a C linker.
    programs: &'static [&'static str],
    run: fn() -> Result<(), String>,
}

/// All steps, in the order in which they run: a cheap one fails first.
const STEPS: [Step; 14] = [
    Step { name: "format", programs: &[], run: || run_lines(&["cargo fmt --all --check"]) },
    Step {
        name: "lints",
        programs: &[],
        run: || {
            run_lines(&[
                "cargo clippy --workspace --locked --all-targets --test emulated --test real_time -- -D warnings",
            ])
        },
    },
    Step { name: "features", programs: &[], run: features },
    Step { name: "images", programs: &[], run: images },
    Step { name: "tests", programs: &[], run: tests },
    Step {
        name: "docs",
        programs: &[],
        run: || {
            let mut doc = cargo_in(".");
            run("docs", doc.args(["doc", "--workspace", "--no-deps", "--locked"]).env("RUSTDOCFLAGS", "-D warnings"))
        },
    },
    Step { name: "wasm", programs: &[], run: || run_lines(&PAGE_CRATES) },
    Step { name: "scripts", programs: &["node", "npm"], run: studio_tests::check_scripts },
    Step { name: "studio", programs: &["node", "npm", "chromium"], run: studio_tests::run_page },
    Step { name: "emulators", programs: &["qemu-system-arm", "node", "npm"], run: emulators },
    Step { name: "budgets", programs: &["qemu-system-arm"], run: check_budgets },
    Step { name: "python", programs: &["python3", "node", "npm", "chromium"], run: python::check },
    Step { name: "other-systems", programs: &[], run: || run_lines(&OTHER_SYSTEMS) },
    Step { name: "fuzz", programs: &["c++"], run: || fuzz::run_all(Extent::Fixed) },
];

/// The crates of the page whose code differs for WebAssembly, in the profile of the page, whose build shares what the
/// compiler itself takes. The `clippy.toml` of these, and of those that they depend on, disallows clocks, files,
/// threads and processes on every platform. That scenes have the same bits there is checked in the page
/// (`studio_tests.rs`).
const PAGE_CRATES: [&str; 1] = ["cargo clippy --locked --target wasm32-unknown-unknown --profile studio --lib -p \
                                 frixel-hil-sim -p frixel-lab -p frixel-studio -- -D warnings"];
/// The whole command for Windows and macOS. Functions that need a pseudo-terminal fail there at run time.
const OTHER_SYSTEMS: [&str; 2] = [
    "cargo check --locked -p frixel --target x86_64-pc-windows-gnu",
    "cargo check --locked -p frixel --target aarch64-apple-darwin",
];

/// Runs every step, and prints the time of each. A step whose programs are missing is skipped; in continuous
/// integration that is an error before the first step.
pub(crate) fn run_all() -> Result<(), String> {
    let is_ci = env::var_os("CI").is_some_and(|ci| !ci.is_empty() && ci != "false" && ci != "0");
    let mut steps = Vec::new();
    for step in &STEPS {
        match needs::require(step.programs) {
            Ok(()) => steps.push(step),
            Err(missing) if is_ci => return Err(format!("step {}: {missing}", step.name)),
            Err(missing) => eprintln!("SKIPPED  {}: {missing}", step.name),
        }
    }
    let mut times = Vec::new();
    for step in &steps {
        eprintln!("== {}", step.name);
        let begin = Instant::now();
        (step.run)().map_err(|error| format!("step {} failed (`cargo xtask ci {0}`): {error}", step.name))?;
        times.push((step.name, begin.elapsed()));
    }
    for (name, time) in &times {
        eprintln!("{:>8.1} s  {name}", time.as_secs_f64());
    }
    println!("steps: {} passed, 0 failed, {} skipped", steps.len(), STEPS.len() - steps.len());
    Ok(())
}

/// Runs the step of this name.
pub(crate) fn run_step(name: &str) -> Result<(), String> {
    let step = STEPS.iter().find(|step| step.name == name).ok_or_else(|| {
        let names: Vec<&str> = STEPS.iter().map(|step| step.name).collect();
        format!("there is no step `{name}`: expected one of {}", names.join(", "))
    })?;
    needs::require(step.programs).and_then(|()| (step.run)())
}

/// The tests that `cargo test` leaves out and that need no other program. Those in real time run one by one.
fn tests() -> Result<(), String> {
    run("tests", &mut beside_default("test"))?;
    run_lines(&["cargo test --locked --test real_time -- --test-threads 1"])
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
    run_lines(&["cargo test --locked --test emulated"])
}

/// Checks the lints of the session without features, and with each feature alone, with warnings as errors. Also runs
/// the tests of the layers and of the session without features.
fn features() -> Result<(), String> {
    let path = root().join(SESSION).join("Cargo.toml");
    let manifest: toml::Table =
        toml::from_str(&text(&path)?).map_err(|error| format!("{}: {error}", path.display()))?;
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
    run_lines(&[
        "cargo test --quiet --locked --no-default-features -p frixel-layers --lib --test disabled",
        "cargo test --quiet --locked --no-default-features -p frixel-session --tests",
    ])
}

/// The image whose series resistance a build may name.
const NUCLEO: &str = "firmware/board-nucleo-g474re";

/// Folders of the firmware images outside the workspace, and further options to check their lints with.
const IMAGES: [(&str, &[&str]); 4] = [
    (
        NUCLEO,
        &[
            "--features optical-frame",
            "--no-default-features",
            "--no-default-features --features grating",
            "--no-default-features --features bitmap,panic-message",
        ],
    ),
    (
        "firmware/board-pico",
        &[
            "--no-default-features --features rp2350,grating",
            "--features optical-frame",
            "--target thumbv6m-none-eabi --no-default-features --features rp2040,everything",
            "--target thumbv6m-none-eabi --no-default-features --features rp2040,grating,optical-frame,log",
        ],
    ),
    ("firmware/board-mps2-an386", &["--target thumbv8m.main-none-eabihf"]),
    ("firmware/bench", &["--target thumbv8m.main-none-eabihf"]),
];

/// Checks format and lints of every image, and builds it.
fn images() -> Result<(), String> {
    let into = ["--quiet", "--release", "--locked", "--target-dir", IMAGES_TARGET_FOLDER];
    for (folder, more) in IMAGES {
        cargo(&format!("format of {folder}"), folder, &["fmt", "--check"], &[])?;
        for options in [""].iter().chain(more) {
            let words: Vec<&str> = options.split_whitespace().collect();
            let lints = [&["clippy"], &into[..], &words, &["--", "-D", "warnings"]].concat();
            cargo(&format!("lints of {folder} {options}"), folder, &lints, &[])?;
        }
        cargo(&format!("build of {folder}"), folder, &[&["build"], &into[..]].concat(), &[])?;
    }
    let programs = [&["check"], &into[..], &["--bins"]].concat();
    cargo("NUCLEO behind 374 kOhm", NUCLEO, &programs, &[("FRIXEL_SERIES_KOHM", "374")])
}

/// Counts instructions, measures sizes and compares them with their limits and with the committed figures.
fn check_budgets() -> Result<(), String> {
    let figures = bench::bench()?;
    eprint!("{}", bench::table(&figures));
    budgets::check_file(&root().join("budgets.toml"), &figures)?;
    numbers::check(&figures)?;
    bench::costs::check(&figures)?;
    programs::PACES.into_iter().try_for_each(|pace| programs::check(pace, 0, programs::FEW))
}

fn cargo(name: &str, folder: &str, arguments: &[&str], variables: &[(&str, &str)]) -> Result<(), String> {
    run(name, cargo_in(folder).args(arguments).envs(variables.iter().copied()))
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;
    use std::fs;

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
        let first = of(NUCLEO);
        assert_eq!(first.1.as_str(), Some(IMAGES_TARGET_FOLDER));
        for (folder, _) in IMAGES {
            assert_eq!(of(folder), first, "{folder}");
            let packages = manifest(folder, "Cargo.toml")["profile"]["release"]["package"].clone();
            assert_eq!(packages["frixel-control"]["opt-level"].as_integer(), Some(3), "{folder}");
        }
    }

    /// Version 2.7 of `half` takes `zerocopy` with its derive macro, half of an image's compile time. Other packages
    /// may take `zerocopy` without it.
    #[test]
    fn no_lock_file_has_half_with_zerocopy() {
        for folder in IMAGES.into_iter().map(|(folder, _)| folder).chain(["."]) {
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
