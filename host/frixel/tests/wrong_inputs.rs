//! Wrong inputs of the command: the pages in `corpus` have files, a command line, and what must be said to it, in one
//! clear sentence with what was found and what to do. What the compiler says about scenes stands in
//! `host/scene/tests/corpus`.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail")]

use std::collections::BTreeMap;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Output, Stdio};

use frixel_testkit::corpus::{self, Case};
use tempfile::TempDir;

use crate::processes::frixel;

/// Blocks that are no files.
const COMMAND: &str = "command";
const STDIN: &str = "stdin";

fn write_files(case: &Case, folder: &Path) {
    for (name, text) in case.files.iter().filter(|(name, _)| ![COMMAND, STDIN].contains(&name.as_str())) {
        // This character stands for a byte that is not UTF-8.
        let bytes: Vec<&[u8]> = text.split('\u{fffd}').map(str::as_bytes).collect();
        fs::write(folder.join(name), bytes.join(&0xff)).unwrap();
    }
}

fn run_in(case: &Case, folder: &Path) -> Output {
    let line = case.files[COMMAND].trim_end().strip_prefix("frixel").unwrap();
    let mut command = frixel();
    command.args(line.split_whitespace()).current_dir(folder);
    let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let stdin = case.files.get(STDIN).map_or("", String::as_str);
    // A command that fails before it reads closes the pipe.
    let _ = child.stdin.take().unwrap().write_all(stdin.as_bytes());
    child.wait_with_output().unwrap()
}

/// Names and contents of the files in a folder; a folder in it has none.
fn files(folder: &Path) -> BTreeMap<PathBuf, Option<Vec<u8>>> {
    let paths = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    paths.map(|path| (path.clone(), fs::read(path).ok())).collect()
}

fn answer(case: &Case) -> String {
    let folder = TempDir::new().unwrap();
    write_files(case, folder.path());
    let before = files(folder.path());
    let output = run_in(case, folder.path());
    let code = output.status.code().unwrap();
    if code != 0 {
        assert!(files(folder.path()) == before, "{} fails and writes", case.files[COMMAND]);
    }
    let said = String::from_utf8(output.stderr).unwrap();
    let lines: Vec<String> = said.lines().map(|line| format!("{}\n", without_ports(line))).collect();
    format!("{}exit code {code}\n", lines.concat())
}

/// A line without the list of this machine's ports.
fn without_ports(line: &str) -> String {
    let Some((before, after)) = line.split_once("; ").filter(|(before, _)| before.contains("there is no port")) else {
        return line.to_owned();
    };
    after.split_once("; ").map_or(before.to_owned(), |(_, rest)| format!("{before}; {rest}"))
}

/// A test for each page, so that they run beside one another.
macro_rules! pages {
    ($($page:ident)*) => {
        const PAGES: &[&str] = &[$(stringify!($page)),*];

        $(#[test]
        fn $page() {
            corpus::hold(&folder().join(concat!(stringify!($page), ".md")), answer);
        })*
    };
}

pages!(boards calibrations control control_live options ports recordings scenarios scenes streams strokes sweeps tables);

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/corpus")
}

#[test]
fn every_page_has_a_test() {
    let pages = corpus::pages(&folder());
    assert_eq!(pages.iter().map(|page| page.file_stem().unwrap()).collect::<Vec<_>>(), PAGES);
}
