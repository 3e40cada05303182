//! The checks of JavaScript, most of which is the studio's: types and lints of its scripts, and its tests in Chromium
//! (`host/studio/test`), driven by node and playwright-core.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::command::{absolute, entries, remove, root, run, target_folder, text_of, write};
use crate::{ci, needs, pico_rig, studio};

/// Examples of `frixel-studio`: the hashes of the gallery, and a virtual board that says it is real.
const HASHES: &str = "seeded_hashes";
const REAL_BOARD: &str = "real_board";
/// Takes the pictures of docs/design/studio.
const SHOTS: &str = "shots.mjs";
/// Files of tests that run at once: those on the machine's clock wait, while others compute.
const FILES_AT_ONCE: u32 = 2;
/// Longest time of a file of tests, ms.
const TEST_TIMEOUT_MS: u32 = 600_000;

/// Compares the vendored bundle with its lock file, and checks types and lints of all scripts.
pub(crate) fn check_scripts() -> Result<(), String> {
    for (name, folder) in [("vendored bundle", "host/studio/vendor"), ("scripts of the studio", "host/studio/test")] {
        let folder = root().join(folder);
        install(&folder)?;
        run(name, Command::new("npm").current_dir(&folder).args(["run", "--silent", "check"]))?;
    }
    pico_rig::check_scripts(&folder())
}

/// Builds the page, and runs the tests in it.
pub(crate) fn run_page() -> Result<(), String> {
    let mut runner = runner()?;
    let hashes = target_folder().join("studio/hashes.json");
    let computed = text_of(&mut Command::new(built(&format!("examples/{HASHES}"))?))?;
    write(&hashes, computed)?;
    runner.env("STUDIO_HASHES", absolute(&hashes)?).env("STUDIO_SITE", site()?);
    let is_test = |path: &PathBuf| path.to_string_lossy().ends_with(".test.mjs");
    run("studio in a browser", runner.args(entries(&folder())?.into_iter().filter(is_test)))
}

/// Builds the site, and opens it in Firefox.
pub(crate) fn run_in_firefox() -> Result<(), String> {
    let site = site()?;
    let folder = folder().join("firefox");
    install(&folder)?;
    let mut node = Command::new("npm");
    node.current_dir(&folder).args(["run", "--silent", "test"]).env("STUDIO_SITE", site);
    run("site in Firefox", node.env("FIREFOX", needs::firefox()))
}

/// Builds the site anew, and returns its folder.
fn site() -> Result<PathBuf, String> {
    let site = target_folder().join("studio/site");
    remove(&site)?;
    studio::build_site(&site.to_string_lossy(), None)?;
    absolute(&site)
}

/// Builds the page, and takes the pictures of docs/design/studio.
pub(crate) fn take_shots() -> Result<(), String> {
    let page = studio::build()?;
    let folder = folder();
    install(&folder)?;
    let mut node = Command::new("node");
    run("pictures of the studio", node.current_dir(&folder).arg(SHOTS).env("STUDIO_PAGE", page))
}

/// The runner of tests, with the page and the virtual board that says it is real. Builds these.
fn runner() -> Result<Command, String> {
    let page = studio::build()?;
    let names = [REAL_BOARD, HASHES].into_iter().flat_map(|name| ["--example", name]);
    run("examples", ci::beside_default("build").args(names))?;
    let folder = folder();
    install(&folder)?;
    let mut node = Command::new("node");
    node.current_dir(&folder).arg("--test").arg(format!("--test-concurrency={FILES_AT_ONCE}"));
    node.arg(format!("--test-timeout={TEST_TIMEOUT_MS}"));
    node.env("STUDIO_PAGE", page).env("REAL_BOARD", built(&format!("examples/{REAL_BOARD}"))?);
    Ok(node)
}

/// The folder of the tests.
pub(crate) fn folder() -> PathBuf {
    root().join("host/studio/test")
}

/// Installs the packages of the lock file, unless they are there.
pub(crate) fn install(folder: &Path) -> Result<(), String> {
    // npm writes this file last, so it is newer than the lock file that it was made from.
    let modified = |name: &str| fs::metadata(folder.join(name)).and_then(|metadata| metadata.modified()).ok();
    if modified("node_modules/.package-lock.json") >= modified("package-lock.json") {
        return Ok(());
    }
    run("node packages", Command::new("npm").current_dir(folder).args(["ci", "--no-audit", "--no-fund"]))
}

/// A program of the test build.
fn built(name: &str) -> Result<PathBuf, String> {
    absolute(&target_folder().join("debug").join(name))
}
