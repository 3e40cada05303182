//! A reader that goes away, such as `head`, ends a command quietly, unless a result is lost by that.

use std::process::{Output, Stdio};

use tempfile::TempDir;

use crate::processes::{bundled, frixel};

/// Runs a command whose standard output, or whose both outputs, nobody reads.
fn unread(arguments: &[&str], both: bool) -> Output {
    let folder = TempDir::new().unwrap();
    let closed = || Stdio::from(std::io::pipe().unwrap().1);
    let mut command = frixel();
    command.args(arguments).current_dir(folder.path());
    command.stdout(closed()).stderr(if both { closed() } else { Stdio::piped() });
    command.output().unwrap()
}

#[test]
fn a_closed_pipe_ends_a_command_quietly() {
    let brick = bundled("brick.toml").display().to_string();
    for arguments in [
        &["play", brick.as_str(), "--seconds", "0.1"][..],
        &["play", brick.as_str(), "--seconds", "0.1", "--json"],
        &["demo"],
        &["check", brick.as_str()],
        &["check", brick.as_str(), "--json"],
        &["schema"],
        &["preview", brick.as_str(), "-o", "map.png"],
        &["board", "ports"],
        &["--help"],
        &["play", "--help"],
    ] {
        let output = unread(arguments, false);
        let said = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.success() && !said.contains("panicked"), "{arguments:?}: {:?}: {said}", output.status);
        let output = unread(arguments, true);
        assert!(output.status.success(), "{arguments:?} without any reader: {:?}", output.status);
    }
    for arguments in [&["play", "nowhere.toml"][..], &["check", "nowhere.toml", "--json"]] {
        assert_eq!(unread(arguments, true).status.code(), Some(1), "{arguments:?}");
    }
}

#[test]
fn a_result_that_is_not_read_is_an_error() {
    let output = unread(&["finger", "calibrate", "--strokes", "9", "-o", "-"], false);
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains("standard output") && said.contains("Broken pipe"), "{said}");
}
