//! Running other programs, and the folders that they work in.

use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// Compiler target of the boards.
pub(crate) const M4F: &str = "thumbv7em-none-eabihf";
/// Compiler target of a processor without floating point.
pub(crate) const M3: &str = "thumbv7m-none-eabi";
/// Compiler target of the Raspberry Pi Pico.
pub(crate) const M0_PLUS: &str = "thumbv6m-none-eabi";
/// Compiler target of the Raspberry Pi Pico 2.
pub(crate) const M33: &str = "thumbv8m.main-none-eabihf";
/// Compiler target of the command that needs nothing of a system.
pub(crate) const MUSL: &str = "x86_64-unknown-linux-musl";
/// Compiler target of the studio's page.
pub(crate) const WASM: &str = "wasm32-unknown-unknown";

/// The folder of the artefacts of all images, seen from the folder of any of them.
pub(crate) const IMAGES_TARGET_FOLDER: &str = "../target";

/// The root of the repository.
pub(crate) fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// The folder of the workspace's build artefacts.
pub(crate) fn target_folder() -> PathBuf {
    env::var_os("CARGO_TARGET_DIR").map_or_else(|| root().join("target"), Into::into)
}

/// The absolute path of a file that exists.
pub(crate) fn absolute(path: &Path) -> Result<PathBuf, String> {
    path.canonicalize().map_err(|error| format!("{}: {error}", path.display()))
}

/// Makes a folder, which must be empty or new, and returns its absolute path.
pub(crate) fn empty_folder(name: &str) -> Result<PathBuf, String> {
    let folder = std::path::absolute(name).map_err(|error| format!("{name}: {error}"))?;
    let explain = |error: std::io::Error| format!("{}: {error}", folder.display());
    fs::create_dir_all(&folder).map_err(explain)?;
    if fs::read_dir(&folder).map_err(explain)?.next().is_some() {
        return Err(format!("{} has files in it: give a new folder, or empty it", folder.display()));
    }
    Ok(folder)
}

/// A `cargo` command that runs in a folder of the repository.
pub(crate) fn cargo_in(folder: &str) -> Command {
    let mut command = Command::new(env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.current_dir(root().join(folder));
    command
}

/// Runs a command and returns its standard output.
pub(crate) fn text_of(command: &mut Command) -> Result<String, String> {
    let output = command.stderr(Stdio::inherit()).output();
    let output = output.map_err(|error| format!("{command:?} could not be started: {error}"))?;
    if !output.status.success() {
        return Err(format!("{command:?} failed ({})", output.status));
    }
    String::from_utf8(output.stdout).map_err(|_| format!("{command:?} wrote what is not UTF-8"))
}

/// Prints the name of a command and runs it; fails if the command fails.
pub(crate) fn run(name: &str, command: &mut Command) -> Result<(), String> {
    eprintln!("-- {name}");
    match command.status() {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(format!("{name} failed ({status}): {command:?}")),
        Err(error) => Err(format!("{name} could not be started ({error}): {command:?}")),
    }
}
