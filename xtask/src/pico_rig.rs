//! The programs that run the Pico's image in an emulator (`hil-sim/pico`): lints and tests of their own, and what
//! `cargo xtask dist` hands on of them.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::command::{absolute, copy, entries, files_below, root, run, text};
use crate::studio_tests::install;

const FOLDER: &str = "hil-sim/pico";
/// The emulator, in the folder of its packages.
const EMULATOR: &str = "node_modules/rp2040js";
/// Parts of the emulator's package that the programs use: its modules for browsers and node, with their licence.
const EMULATOR_PARTS: [&str; 3] = ["package.json", "LICENSE", "dist/esm"];

fn folder() -> PathBuf {
    root().join(FOLDER)
}

/// Checks the lints of the scripts, with the linter that the tests of the studio have in `linter`.
pub(crate) fn check_scripts(linter: &Path) -> Result<(), String> {
    let linter = linter.join("node_modules/.bin/biome");
    let linter = absolute(&linter)?;
    let lint = ["lint", "--error-on-warnings"];
    run("scripts of the Pico's rig", Command::new(linter).current_dir(folder()).args(lint))
}

/// Runs the tests of the scripts, which need no image.
pub(crate) fn test_scripts() -> Result<(), String> {
    install(&folder())?;
    run("scripts of the Pico's rig", Command::new("npm").current_dir(folder()).args(["test", "--silent"]))
}

/// Copies the programs and the emulator.
pub(crate) fn copy_to(target: &Path) -> Result<(), String> {
    install(&folder())?;
    let copied = |name: &Path| copy(&folder().join(name), &target.join(name));
    for program in entries(&folder())?.iter().filter(|path| path.extension().is_some_and(|ending| ending == "mjs")) {
        copied(Path::new(program.file_name().unwrap_or_default()))?;
    }
    for part in EMULATOR_PARTS {
        let path = folder().join(EMULATOR).join(part);
        let files = if path.is_dir() { files_below(&path)? } else { vec![path] };
        files.iter().try_for_each(|file| copied(file.strip_prefix(folder()).unwrap_or(file)))?;
    }
    Ok(())
}

/// The licence of the emulator.
pub(crate) fn licence() -> Result<String, String> {
    install(&folder())?;
    text(&folder().join(EMULATOR).join("LICENSE"))
}
