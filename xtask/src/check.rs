//! `cargo xtask test`: everything that has to hold before a change is taken.

use std::env;
use std::path::Path;

use crate::command::{M4F, add_target, cargo_in, root, run};
use crate::{bench, budgets};

/// Crates that run on a board.
const BOARD_CRATES: [&str; 4] = ["frixel-model", "frixel-wire", "frixel-render", "frixel-exchange"];
/// Images outside the workspace, as far as they are there.
const IMAGES: [&str; 3] = ["firmware/board-nucleo-g474re", "firmware/board-mps2-an386", "firmware/bench"];

pub(crate) fn test() -> Result<(), String> {
    cargo("format", ".", &["fmt", "--all", "--check"], &[])?;
    cargo("lints", ".", &["clippy", "--workspace", "--all-targets", "--locked", "--", "-D", "warnings"], &[])?;
    cross_build()?;
    images()?;
    cargo("tests", ".", &["test", "--workspace", "--locked"], &[])?;
    cargo("docs", ".", &["doc", "--workspace", "--no-deps", "--locked"], &[("RUSTDOCFLAGS", "-D warnings")])?;
    hold_budgets()
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

/// Format, lints and build of every image.
fn images() -> Result<(), String> {
    for folder in IMAGES.into_iter().filter(|folder| root().join(folder).is_dir()) {
        cargo(&format!("format of {folder}"), folder, &["fmt", "--check"], &[])?;
        let lints = ["clippy", "--release", "--locked", "--target-dir", "target", "--", "-D", "warnings"];
        cargo(&format!("lints of {folder}"), folder, &lints, &[])?;
        let build = ["build", "--release", "--locked", "--target-dir", "target"];
        cargo(&format!("build of {folder}"), folder, &build, &[])?;
    }
    Ok(())
}

/// Counts instructions and measures sizes, and compares them with what they may be.
fn hold_budgets() -> Result<(), String> {
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
    let limits = budgets::read(Path::new(&root().join("budgets.toml")))?;
    budgets::check(&limits, &figures)?;
    let breached = bench::breach()?;
    match budgets::check(&limits, &breached) {
        Err(_) => Ok(()),
        Ok(()) => Err("an image that breaks its budget on purpose was not noticed".to_owned()),
    }
}

/// Whether a skipped rig is a failure.
fn is_ci() -> bool {
    env::var_os("CI").is_some_and(|ci| !ci.is_empty() && ci != "false" && ci != "0")
}

fn cargo(name: &str, folder: &str, arguments: &[&str], variables: &[(&str, &str)]) -> Result<(), String> {
    run(name, cargo_in(folder).args(arguments).envs(variables.iter().copied()))
}
