//! Wrong inputs, a row each: every one gives one clear sentence with what was found and what to do, an exit code of 1,
//! or of 2 for an invalid command line, and no panic. A wrong control line ends nothing: its sentence comes, and the
//! play goes on.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail")]

mod commands;
mod files;
mod scenes;

use std::fs;
use std::io::Write;
use std::path::Path;
use std::process::{Command, Output, Stdio};

use tempfile::TempDir;

/// A wrong input, and what `frixel` says to it.
struct Case {
    what: &'static str,
    /// First line of `s.toml`.
    head: &'static str,
    /// The rest of `s.toml`, this many times.
    scene: &'static str,
    times: usize,
    /// Other files in the folder.
    files: &'static [(&'static str, Content)],
    /// The arguments of the command.
    run: &'static str,
    stdin: &'static str,
    code: i32,
    /// Lines on standard error, for commands that fail with 1 and for control lines.
    lines: usize,
    /// What stands on standard error behind `frixel: ` or `error: `.
    says: &'static str,
}

const CASE: Case = Case {
    what: "",
    head: "version = 2\n",
    scene: "",
    times: 1,
    files: &[],
    run: "scene check s.toml",
    stdin: "",
    code: 1,
    lines: 1,
    says: "",
};

enum Content {
    Text(&'static str),
    Bytes(&'static [u8]),
    /// A picture.
    Brick,
    /// The first half of a picture's bytes.
    HalfBrick,
}

impl Case {
    fn write_to(&self, folder: &Path) {
        fs::write(folder.join("s.toml"), format!("{}{}", self.head, self.scene.repeat(self.times))).unwrap();
        let brick = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/textures/brick.png");
        let brick = fs::read(brick).unwrap();
        for (name, content) in self.files {
            let bytes = match content {
                Content::Text(text) => text.as_bytes(),
                Content::Bytes(bytes) => bytes,
                Content::Brick => &brick,
                Content::HalfBrick => &brick[..brick.len() / 2],
            };
            fs::write(folder.join(name), bytes).unwrap();
        }
    }

    fn run_in(&self, folder: &Path) -> Output {
        let mut command = Command::new(env!("CARGO_BIN_EXE_frixel"));
        command.args(self.run.split(' ')).current_dir(folder);
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().unwrap();
        // A command that fails before it reads closes the pipe.
        let _ = child.stdin.take().unwrap().write_all(self.stdin.as_bytes());
        child.wait_with_output().unwrap()
    }

    /// What is wrong with the answer, if anything is.
    fn complaint(&self) -> Option<String> {
        let folder = TempDir::new().unwrap();
        self.write_to(folder.path());
        let output = self.run_in(folder.path());
        let said = String::from_utf8(output.stderr).unwrap();
        // clap prints the usage behind its sentence.
        let lines = if self.code == 2 { self.lines } else { said.lines().count() };
        let begins = ["frixel: ", "error: ", ""].iter().any(|start| said.starts_with(&format!("{start}{}", self.says)));
        let is_right = begins && lines == self.lines && output.status.code() == Some(self.code);
        (!is_right).then(|| {
            format!(
                "{} ({}): exit code {:?}, and it said\n{said}instead of\n{}\n",
                self.what,
                self.run,
                output.status.code(),
                self.says
            )
        })
    }
}

#[track_caller]
fn check(cases: &[Case], at_least: usize) {
    let complaints: Vec<String> = cases.iter().filter_map(Case::complaint).collect();
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
    assert!(cases.len() >= at_least, "{} cases", cases.len());
}

#[test]
fn wrong_scenes() {
    check(scenes::SCENES, 30);
}

#[test]
fn wrong_pictures() {
    check(files::PICTURES, 8);
}

#[test]
fn wrong_profiles() {
    check(files::PROFILES, 8);
}

#[test]
fn wrong_strokes() {
    check(files::STROKES, 12);
}

#[test]
fn wrong_streams() {
    check(files::STREAMS, 5);
}

#[test]
fn wrong_tables_of_numbers() {
    check(files::DATA, 5);
}

#[test]
fn wrong_options() {
    check(commands::OPTIONS, 12);
}

#[test]
fn wrong_control_lines() {
    check(commands::CONTROLS, 8);
}

#[test]
fn wrong_ports() {
    check(commands::PORTS, 4);
}
