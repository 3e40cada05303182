//! The checks of the studio: types and lints of its scripts, and its tests in Chromium (`host/studio/test`), driven by
//! node and playwright-core.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::command::{WASM, cargo_in, root, run, target_folder, text_of};
use crate::needs::Need;
use crate::{results, studio};

/// What types and lints need.
pub(crate) const SCRIPT_NEEDS: [Need; 3] = [Need::Node, Need::Npm, Need::Git];
/// What the tests need.
pub(crate) const NEEDS: [Need; 5] = [Need::Target(WASM), Need::Node, Need::Npm, Need::Chromium, Need::Git];
/// Examples of `frixel-studio`: the hashes of the gallery, and a virtual board that says it is real.
const HASHES: &str = "seeded_hashes";
const REAL_BOARD: &str = "real_board";
/// Longest time of a file of tests, ms.
const TEST_TIMEOUT_MS: u32 = 600_000;

/// Compares the vendored bundle with its lock file, and checks types and lints of all scripts.
pub(crate) fn check_scripts() -> Result<(), String> {
    for (name, folder) in [("vendored bundle", "host/studio/vendor"), ("scripts of the studio", "host/studio/test")] {
        let folder = root().join(folder);
        install(&folder)?;
        run(name, Command::new("npm").current_dir(&folder).args(["run", "--silent", "check"]))?;
    }
    Ok(())
}

/// Builds the page, and runs the tests in it.
pub(crate) fn run_all() -> Result<(), String> {
    let page = studio::build()?;
    // With the features of the whole workspace, as the other tests are built: nothing is compiled twice.
    let native = ["build", "--locked", "--workspace", "--bin", "frixel", "--example", HASHES, "--example", REAL_BOARD];
    run("command and examples", cargo_in(".").args(native))?;
    let hashes = target_folder().join("studio/hashes.json");
    let computed = text_of(&mut Command::new(built(&format!("examples/{HASHES}"))?))?;
    fs::write(&hashes, computed).map_err(|error| format!("{}: {error}", hashes.display()))?;
    let folder = root().join("host/studio/test");
    install(&folder)?;
    let mut node = Command::new("node");
    node.current_dir(&folder).args(["--test", "--test-concurrency=1"]).arg(format!("--test-timeout={TEST_TIMEOUT_MS}"));
    node.args(tests(&folder)?);
    node.env("STUDIO_PAGE", page).env("STUDIO_HASHES", absolute(&hashes)?);
    node.env("FRIXEL", built("frixel")?).env("REAL_BOARD", built(&format!("examples/{REAL_BOARD}"))?);
    results::run("studio in a browser", &mut node)
}

/// Installs the packages of the lock file, unless they are there.
fn install(folder: &Path) -> Result<(), String> {
    // npm writes this file last, so it is newer than the lock file that it was made from.
    let modified = |name: &str| fs::metadata(folder.join(name)).and_then(|metadata| metadata.modified()).ok();
    if modified("node_modules/.package-lock.json") >= modified("package-lock.json") {
        return Ok(());
    }
    run("node packages", Command::new("npm").current_dir(folder).args(["ci", "--no-audit", "--no-fund"]))
}

/// The names of the test files, sorted.
fn tests(folder: &Path) -> Result<Vec<String>, String> {
    let entries = fs::read_dir(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let names = entries.filter_map(|entry| entry.ok()?.file_name().into_string().ok());
    let mut names: Vec<String> = names.filter(|name| name.ends_with(".test.mjs")).collect();
    names.sort();
    Ok(names)
}

/// A program of the test build.
fn built(name: &str) -> Result<PathBuf, String> {
    absolute(&target_folder().join("debug").join(name))
}

fn absolute(path: &Path) -> Result<PathBuf, String> {
    path.canonicalize().map_err(|error| format!("{}: {error}", path.display()))
}
