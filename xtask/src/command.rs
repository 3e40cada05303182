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

/// Reads a file as text.
pub(crate) fn text(path: &Path) -> Result<String, String> {
    fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))
}

/// Reads a file.
pub(crate) fn bytes(path: &Path) -> Result<Vec<u8>, String> {
    fs::read(path).map_err(|error| format!("{}: {error}", path.display()))
}

/// Writes a file, and makes the folders around it.
pub(crate) fn write(path: &Path, content: impl AsRef<[u8]>) -> Result<(), String> {
    let folder = path.parent().unwrap_or(Path::new("."));
    fs::create_dir_all(folder)
        .and_then(|()| fs::write(path, content))
        .map_err(|error| format!("{}: {error}", path.display()))
}

/// Copies a file, and makes the folders around the copy.
pub(crate) fn copy(from: &Path, to: &Path) -> Result<(), String> {
    let folder = to.parent().unwrap_or(Path::new("."));
    let copied = fs::create_dir_all(folder).and_then(|()| fs::copy(from, to));
    copied.map(drop).map_err(|error| format!("{} to {}: {error}", from.display(), to.display()))
}

/// The files and folders in a folder, sorted.
pub(crate) fn entries(folder: &Path) -> Result<Vec<PathBuf>, String> {
    let paths = fs::read_dir(folder).and_then(|entries| entries.map(|entry| Ok(entry?.path())).collect());
    let mut paths: Vec<PathBuf> = paths.map_err(|error| format!("{}: {error}", folder.display()))?;
    paths.sort();
    Ok(paths)
}

/// The files of a folder and of those in it, sorted.
pub(crate) fn files_below(folder: &Path) -> Result<Vec<PathBuf>, String> {
    let mut files = Vec::new();
    for path in entries(folder)? {
        if path.is_dir() {
            files.extend(files_below(&path)?);
        } else {
            files.push(path);
        }
    }
    Ok(files)
}

/// Removes a folder, if it is there.
pub(crate) fn remove(folder: &Path) -> Result<(), String> {
    if folder.exists() {
        fs::remove_dir_all(folder).map_err(|error| format!("{}: {error}", folder.display()))
    } else {
        Ok(())
    }
}

/// Makes a folder, which must be empty or new, and returns its absolute path.
pub(crate) fn empty_folder(name: &str) -> Result<PathBuf, String> {
    let folder = std::path::absolute(name).map_err(|error| format!("{name}: {error}"))?;
    fs::create_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    if !entries(&folder)?.is_empty() {
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

/// Runs command lines of cargo in the root of the repository, one after the other. A test that lacks its rig fails, as
/// in continuous integration.
pub(crate) fn run_lines(lines: &[&str]) -> Result<(), String> {
    lines.iter().try_for_each(|line| run(line, cargo_in(".").args(line.split(' ').skip(1)).env("CI", "true")))
}
