//! Golden files: files of the repository that a test regenerates and compares.
#![allow(clippy::panic, reason = "part of a test, which may fail")]

use std::path::Path;
use std::{env, fs, thread};

/// The environment variable that makes tests rewrite their golden files.
const BLESS: &str = "FRIXEL_BLESS";

/// The line after a generated part of a page.
const PART_END: &str = "<!-- end -->";

/// Whether golden files are to be rewritten.
pub fn is_blessing() -> bool {
    env::var_os(BLESS).is_some()
}

/// Panics unless a golden file has this text; with `FRIXEL_BLESS` set, writes it.
///
/// # Panics
///
/// The file has another text. The message shows the first line that differs, and the command that blesses the file.
#[track_caller]
pub fn hold(path: &Path, text: &str) {
    if is_blessing() {
        fs::write(path, text).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        return;
    }
    let held = fs::read_to_string(path).unwrap_or_default();
    if held != text {
        let difference = first_difference(&held, text);
        panic!("{} is not what this test makes. {difference}\n{}", path.display(), how_to_bless());
    }
}

/// As [`hold`], for the part of a page between the line that begins with `mark` and the line `<!-- end -->`.
///
/// # Panics
///
/// Also if the page cannot be read or has no such lines.
#[track_caller]
pub fn hold_part(path: &Path, mark: &str, part: &str) {
    let page = fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let split = || {
        let (before, rest) = page.split_at(page.find(mark)?);
        let (line, rest) = rest.split_once('\n')?;
        let (_, after) = rest.split_at(rest.find(PART_END)?);
        Some(format!("{before}{line}\n\n{part}\n{after}"))
    };
    let text = split().unwrap_or_else(|| panic!("{} has no lines `{mark}` and `{PART_END}`", path.display()));
    hold(path, &text);
}

/// The first line in which two texts differ.
fn first_difference(held: &str, made: &str) -> String {
    let lines = held.lines().zip(made.lines()).enumerate();
    let differing = lines.map(|(number, lines)| (number + 1, lines)).find(|(_, (held, made))| held != made);
    match differing {
        Some((number, (held, made))) => format!("Line {number} is\n{held}\nand the test makes\n{made}"),
        None => format!("It has {} bytes, and the test makes {}.", held.len(), made.len()),
    }
}

/// Advice when a golden file differs, with the command that blesses the golden files of the running test.
pub fn how_to_bless() -> String {
    let package = env::var("CARGO_PKG_NAME").map(|name| format!(" -p {name}")).unwrap_or_default();
    // The test harness names the thread of a test after the test, unless all run on its main thread.
    let test = thread::current().name().filter(|name| *name != "main").map(|name| format!(" {name}"));
    let test = test.unwrap_or_default();
    format!("If the change is intended, run `{BLESS}=1 cargo test{package}{test}` to update it.")
}
