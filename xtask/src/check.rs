//! `cargo xtask test`: the checks that must pass before a change is merged.

use std::fs;

use crate::bench::programs::{self, Pace};
use crate::command::{IMAGES_TARGET_FOLDER, M0_PLUS, M3, M4F, M33, WASM, cargo_in, root, run};
use crate::inputs::packages;
use crate::needs::{Machine, Missing, Need};
use crate::outcome::{Outcome, skip};
use crate::stages::Stages;
use crate::test_programs::{self, Programs};
use crate::{bench, budgets, fuzz, inputs, pico_rig, portability, python, results, stamps, studio_tests};

/// Inputs of the images and of the budgets.
const FIRMWARE_INPUTS: [&str; 8] =
    ["budgets.toml", "Cargo.lock", "Cargo.toml", "clippy.toml", "firmware", "model", "rustfmt.toml", "xtask"];
/// The crate whose features an image selects.
const SESSION: &str = "firmware/session";

/// How much is checked.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Tier {
    /// `cargo xtask test`: at most 15 minutes from a clean clone on two cores.
    First,
    /// `cargo xtask test --all`: the first tier, and then what is slow; at most 45 minutes.
    All,
}

/// One check.
struct Stage {
    name: &'static str,
    tier: Tier,
    needs: &'static [Need],
    run: fn() -> Result<Outcome, String>,
}

pub(crate) const CLIPPY: Need = Need::Component("clippy", "clippy");
const FORMAT: Need = Need::Component("fmt", "rustfmt");
pub(crate) const M4F_TARGET: Need = Need::Target(M4F);
pub(crate) const M3_TARGET: Need = Need::Target(M3);
pub(crate) const M0_PLUS_TARGET: Need = Need::Target(M0_PLUS);
pub(crate) const M33_TARGET: Need = Need::Target(M33);
pub(crate) const WASM_TARGET: Need = Need::Target(WASM);

/// All checks, in the order in which they run: a cheap one fails first.
const STAGES: [Stage; 16] = [
    Stage { name: "format", tier: Tier::First, needs: &[FORMAT], run: format },
    Stage { name: "lints", tier: Tier::First, needs: &[CLIPPY], run: lints },
    Stage { name: "feature sets", tier: Tier::First, needs: &[M4F_TARGET, CLIPPY, Need::Git], run: feature_sets },
    Stage {
        name: "images",
        tier: Tier::First,
        needs: &[M4F_TARGET, M3_TARGET, M0_PLUS_TARGET, M33_TARGET, CLIPPY, FORMAT, Need::Git],
        run: images,
    },
    Stage { name: "tests", tier: Tier::First, needs: &[Need::Git], run: tests },
    Stage {
        name: "documentation tests",
        tier: Tier::First,
        needs: &[Need::Git],
        run: test_programs::run_documentation,
    },
    Stage { name: "documentation", tier: Tier::First, needs: &[], run: documentation },
    Stage {
        name: "crates of the page for WebAssembly",
        tier: Tier::First,
        needs: &[WASM_TARGET, CLIPPY, Need::Git],
        run: page,
    },
    Stage { name: "scripts of the studio", tier: Tier::First, needs: &studio_tests::SCRIPT_NEEDS, run: studio_scripts },
    Stage { name: "studio in a browser", tier: Tier::First, needs: &studio_tests::NEEDS, run: studio_in_a_browser },
    Stage {
        name: "studio beside the command",
        tier: Tier::First,
        needs: &studio_tests::NEEDS,
        run: studio_beside_the_command,
    },
    Stage {
        name: "tests on emulators",
        tier: Tier::All,
        needs: &[M4F_TARGET, M3_TARGET, M0_PLUS_TARGET, M33_TARGET, Need::Emulator, Need::Node, Need::Npm, Need::Git],
        run: tests_on_emulators,
    },
    Stage {
        name: "budgets",
        tier: Tier::All,
        needs: &[M4F_TARGET, M3_TARGET, M0_PLUS_TARGET, M33_TARGET, Need::Emulator, Need::Git],
        run: budgets_stage,
    },
    Stage { name: "python", tier: Tier::All, needs: &python::NEEDS, run: python_module },
    Stage { name: "other systems", tier: Tier::All, needs: &portability::NEEDS, run: other_systems },
    Stage {
        name: "fuzz targets for libFuzzer",
        tier: Tier::All,
        needs: &[Need::CppCompiler, Need::Git],
        run: fuzz::run_all,
    },
];

/// Looks at what the machine has, runs every check of a tier, and prints the time of each and the results of the test
/// runners.
pub(crate) fn test(tier: Tier) -> Result<(), String> {
    let stages: Vec<&Stage> = STAGES.iter().filter(|stage| stage.tier <= tier).collect();
    let needs: Vec<(&str, &[Need])> = stages.iter().map(|stage| (stage.name, stage.needs)).collect();
    eprintln!("what the checks need of this machine:");
    let missing = Missing::look(&Machine::this(), &needs, &mut |line| eprintln!("{line}"))?;
    let mut timed = Stages::new();
    for stage in stages {
        let result = timed.run(stage.name, || match missing.among(stage.needs) {
            Some(names) => skip(stage.name, format!("without {names}")),
            None => (stage.run)(),
        });
        if result.is_err() {
            results::print();
            return result;
        }
    }
    eprint!("{}", timed.table());
    results::print();
    Ok(())
}

/// The outcome of a check that never skips anything.
fn passed(result: Result<(), String>) -> Result<Outcome, String> {
    result.map(|()| Outcome::Passed)
}

fn format() -> Result<Outcome, String> {
    passed(cargo("format", ".", &["fmt", "--all", "--check"], &[]))
}

fn lints() -> Result<Outcome, String> {
    let lints = ["clippy", "--workspace", "--all-targets", "--locked", "--", "-D", "warnings"];
    passed(cargo("lints", ".", &lints, &[]))
}

fn feature_sets() -> Result<Outcome, String> {
    unless_firmware_unchanged("feature-sets", || passed(check_feature_sets()))
}

fn images() -> Result<Outcome, String> {
    unless_firmware_unchanged("images", || passed(check_images()))
}

fn tests() -> Result<Outcome, String> {
    test_programs::run_all(Programs::OnThisMachine)
}

fn tests_on_emulators() -> Result<Outcome, String> {
    let inputs = ["hil-sim/pico", "xtask"].map(str::to_owned);
    let scripts = stamps::unless_unchanged("pico-rig", &inputs, || passed(pico_rig::test_scripts()))?;
    Ok(scripts.and(test_programs::run_all(Programs::OnEmulators)?))
}

fn documentation() -> Result<Outcome, String> {
    let docs = ["doc", "--workspace", "--no-deps", "--locked"];
    passed(cargo("documentation", ".", &docs, &[("RUSTDOCFLAGS", "-D warnings")]))
}

fn page() -> Result<Outcome, String> {
    let inputs = portability::page_inputs(&packages()?);
    stamps::unless_unchanged("page", &inputs, || passed(portability::page_crates()))
}

fn studio_scripts() -> Result<Outcome, String> {
    let inputs = ["hil-sim/pico", "host/studio", "xtask"].map(str::to_owned);
    stamps::unless_unchanged("studio-scripts", &inputs, || passed(studio_tests::check_scripts()))
}

fn studio_in_a_browser() -> Result<Outcome, String> {
    let inputs = studio_tests::page_inputs(&packages()?);
    stamps::unless_unchanged("studio", &inputs, || passed(studio_tests::run_page()))
}

fn studio_beside_the_command() -> Result<Outcome, String> {
    let inputs = studio_tests::command_inputs(&packages()?);
    stamps::unless_unchanged("studio-command", &inputs, || passed(studio_tests::run_beside_command()))
}

fn budgets_stage() -> Result<Outcome, String> {
    unless_firmware_unchanged("budgets", || passed(check_budgets()))
}

fn python_module() -> Result<Outcome, String> {
    stamps::unless_unchanged("python", &python::inputs(&packages()?), || passed(python::check()))
}

fn other_systems() -> Result<Outcome, String> {
    let inputs = inputs::of_libraries(&["frixel"], &packages()?);
    stamps::unless_unchanged("other-systems", &inputs, || passed(portability::other_systems()))
}

fn unless_firmware_unchanged(name: &str, check: impl FnOnce() -> Result<Outcome, String>) -> Result<Outcome, String> {
    stamps::unless_unchanged(name, &FIRMWARE_INPUTS.map(str::to_owned), check)
}

/// Checks the lints of the session without features, and with each feature alone, with warnings as errors. Also runs
/// the tests of the layers and of the session without features.
fn check_feature_sets() -> Result<(), String> {
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
        results::run(&format!("{package} without features"), cargo_in(".").args(test).args(tests))?;
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

pub(crate) const IMAGES: [Image; 5] = [
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
    Image { folder: "firmware/table-cortex-m3", more: &[] },
];

/// Checks format and lints of every image, and builds it.
fn check_images() -> Result<(), String> {
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

/// Counts instructions, measures sizes and compares them with their limits. Also checks that an image that
/// deliberately exceeds its budget is detected.
pub(crate) fn check_budgets() -> Result<(), String> {
    let figures = bench::bench()?;
    eprint!("{}", figures.table());
    let limits = budgets::read(&root().join("budgets.toml"))?;
    budgets::check(&limits, &figures)?;
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
    use super::*;
    use crate::{licences, studio};

    fn manifest(folder: &str, name: &str) -> toml::Table {
        toml::from_str(&fs::read_to_string(root().join(folder).join(name)).unwrap()).unwrap()
    }

    #[test]
    fn every_file_that_the_page_carries_is_among_the_inputs_of_its_tests() {
        let inputs = studio_tests::page_inputs(&packages().unwrap());
        let folders = studio::CARRIED.map(|(folder, _, _)| folder);
        for path in folders.into_iter().chain(licences::FILES) {
            let is_input = inputs.iter().any(|input| std::path::Path::new(path).starts_with(input));
            assert!(is_input, "{path} is no input of the tests of the studio");
        }
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

    #[test]
    fn every_stage_has_a_name_of_its_own_and_the_first_tier_needs_no_emulator() {
        for (index, stage) in STAGES.iter().enumerate() {
            assert!(STAGES[..index].iter().all(|other| other.name != stage.name), "{}", stage.name);
            assert!(stage.tier == Tier::All || !stage.needs.contains(&Need::Emulator), "{}", stage.name);
        }
        let tiers: Vec<Tier> = STAGES.iter().map(|stage| stage.tier).collect();
        assert!(tiers.is_sorted(), "the first tier runs first");
    }
}
