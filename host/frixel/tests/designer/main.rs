//! The command as a scene's designer uses it, as a process of its own.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail")]

mod demo;
mod first_scene;
mod numbers;
mod pictures;
#[cfg(unix)]
mod pipes;

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

fn scenes() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes")
}

/// Path of a bundled scene.
fn scene(name: &str) -> String {
    scenes().join(name).display().to_string()
}

fn command(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_frixel"));
    command.args(arguments).current_dir(folder);
    command
}

fn frixel(folder: &Path, arguments: &[&str]) -> Output {
    command(folder, arguments).output().unwrap()
}

/// What a command that succeeds prints to standard output and to standard error.
fn succeed(folder: &Path, arguments: &[&str]) -> (String, String) {
    let output = frixel(folder, arguments);
    let notes = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success(), "{arguments:?}: {notes}");
    (String::from_utf8(output.stdout).unwrap(), notes)
}
