//! Command lines with their output: the pages in `corpus` have files, a command, and what it prints. Each mistake gets
//! one clear sentence with what was found and what to do. The compiler's sentences about scenes are in
//! `host/scene/tests/corpus`.
//!
//! A block `sh command` has one command per line, run in order. A block `text shows` has beginnings of lines that are
//! printed, and a block `text shows:FILE` beginnings of lines of a file; one that no line begins with is reported at
//! the end. JSON is shown as a line for each of its values, with the path to it. The bundled scenes are in the folder
//! `scenes`.
#![cfg(unix)]
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail")]

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Output;

use frixel_testkit::corpus::{self, Case};
use serde_json::Value;
use tempfile::TempDir;

use crate::processes::{repository, run_fed};

/// Replaces the picture of a control character, such as `␛`, with that character.
fn with_controls(text: &str) -> String {
    let control = |letter: char| match letter {
        '\u{2400}'..='\u{241f}' => char::from_u32(u32::from(letter) - 0x2400).unwrap(),
        other => other,
    };
    text.chars().map(control).collect()
}

/// Blocks that are not files.
const COMMAND: &str = "command";
const STDIN: &str = "stdin";
const SHOWS: &str = "shows";

fn write_files(case: &Case, folder: &Path) {
    for (name, text) in &case.files {
        if [COMMAND, STDIN].contains(&name.as_str()) || name.starts_with(SHOWS) {
            continue;
        }
        let (path, text) = (folder.join(with_controls(name)), with_controls(text));
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        // This character stands for a byte that is not UTF-8.
        let bytes: Vec<&[u8]> = text.split('\u{fffd}').map(str::as_bytes).collect();
        fs::write(path, bytes.join(&0xff)).unwrap();
    }
    if case.files[COMMAND].contains("scenes/") {
        std::os::unix::fs::symlink(repository().join("scenes"), folder.join("scenes")).unwrap();
    }
}

fn run_in(case: &Case, line: &str, folder: &Path) -> Output {
    let words: Vec<String> = line.strip_prefix("frixel").unwrap().split_whitespace().map(with_controls).collect();
    let stdin = case.files.get(STDIN).map_or("", String::as_str);
    run_fed(folder, &words.iter().map(String::as_str).collect::<Vec<_>>(), stdin.as_bytes())
}

/// Names and contents of the files below a folder, without following links.
fn files(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let paths = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let below = |path: PathBuf| match (path.is_symlink(), path.is_dir()) {
        (true, _) => BTreeMap::new(),
        (_, true) => files(&path),
        _ => BTreeMap::from([(path.clone(), fs::read(path).unwrap())]),
    };
    paths.flat_map(below).collect()
}

/// Appends a line for each value in JSON, a number with six digits.
fn show_json(path: &str, value: &Value, shown: &mut String) {
    let below = |name: &str| if path.is_empty() { name.to_owned() } else { format!("{path}.{name}") };
    match value {
        Value::Object(fields) => fields.iter().for_each(|(name, value)| show_json(&below(name), value, shown)),
        Value::Array(values) => {
            (1..).zip(values).for_each(|(number, value)| show_json(&below(&format!("{number}")), value, shown));
        }
        Value::Number(number) if number.is_f64() => {
            let rounded: f64 = format!("{:.5e}", number.as_f64().unwrap()).parse().unwrap();
            writeln!(shown, "{path}: {rounded}").unwrap();
        }
        other => writeln!(shown, "{path}: {other}").unwrap(),
    }
}

/// The lines of a text, or of JSON, that begin with one of these words. Removes the words found from `missing`.
fn shown<'b>(text: &str, beginnings: &'b str, missing: &mut Vec<&'b str>) -> String {
    let mut lines = String::new();
    match serde_json::from_str::<Value>(text) {
        Ok(json @ (Value::Object(_) | Value::Array(_))) => show_json("", &json, &mut lines),
        _ => lines.push_str(text),
    }
    let mut shown = String::new();
    for beginning in beginnings.lines() {
        let found = lines.lines().filter(|line| line.trim_start().starts_with(beginning));
        let before = shown.len();
        shown.extend(found.map(|line| format!("{}\n", line.trim_end())));
        if shown.len() > before {
            missing.retain(|missing| *missing != beginning);
        }
    }
    shown
}

/// A line for each word with which no line begins.
fn absent(missing: &[&str]) -> String {
    missing.iter().flat_map(|beginning| ["(no ", beginning, ")\n"]).collect()
}

fn answer(case: &Case) -> String {
    let folder = TempDir::new().unwrap();
    write_files(case, folder.path());
    let mut answer = String::new();
    let shows = case.files.get(SHOWS).map_or("", String::as_str);
    let mut missing = shows.lines().collect();
    for line in case.files[COMMAND].lines() {
        let before = files(folder.path());
        let output = run_in(case, line, folder.path());
        let code = output.status.code().unwrap();
        assert!(code == 0 || files(folder.path()) == before, "{line} fails and writes");
        let [printed, said] = [output.stdout, output.stderr].map(|text| String::from_utf8(text).unwrap());
        let controls = |character: char| (character.is_control() && character != '\n') || character == '\u{202e}';
        assert!(![&printed, &said].iter().any(|text| text.contains(controls)), "{line} controls a terminal");
        answer += &shown(&printed, shows, &mut missing);
        said.lines().for_each(|line| writeln!(answer, "{}", without_ports(line)).unwrap());
        writeln!(answer, "exit code {code}").unwrap();
    }
    answer += &absent(&missing);
    for (name, shows) in &case.files {
        let Some(file) = name.strip_prefix("shows:") else { continue };
        writeln!(answer, "{file}:").unwrap();
        match fs::read_to_string(folder.path().join(file)) {
            Err(_) => answer += "(no file)\n",
            Ok(text) => {
                let mut missing = shows.lines().collect();
                answer += &shown(&text, shows, &mut missing);
                answer += &absent(&missing);
            }
        }
    }
    answer
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

pages!(boards calibrations checks control control_live drafts options plays ports recordings safety scenarios scenes
    scores streams strokes sweeps tables untrusted);

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/corpus")
}

#[test]
fn every_page_has_a_test() {
    let pages = corpus::pages(&folder());
    assert_eq!(pages.iter().map(|page| page.file_stem().unwrap()).collect::<Vec<_>>(), PAGES);
}
