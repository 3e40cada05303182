//! Shared by the tests that run `frixel` as a process.
#![allow(clippy::unwrap_used, clippy::panic, reason = "part of a test, which may fail")]

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

/// All of a scene but its layers: a screen of 120 mm by 80 mm, 0.25 N of natural friction, 27.78
/// mN more.
pub(crate) const HEAD: &str = "\
version = 1

[screen]
width_mm = 120
height_mm = 80
[screen.coating]
thickness_um = 10
permittivity = 1

[finger]
radius_mm = 8
stiffness_pa_per_m = 1.8e7
friction_coefficient = 0.5
normal_load_n = 0.5
skin_gap_um = 0
";

pub(crate) fn frixel() -> Command {
    Command::new(env!("CARGO_BIN_EXE_frixel"))
}

/// Runs a command in a folder, without any input.
pub(crate) fn run(folder: &Path, arguments: &[&str]) -> Output {
    frixel().args(arguments).current_dir(folder).output().unwrap()
}

/// Runs a command in a folder with this input, which it need not read.
pub(crate) fn run_fed(folder: &Path, arguments: &[&str], input: &[u8]) -> Output {
    let mut command = frixel();
    command.args(arguments).current_dir(folder);
    let mut process = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    // A command that ends before its input closes the pipe.
    let _ = process.stdin.take().unwrap().write_all(input);
    process.wait_with_output().unwrap()
}

/// The standard output of a command that succeeds.
pub(crate) fn succeed(folder: &Path, arguments: &[&str]) -> String {
    let output = run(folder, arguments);
    assert!(output.status.success(), "{arguments:?}: {}", said(&output));
    String::from_utf8(output.stdout).unwrap()
}

/// The standard error of a command.
pub(crate) fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

pub(crate) fn repository() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Path of a bundled scene, or of a file beside the scenes.
pub(crate) fn bundled(name: &str) -> PathBuf {
    repository().join("scenes").join(name)
}
