//! The programs that run the Pico's image in an emulator (`hil-sim/pico`): lints and tests of their own, and what
//! `cargo xtask dist` hands on of them.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::command::{absolute, root, run};
use crate::studio_tests::install;

const FOLDER: &str = "hil-sim/pico";
/// The emulator, in the folder of its packages.
const EMULATOR: &str = "node_modules/rp2040js";
/// What the emulator's package has that the programs use: its modules for browsers and node, with their licence.
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
    for entry in fs::read_dir(folder()).map_err(|error| format!("{FOLDER}: {error}"))? {
        let path = entry.map_err(|error| format!("{FOLDER}: {error}"))?.path();
        if path.extension().is_some_and(|extension| extension == "mjs") {
            copy_into(&path, target)?;
        }
    }
    for part in EMULATOR_PARTS {
        let from = folder().join(EMULATOR).join(part);
        let to = target.join(EMULATOR).join(part);
        copy_into(&from, to.parent().unwrap_or(target))?;
    }
    Ok(())
}

/// The licence of the emulator.
pub(crate) fn licence() -> Result<String, String> {
    install(&folder())?;
    let path = folder().join(EMULATOR).join("LICENSE");
    fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))
}

/// Copies a file, or a folder with all that is in it, into a folder, which is made if necessary.
fn copy_into(from: &Path, folder: &Path) -> Result<(), String> {
    let explain = |path: &Path| {
        let path = path.display().to_string();
        move |error: std::io::Error| format!("{path}: {error}")
    };
    let to = folder.join(from.file_name().unwrap_or_default());
    fs::create_dir_all(folder).map_err(explain(folder))?;
    if !from.is_dir() {
        return fs::copy(from, &to).map(drop).map_err(explain(from));
    }
    for entry in fs::read_dir(from).map_err(explain(from))? {
        copy_into(&entry.map_err(explain(from))?.path(), &to)?;
    }
    Ok(())
}
