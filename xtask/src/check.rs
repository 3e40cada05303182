//! `cargo xtask test`: everything that has to hold before a change is taken.

use std::env;
use std::fs;

use crate::bench::programs::{self, Pace};
use crate::command::{M4F, add_target, cargo_in, root, run};
use crate::{bench, budgets};

/// Crates that run on a board.
const BOARD_CRATES: [&str; 4] = ["frixel-model", "frixel-wire", "frixel-render", "frixel-exchange"];
/// Of which this one can be built with less.
const RENDER: &str = "firmware/render";

/// An image outside the workspace.
struct Image {
    folder: &'static str,
    /// Where it is built: where its size is measured and its emulator looks for it.
    target_folder: &'static str,
    /// Features besides the default ones, and sets of features in place of them, that are looked at, too.
    more: &'static [&'static [&'static str]],
}

const IMAGES: [Image; 3] = [
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
];

pub(crate) fn test() -> Result<(), String> {
    cargo("format", ".", &["fmt", "--all", "--check"], &[])?;
    cargo("lints", ".", &["clippy", "--workspace", "--all-targets", "--locked", "--", "-D", "warnings"], &[])?;
    cross_build()?;
    feature_sets()?;
    images()?;
    cargo("tests", ".", &["test", "--workspace", "--locked"], &[])?;
    cargo("docs", ".", &["doc", "--workspace", "--no-deps", "--locked"], &[("RUSTDOCFLAGS", "-D warnings")])?;
    budgets()
}

/// The tests that are left out of every other run, because they look at every number that there is.
pub(crate) fn soak() -> Result<(), String> {
    let sweeps = ["test", "--release", "--locked", "--package", "frixel-model", "--", "--ignored", "--nocapture"];
    cargo("soak", ".", &sweeps, &[])?;
    eprintln!("== random scenes");
    Pace::ALL.into_iter().try_for_each(|pace| programs::check(pace, programs::FEW, programs::MANY))
}

/// Builds what runs on a board for the board, with warnings as errors, in a target folder of its own so that its
/// flags do not rebuild everything else.
fn cross_build() -> Result<(), String> {
    add_target(M4F)?;
    let mut arguments = vec!["build", "--locked", "--target", M4F, "--target-dir", "target/cross"];
    for name in BOARD_CRATES {
        arguments.extend(["--package", name]);
    }
    cargo("cross-build", ".", &arguments, &[("RUSTFLAGS", "-D warnings")])
}

/// Looks whether the renderer goes without any of its features, and with each of them alone.
fn feature_sets() -> Result<(), String> {
    let path = root().join(RENDER).join("Cargo.toml");
    let text = fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
    let manifest: toml::Table = toml::from_str(&text).map_err(|error| format!("{}: {error}", path.display()))?;
    let features = manifest.get("features").and_then(toml::Value::as_table);
    let features = features.ok_or_else(|| format!("{} has no features", path.display()))?;
    let none = [
        "check",
        "--quiet",
        "--locked",
        "--target",
        M4F,
        "--target-dir",
        "../../target/cross",
        "--no-default-features",
    ];
    let flags = [("RUSTFLAGS", "-D warnings")];
    cargo("renderer without features", RENDER, &none, &flags)?;
    for feature in features.keys().filter(|feature| *feature != "default") {
        let alone = [&none[..], &["--features", feature]].concat();
        cargo(&format!("renderer with {feature}"), RENDER, &alone, &flags)?;
    }
    Ok(())
}

/// Format, lints and build of every image.
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

/// Counts instructions and measures sizes, compares them with what they may be, and sees that an image that breaks its
/// budget on purpose is noticed.
pub(crate) fn budgets() -> Result<(), String> {
    eprintln!("== budgets");
    if let Err(missing) = bench::emulator() {
        if is_ci() {
            return Err(missing);
        }
        eprintln!("SKIPPED: the budgets are not checked: {missing}");
        return Ok(());
    }
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

/// Whether a skipped rig is a failure.
fn is_ci() -> bool {
    env::var_os("CI").is_some_and(|ci| !ci.is_empty() && ci != "false" && ci != "0")
}

fn cargo(name: &str, folder: &str, arguments: &[&str], variables: &[(&str, &str)]) -> Result<(), String> {
    run(name, cargo_in(folder).args(arguments).envs(variables.iter().copied()))
}
