//! `frixel board record` on the port of a virtual board: rows that cost a person's time are never lost.

use std::fs;
use std::path::Path;
use std::process::{Output, Stdio};

use tempfile::TempDir;

use crate::processes::{frixel, run, said};
use crate::{VirtualBoard, until};

const ROWS: &str = "t_s,x_mm,y_mm\n0.000000,1.0000,2.0000\n0.005000,1.5000,2.0000\n";
const FINGER: [&str; 4] = ["--from", "10,20", "--to", "90,20"];

fn text(folder: &TempDir, name: &str) -> String {
    fs::read_to_string(folder.path().join(name)).unwrap_or_default()
}

fn run_line(folder: &TempDir, line: &str) -> Output {
    run(folder.path(), &line.split_whitespace().collect::<Vec<_>>())
}

/// Runs a command that must fail with these words.
fn expect_refused(folder: &TempDir, line: &str, words: &str) {
    let output = run_line(folder, line);
    assert!(output.status.code() == Some(1) && said(&output).contains(words), "{line}: {}", said(&output));
}

/// Records until `me.csv.partial` has rows, then ends the recorder or its board, and returns what the recorder said.
fn record_until_rows(folder: &TempDir, board: VirtualBoard, kills: bool) -> (VirtualBoard, String) {
    let record = ["board", "record", "--port", &board.port, "-o", "me.csv", "--overwrite"];
    let mut command = frixel();
    command.args(record).current_dir(folder.path()).stdout(Stdio::null()).stderr(Stdio::piped());
    let mut child = command.spawn().unwrap();
    until("rows are written", || text(folder, "me.csv.partial").len() > 2_000);
    let second = "board record --port nowhere -o me.csv --overwrite";
    expect_refused(folder, second, "another frixel writes to me.csv: wait for it");
    let board = if kills {
        child.kill().unwrap();
        board
    } else {
        drop(board);
        VirtualBoard::start(folder.path(), &FINGER)
    };
    (board, said(&child.wait_with_output().unwrap()))
}

#[test]
fn a_recording_that_ends_early_leaves_its_rows_which_the_next_one_names_and_finishes() {
    for kills in [true, false] {
        let folder = TempDir::new().unwrap();
        let (board, notes) = record_until_rows(&folder, VirtualBoard::start(folder.path(), &FINGER), kills);
        let says = "what was recorded until then is in me.csv.partial: add --finish to keep them";
        assert!(kills || notes.contains(says), "{notes}");
        let rows = text(&folder, "me.csv.partial");
        assert!(rows.ends_with('\n') && rows.lines().all(|row| row.split(',').count() == 3), "whole rows");
        let says = "me.csv.partial has the rows of a recording that was cut off: add --finish to keep them, or record \
                    again with --overwrite";
        expect_refused(&folder, &format!("board record --port {} -o me.csv --seconds 0.3", board.port), says);
        // A part of a row, as a process that was killed may leave one.
        fs::write(folder.path().join("me.csv.partial"), rows.clone() + "9.1234").unwrap();
        let finished = run_line(&folder, "board record --finish -o me.csv");
        let printed = String::from_utf8_lossy(&finished.stdout);
        assert!(finished.status.success() && printed.contains("s of touch"), "{printed}{}", said(&finished));
        assert_eq!(text(&folder, "me.csv"), rows);
        expect_refused(&folder, "board record --finish -o other.csv", "leave --finish out");
    }
}

/// Neither a mistyped port nor an untouched screen costs rows, even with `--overwrite`.
#[test]
fn rows_that_may_be_replaced_stay_until_there_are_new_ones() {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("none.csv"), "t_s,x_mm,y_mm\n0,,\n10000,10,20\n10001,20,20\n").unwrap();
    let board = VirtualBoard::start(folder.path(), &["--stroke", "none.csv"]);
    for name in ["me.csv", "me.csv.partial"] {
        fs::write(folder.path().join(name), ROWS).unwrap();
    }
    let says = "me.csv already exists, and recordings are not overwritten: give another name to -o, or add --overwrite";
    expect_refused(&folder, &format!("board record --port {} -o me.csv", board.port), says);
    for port in [format!("{} --seconds 0.3", board.port), "nowhere".to_owned()] {
        expect_refused(&folder, &format!("board record --port {port} -o me.csv --overwrite"), "");
        assert_eq!(["me.csv", "me.csv.partial"].map(|name| text(&folder, name)), [ROWS, ROWS], "{port}");
    }
}

#[test]
fn a_folder_has_one_writer_and_no_picture_of_an_earlier_play() {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("scene.toml"), crate::signals::SCENE).unwrap();
    let board = VirtualBoard::start(folder.path(), &[]);
    for line in ["play scene.toml --seconds 0.1 --out ./board", "demo --out board", "sim --out board"] {
        expect_refused(&folder, line, "another frixel writes to ");
    }
    assert_eq!(text(&folder, "board/felt.csv").matches("t_s,").count(), 1, "one log");
    drop(board);
    // A process that was killed holds no folder. A play to a port has another picture than one on the simulator.
    fs::write(folder.path().join("board/commanded.svg"), "of an earlier play").unwrap();
    let played = run_line(&folder, "play scene.toml --seconds 0.1 --out board");
    assert!(played.status.success(), "{}", said(&played));
    let names = |folder: &Path| -> Vec<String> {
        let entries = fs::read_dir(folder).unwrap();
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect()
    };
    let left = names(&folder.path().join("board"));
    assert!(left.iter().all(|name| !name.contains("frixel-") && name != "commanded.svg"), "{left:?}");
}
