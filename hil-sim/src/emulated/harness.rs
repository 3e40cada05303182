//! The programs that run the Pico's image, shipped with this program or found in the checkout.

use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::Mutex;

use super::EmulatorError;
use super::image::{beside_program, source_folder};

/// Their folder among the images that come with a program.
const BESIDE: &str = "pico-rig";
/// Their folder in a checkout.
const SOURCES: &str = "hil-sim/pico";
const MAIN: &str = "main.mjs";

/// Serialises installations.
static TURN: Mutex<()> = Mutex::new(());

/// The program that node runs. In a checkout, this first installs the emulator if necessary.
pub(super) fn find() -> Result<PathBuf, EmulatorError> {
    if let Some(folder) = beside_program(BESIDE) {
        return Ok(folder.join(MAIN));
    }
    let folder = source_folder(SOURCES)?;
    install(&folder)?;
    Ok(folder.join(MAIN))
}

/// Installs the packages of the lock file, if necessary.
fn install(folder: &Path) -> Result<(), EmulatorError> {
    let _turn = TURN.lock();
    // npm writes this file last, so it is newer than its lock file.
    let modified = |name: &str| fs::metadata(folder.join(name)).and_then(|metadata| metadata.modified()).ok();
    if modified("node_modules/.package-lock.json") >= modified("package-lock.json") {
        return Ok(());
    }
    let ran =
        Command::new("npm").args(["ci", "--no-audit", "--no-fund"]).current_dir(folder).stdin(Stdio::null()).output();
    match ran {
        Ok(output) if output.status.success() => Ok(()),
        Ok(output) => Err(EmulatorError::Failed {
            failure: format!("the emulator rp2040js could not be installed by `npm ci` in {}", folder.display()),
            output: String::from_utf8_lossy(&output.stderr).into_owned(),
        }),
        Err(error) if error.kind() == ErrorKind::NotFound => Err(EmulatorError::NotInstalled {
            what: "the Pico's emulator rp2040js is fetched by npm, which",
            command: "apt-get install npm".into(),
        }),
        Err(error) => Err(EmulatorError::system("starting npm")(error)),
    }
}
