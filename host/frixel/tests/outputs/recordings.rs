//! Recordings of people, which take a person's time.

use std::process::Stdio;

use super::{Folder, VirtualBoard};
use crate::processes::until;

const ROWS: &str = "t_s,x_mm,y_mm\n0.000000,1.0000,2.0000\n0.005000,1.5000,2.0000\n";
const FINGER: &str = "sim --out board --from 10,20 --to 90,20";

/// Records until `me.csv.partial` has rows, then ends the recorder in this way, and returns what it said.
fn record_until_rows(folder: &Folder, board: VirtualBoard, kills: bool) -> (VirtualBoard, String) {
    let line = format!("board record --port {} -o me.csv --overwrite", board.port);
    let mut child = folder.command(&line).stdout(Stdio::null()).spawn().unwrap();
    until("rows", || folder.path("me.csv.partial").exists() && folder.text("me.csv.partial").len() > 2_000);
    let second = folder.run("board record --port nowhere -o me.csv --overwrite");
    assert!(second.refused("another frixel writes to me.csv: wait for it"), "{}", second.notes);
    let board = if kills {
        child.kill().unwrap();
        board
    } else {
        drop(board);
        VirtualBoard::start(folder, FINGER)
    };
    (board, String::from_utf8(child.wait_with_output().unwrap().stderr).unwrap())
}

#[test]
fn a_recording_that_ends_early_leaves_its_rows_which_the_next_one_names_and_finishes() {
    for kills in [true, false] {
        let folder = Folder::new();
        let (board, said) = record_until_rows(&folder, VirtualBoard::start(&folder, FINGER), kills);
        let says = "what was recorded until then is in me.csv.partial: add --finish to keep them";
        assert!(kills || said.contains(says), "{said}");
        let rows = folder.text("me.csv.partial");
        assert!(rows.ends_with('\n') && rows.lines().all(|row| row.split(',').count() == 3), "whole rows");
        let ran = folder.run(&format!("board record --port {} -o me.csv --seconds 0.3", board.port));
        let says = "me.csv.partial has the rows of a recording that was cut off: add --finish to keep them, or record \
                    anew with --overwrite";
        assert!(ran.refused(says), "{}", ran.notes);
        // A part of a row, as a process that was killed may leave one.
        folder.write("me.csv.partial", &(rows.clone() + "9.1234"));
        let ran = folder.run("board record --finish -o me.csv");
        assert!(ran.code == Some(0) && ran.said.contains("s of touch"), "{}{}", ran.said, ran.notes);
        assert_eq!(folder.text("me.csv"), rows);
        assert!(folder.run("board record --finish -o other.csv").refused("leave --finish out"));
    }
}

/// Neither a port that is mistyped nor a screen that nobody touches costs rows, even with leave to replace them.
#[test]
fn rows_that_may_be_replaced_stay_until_there_are_new_ones() {
    let folder = Folder::new();
    folder.write("none.csv", "t_s,x_mm,y_mm\n0,,\n10000,10,20\n10001,20,20\n");
    let board = VirtualBoard::start(&folder, "sim --out board --stroke none.csv");
    folder.write("me.csv", ROWS);
    folder.write("me.csv.partial", ROWS);
    let ran = folder.run(&format!("board record --port {} -o me.csv", board.port));
    let says = "me.csv is there already, and a recording is not replaced: give another name to -o, or add --overwrite";
    assert!(ran.refused(says), "{}", ran.notes);
    for line in [format!("board record --port {} --seconds 0.3", board.port), "board record --port nowhere".to_owned()]
    {
        let ran = folder.run(&format!("{line} -o me.csv --overwrite"));
        assert_eq!(ran.code, Some(1), "{line}: {}", ran.notes);
        let kept = ["me.csv", "me.csv.partial"].map(|name| folder.text(name));
        assert_eq!(kept, [ROWS, ROWS], "{line}");
    }
}

/// Another command's rows, the zeros that a crash of the machine leaves, and a header that was cut.
#[test]
fn a_record_is_not_finished_with_rows_that_no_record_writes() {
    let no_stroke = "me.csv.partial is no recorded stroke, which has t_s,x_mm,y_mm (";
    for (text, says) in [
        ("time_s,speed_mm_s,voltage_v_rms\n0,1,2\n".to_owned(), "the header has no column t_s"),
        (format!("{ROWS}\0\0\0\n0.020000,2.0000,2.0000\n"), "row 4: expected 3 cells as in the header, found 1"),
        (format!("{ROWS}0.015000,nan,2.0000\n"), "row 4, column x_mm: expected a number, found \"nan\""),
        ("t_s,x_mm,y_".to_owned(), "there is no me.csv.partial with rows of a recording that was cut off"),
    ] {
        let folder = Folder::new();
        folder.write("me.csv.partial", &text);
        let before = folder.names();
        let ran = folder.run("board record --finish -o me.csv");
        assert!(ran.refused(says) && (ran.refused(no_stroke) || !text.ends_with('\n')), "{text:?}: {}", ran.notes);
        assert_eq!((folder.names(), folder.text("me.csv.partial")), (before, text));
    }
}

/// What a board reported is joined with forces that come later; those of something else cost nothing.
#[test]
fn a_calibration_that_was_cut_off_keeps_its_rows_until_its_forces_fit() {
    let folder = Folder::new();
    let rows = "time_s,voltage_v_rms,speed_mm_s\n0.000,0.0,0.0\n0.001,0.0,0.0\n";
    folder.write("me.csv.partial", rows);
    folder.write("forces.csv", "time_s,normal_force_n,friction_n\n0,0.5,0.2\n1,0.5,0.2\n");
    for finish in ["", " --finish"] {
        let ran = folder.run(&format!("finger calibrate --strokes 9 -o me.csv --forces forces.csv{finish}"));
        assert!(ran.code == Some(1) && ran.notes.contains("me.csv.partial"), "{}", ran.notes);
        assert_eq!(folder.text("me.csv.partial"), rows);
    }
}

#[test]
fn a_play_replaces_what_a_finger_did_on_a_board_only_with_overwrite() {
    let folder = Folder::new();
    assert_eq!(folder.run("play scene.toml --seconds 0.1").code, Some(0));
    assert_eq!(folder.run("play scene.toml --seconds 0.1").code, Some(0), "a simulation is replaced");
    let summary = folder.text("frixel-out/summary.json");
    folder.write("frixel-out/summary.json", &summary.replace("\"simulated\":true", "\"simulated\":false"));
    let says = "frixel-out has what a finger did on a board, which no other play replaces: give another folder to --out, \
                or add --overwrite";
    assert!(folder.run("play scene.toml --seconds 0.2").refused(says));
    folder.write("mine.json", &folder.text("frixel-out/summary.json"));
    assert!(folder.run("model eval --input points.csv --output mine.json").refused("is a recording of a person"));
    assert_eq!(folder.run("play scene.toml --seconds 0.2 --overwrite").code, Some(0));
}
