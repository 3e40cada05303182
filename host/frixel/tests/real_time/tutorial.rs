//! `docs/design/tutorial.md` does what it says.
//!
//! The test does what a reader does, block by block: it runs every line of a block `sh`, and those that go on (`frixel
//! sim`, `--watch`) until the page ends; it writes a block `toml` into the file that the line above the block names; it
//! makes the edits of the form "in `FILE`, change `A` to `B`"; and it finds the lines of a block `text` in what the
//! last command printed, up to three dots.

use std::fs::{self, File};
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::Stdio;

use tempfile::TempDir;

use crate::processes::{bundled, frixel, repository, run, said};
use crate::{Running, VirtualBoard, until};

/// The port in the page.
const PORT: &str = "/dev/pts/3";

/// A reader of the page, in a folder of its own.
struct Reader {
    folder: TempDir,
    board: Option<VirtualBoard>,
    /// A command that goes on, and prints to the file `said`.
    watching: Option<Running>,
    printed: String,
    commands: usize,
    edits: usize,
}

impl Reader {
    fn path(&self) -> &Path {
        self.folder.path()
    }

    fn run(&mut self, line: &str) {
        let (line, comment) = line.split_once('#').unwrap_or((line, ""));
        let (line, input) = line.split_once('<').map_or((line, None), |(line, file)| (line, Some(file.trim())));
        let line = line.trim().strip_prefix("frixel ").unwrap_or_else(|| panic!("{line}"));
        self.commands += 1;
        if let Some(arguments) = line.strip_prefix("sim") {
            let arguments: Vec<&str> = arguments.split_whitespace().collect();
            self.board = Some(VirtualBoard::start(self.path(), &arguments));
            return;
        }
        // Ctrl-C ends the play that follows its file, which has the folder to itself.
        if line.starts_with("play") {
            self.watching = None;
        }
        let port = self.board.as_ref().map_or(PORT, |board| &board.port);
        let arguments: Vec<&str> = line.split_whitespace().map(|word| if word == PORT { port } else { word }).collect();
        let mut process = frixel();
        process.args(&arguments).current_dir(self.path());
        if let Some(file) = input {
            process.stdin(File::open(self.path().join(file)).unwrap());
        }
        if arguments.contains(&"--watch") {
            // The longest host timeout that there is: on a busy machine pings are late.
            let scene = self.path().join(arguments[1]);
            let text = fs::read_to_string(&scene).unwrap();
            fs::write(&scene, format!("{text}\n[drive]\nhost_timeout_ms = 1000\n")).unwrap();
            let said = self.path().join("said");
            process.stdout(Stdio::null()).stderr(File::create(&said).unwrap());
            self.watching = Some(Running(process.spawn().unwrap()));
            // The first scene plays when rows of telemetry are there.
            let rows = self.path().join("frixel-out/.felt.csv.frixel-tmp");
            until("the scene plays", || fs::read_to_string(&rows).is_ok_and(|text| text.lines().count() > 2));
            return;
        }
        let output = process.output().unwrap();
        self.printed = String::from_utf8(output.stdout).unwrap() + &String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.success(), comment.trim() != "fails", "{line}: {}", self.printed);
        if input.is_some() {
            self.expect_notification();
        }
    }

    /// The felt friction and the names of layers are those that the page promises for its control lines.
    fn expect_notification(&self) {
        let rows = fs::read_to_string(self.path().join("frixel-out/felt.csv")).unwrap();
        let number = |row: &str, column: usize| row.split(',').nth(column).unwrap().parse::<f64>().unwrap();
        // The buzz of 0.8 of 130 mN, in mN from least to largest, beside load changes of some 30 mN.
        let range_mn = |from_s: f64, to_s: f64| {
            let inside = |row: &&str| (from_s..to_s).contains(&number(row, 0));
            let felt_n = rows.lines().skip(1).filter(inside).map(|row| number(row, 6));
            let (least, most) = felt_n.fold((f64::MAX, f64::MIN), |(least, most), n| (least.min(n), most.max(n)));
            1e3 * (most - least)
        };
        assert!(range_mn(0.05, 0.28) < 50.0 && range_mn(0.75, 1.05) < 50.0, "the layer is off");
        let (whole, half) = (range_mn(0.35, 0.65), range_mn(1.15, 1.45));
        assert!(whole > 100.0 && half > 60.0 && half < 0.9 * whole, "{whole} and {half} mN");
        let svg = fs::read_to_string(self.path().join("frixel-out/felt.svg")).unwrap();
        assert!(svg.contains("notification off"));
    }

    /// Finds lines in what the last command printed, or waits for them if it goes on.
    fn expect(&self, block: &[String]) {
        for line in block {
            let part = line.trim().trim_end_matches("...");
            if self.watching.is_some() {
                let said = || fs::read_to_string(self.path().join("said")).unwrap();
                until(part, || said().contains(part));
            } else {
                assert!(self.printed.contains(part), "{part}: {}", self.printed);
            }
        }
    }

    /// Makes the edits of a paragraph.
    fn edit(&mut self, text: &str) {
        for edit in text.split(", change `").skip(1) {
            let before = text.split(", change `").next().unwrap_or_default();
            let file = before.trim_end_matches('`').rsplit('`').next().unwrap();
            let (from, rest) = edit.split_once("` to `").unwrap();
            let to = rest.split('`').next().unwrap();
            let path = self.path().join(file);
            let text = fs::read_to_string(&path).unwrap();
            assert!(text.contains(from), "{file} has no {from}: {text}");
            fs::write(&path, text.replacen(from, to, 1)).unwrap();
            self.edits += 1;
        }
    }
}

/// The last scene has all of the others, and a board plays it: what it says is no draft.
fn expect_playable(folder: &Path) {
    let checked = run(folder, &["check", "all.toml"]);
    let said = String::from_utf8_lossy(&checked.stdout).into_owned() + &said(&checked);
    assert!(checked.status.success(), "a board refuses all.toml: {said}");
    assert!(said.contains("\"notification\"") && said.contains("\"picture\""), "{said}");
}

#[test]
fn every_command_of_the_tutorial_runs() {
    let page = File::open(repository().join("docs/design/tutorial.md")).unwrap();
    let folder = TempDir::new().unwrap();
    fs::copy(bundled("textures/wood.jpg"), folder.path().join("wood.jpg")).unwrap();
    let mut reader = Reader { folder, board: None, watching: None, printed: String::new(), commands: 0, edits: 0 };
    let mut lines = BufReader::new(page).lines().map(Result::unwrap);
    let mut paragraph = String::new();
    while let Some(line) = lines.next() {
        let Some(kind) = line.strip_prefix("```") else {
            if line.is_empty() || line.starts_with('#') {
                reader.edit(&paragraph);
                paragraph = if line.is_empty() { paragraph } else { String::new() };
                if !line.is_empty() || !paragraph.trim_end().ends_with(':') {
                    paragraph.clear();
                }
            } else {
                paragraph += &line;
                paragraph.push(' ');
            }
            continue;
        };
        let block: Vec<String> = lines.by_ref().take_while(|line| line != "```").collect();
        let text = block.join("\n") + "\n";
        // The file that the paragraph before the block ends with.
        let before = paragraph.trim_end().trim_end_matches(':');
        let named = before.strip_suffix('`').and_then(|before| before.rsplit('`').next());
        match (kind, named) {
            ("sh", _) => block.iter().for_each(|line| reader.run(line)),
            ("toml" | "text", Some(file)) if paragraph.contains("Write") => {
                fs::write(reader.path().join(file), text).unwrap();
            }
            ("toml", Some(file)) if paragraph.contains("At the end of") => {
                let path = reader.path().join(file);
                fs::write(&path, fs::read_to_string(&path).unwrap() + &text).unwrap();
            }
            ("text", _) => reader.expect(&block),
            (kind, named) => panic!("a block {kind:?} of {named:?} after {paragraph:?}"),
        }
        paragraph.clear();
    }
    expect_playable(reader.path());
    assert!(reader.commands >= 14 && reader.edits >= 3, "{} commands, {} edits", reader.commands, reader.edits);
    for name in ["frixel-out/map.png", "all.png", "frixel-out/felt.svg"] {
        assert!(reader.path().join(name).metadata().unwrap().len() > 1_000, "{name}");
    }
}
