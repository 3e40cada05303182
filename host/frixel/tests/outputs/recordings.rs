//! Recordings of people: a stroke, and friction under a drive.

use std::fs;
use std::process::Stdio;
use std::thread::sleep;
use std::time::Duration;

use frixel_lab::recording::Recording;

use super::folders::{VirtualBoard, until};
use super::{Folder, Ran};

/// A finger that never comes down within a test.
const NO_FINGER: &str = "t_s,x_mm,y_mm\n0,,\n10000,10,20\n10001,20,20\n";
/// Strokes at a speed at which friction follows the drive.
const STROKES: &str = "sim --out board --from 25,40 --to 95,40 --speed 44 --minimum-jerk";
/// Most tries of what fails when the machine lets a client or the board wait for longer than an answer may take.
const TRIES_MAX: u32 = 20;

fn was_too_late(notes: &str) -> bool {
    let too_late = ["was not answered by the board", "had not heard from this host", "no frixel board answered"];
    too_late.iter().any(|part| notes.contains(part))
}

/// Runs a command until the machine lets it be in time.
fn run_in_time(folder: &Folder, line: &str) -> Ran {
    for _ in 0..TRIES_MAX {
        let ran = folder.run(line);
        if !was_too_late(&ran.notes) {
            return ran;
        }
    }
    panic!("{line}: {TRIES_MAX} tries were too late");
}

/// Starts a command and kills it once `partial` has so many lines. Its standard input stays open.
fn kill_at(folder: &Folder, line: &str, partial: &str, lines: usize) {
    for _ in 0..TRIES_MAX {
        let mut command = folder.command(&format!("{line} --overwrite"));
        let mut child = command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
        let _open = child.stdin.take();
        let mut ended = false;
        let count = || folder.read(partial).map_or(0, |bytes| String::from_utf8_lossy(&bytes).lines().count());
        until(partial, || {
            ended = child.try_wait().unwrap().is_some();
            ended || count() >= lines
        });
        let _ = child.kill();
        let _ = child.wait();
        if !ended {
            return;
        }
    }
    panic!("{line}: {TRIES_MAX} tries were too late");
}

#[test]
fn record_without_a_finger_keeps_the_earlier_recording() {
    let folder = Folder::new();
    folder.write("none.csv", NO_FINGER);
    let earlier = "t_s,x_mm,y_mm\n0.000000,1.0000,2.0000\n";
    folder.write("me.csv", earlier);
    let board = VirtualBoard::start(&folder, "sim --out board --stroke none.csv");
    let line = format!("record --port {} -o me.csv --seconds 0.3", board.port);
    let before = folder.names();
    let ran = folder.run(&line);
    let says = "me.csv is there already, and a recording is not replaced: give another name to -o, or add --overwrite";
    assert!(ran.code == Some(1) && ran.notes.contains(says), "{}", ran.notes);
    let ran = run_in_time(&folder, &format!("{line} --overwrite"));
    assert!(ran.code == Some(1) && ran.notes.contains("nothing is recorded"), "{}", ran.notes);
    assert_eq!(folder.text("me.csv"), earlier);
    assert_eq!(folder.names(), before);
}

#[test]
fn no_recording_is_replaced_without_overwrite() {
    let folder = Folder::new();
    let board = VirtualBoard::start(&folder, "sim --out board --from 10,20 --to 90,20");
    for line in
        [format!("record --port {} --seconds 0.5 -o mine", board.port), "calibrate --strokes 9 -o mine".to_owned()]
    {
        folder.write("mine", "mine");
        let ran = folder.run(&line);
        let says = "mine is there already, and a recording is not replaced";
        assert!(ran.code == Some(1) && ran.notes.contains(says), "{line}: {}", ran.notes);
        assert_eq!(folder.text("mine"), "mine");
        let ran = run_in_time(&folder, &format!("{line} --overwrite"));
        assert_eq!(ran.code, Some(0), "{line}: {}", ran.notes);
        assert!(folder.text("mine").lines().count() > 3, "{line}");
        assert!(folder.read("mine.partial").is_none(), "{line}");
    }
}

#[test]
fn a_killed_record_leaves_its_rows_which_the_next_one_names_and_finishes() {
    let folder = Folder::new();
    let board = VirtualBoard::start(&folder, "sim --out board --from 10,20 --to 90,20");
    let line = format!("record --port {} -o me.csv", board.port);
    kill_at(&folder, &line, "me.csv.partial", 100);
    assert!(folder.read("me.csv").is_none());
    let rows = folder.text("me.csv.partial");
    assert!(rows.ends_with('\n') && rows.lines().all(|row| row.split(',').count() == 3), "whole rows");

    let ran = folder.run(&format!("{line} --seconds 0.3"));
    let says = "me.csv.partial has the rows of a recording that was cut off: add --finish to keep them, or record anew \
                with --overwrite";
    assert!(ran.code == Some(1) && ran.notes.contains(says), "{}", ran.notes);
    assert_eq!(folder.text("me.csv.partial"), rows);
    drop(board);
    // A part of a row, as a process that was killed may leave one.
    folder.write("me.csv.partial", &(rows.clone() + "9.1234"));
    let ran = folder.run("record --finish -o me.csv");
    assert!(ran.code == Some(0) && ran.said.contains("s of touch"), "{}{}", ran.said, ran.notes);
    assert_eq!(folder.text("me.csv"), rows);
    assert!(folder.read("me.csv.partial").is_none());
    let ran = folder.run("record --finish -o other.csv");
    assert!(ran.code == Some(1) && ran.notes.contains("leave --finish out"), "{}", ran.notes);
}

/// The rows are CSV until the recording is whole, so that what was cut off is kept in the same way.
#[test]
fn a_recorded_stroke_is_parquet_by_its_name_also_after_a_kill() {
    let folder = Folder::new();
    let board = VirtualBoard::start(&folder, "sim --out board --from 10,20 --to 90,20");
    let line = format!("record --port {} -o me.parquet --participant P07", board.port);
    let ran = run_in_time(&folder, &format!("{line} --seconds 0.5"));
    assert!(ran.code == Some(0) && ran.said.contains("me.parquet, 0."), "{}{}", ran.said, ran.notes);
    assert!(folder.read("me.parquet.partial").is_none());
    let read = || Recording::read_parquet(folder.read("me.parquet").unwrap()).unwrap();
    let metadata = read().metadata;
    assert_eq!((metadata.rig.as_str(), metadata.is_simulated, metadata.tick_hz), ("board", true, 40_000));
    assert_eq!((metadata.participant.as_deref(), metadata.board.kind.as_str()), (Some("P07"), "simulator"));

    kill_at(&folder, &line, "me.parquet.partial", 100);
    let rows = folder.text("me.parquet.partial");
    drop(board);
    let ran = folder.run("record --finish --overwrite -o me.parquet");
    assert_eq!(ran.code, Some(0), "{}", ran.notes);
    assert_eq!(read().rows(), rows.lines().count() - 1);
    assert!(!read().metadata.is_simulated, "nobody says that it was simulated");
    assert_eq!(folder.run("play scene.toml --seconds 0.3 --stroke me.parquet").code, Some(0));
}

#[test]
fn a_recording_is_on_the_disk_up_to_the_last_second() {
    let folder = Folder::new();
    let board = VirtualBoard::start(&folder, "sim --out board --from 10,20 --to 90,20");
    let line = format!("record --port {} -o me.csv --seconds 3 --overwrite", board.port);
    let mut sizes = vec![0];
    for _ in 0..TRIES_MAX {
        sizes = vec![0];
        let mut child = folder.command(&line).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
        until("the end of the recording", || {
            let read = || folder.read("me.csv.partial").unwrap_or_default();
            let mut rows = read();
            if !rows.ends_with(b"\n") {
                // A reader may see a write where a page of the file ends in it; it is whole a moment later, and rows
                // that are written in parts are not, for 50 ms.
                sleep(Duration::from_millis(5));
                rows = read();
            }
            assert!(rows.is_empty() || rows.ends_with(b"\n"), "whole rows at every moment");
            let rows = String::from_utf8_lossy(&rows).lines().count();
            if rows > *sizes.last().unwrap() {
                sizes.push(rows);
            }
            child.try_wait().unwrap().is_some()
        });
        if *sizes.last().unwrap() > 400 {
            break;
        }
    }
    let mut steps: Vec<usize> = sizes.windows(2).map(|pair| pair[1] - pair[0]).collect();
    steps.sort_unstable();
    // There are 200 rows a second. A busy machine makes single steps larger, and not half of them.
    assert!(steps.len() > 3 && steps[steps.len() / 2] < 200, "{steps:?}");
}

#[test]
fn a_second_recorder_of_a_file_is_told_of_the_first() {
    let folder = Folder::new();
    let board = VirtualBoard::start(&folder, "sim --out board --from 10,20 --to 90,20");
    let line = format!("record --port {} -o me.csv", board.port);
    let mut first = folder.command(&line).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    until("the file", || folder.read("me.csv.partial").is_some());
    let second = folder.run("record --port nowhere -o me.csv --overwrite");
    assert!(
        second.code == Some(1) && second.notes.contains("me.csv is being written by another frixel"),
        "{}",
        second.notes
    );
    let _ = first.kill();
    let _ = first.wait();
}

/// A port that is mistyped costs no rows, even with leave to replace them.
#[test]
fn rows_that_may_be_replaced_stay_until_there_are_new_ones() {
    let folder = Folder::new();
    let rows = "t_s,x_mm,y_mm\n0.000000,1.0000,2.0000\n0.005000,1.1000,2.0000\n";
    for line in ["record --port nowhere", "calibrate --port nowhere --forces forces.csv"] {
        folder.write("cut.csv.partial", rows);
        let ran = folder.run(&format!("{line} -o cut.csv --overwrite"));
        assert_eq!(ran.code, Some(1), "{}", ran.notes);
        assert_eq!(folder.text("cut.csv.partial"), rows, "{line}: {}", ran.notes);
        fs::remove_file(folder.path("cut.csv.partial")).unwrap();
    }
}

/// A board that goes away in the middle of a recording: the message says where the rows are.
#[test]
fn a_recording_whose_board_goes_away_is_named() {
    let folder = Folder::new();
    let board = VirtualBoard::start(&folder, "sim --out board --from 10,20 --to 90,20");
    let line = format!("record --port {} -o me.csv --overwrite", board.port);
    let child = folder.command(&line).spawn().unwrap();
    until("rows", || folder.read("me.csv.partial").is_some_and(|bytes| bytes.len() > 2_000));
    drop(board);
    let output = child.wait_with_output().unwrap();
    let notes = String::from_utf8(output.stderr).unwrap();
    let says = "what was recorded until then is in me.csv.partial: add --finish to keep them";
    assert!(output.status.code() == Some(1) && notes.contains(says), "{notes}");
    assert!(folder.read("me.csv").is_none());
}

#[test]
fn a_killed_calibration_is_finished_with_its_forces() {
    let folder = Folder::new();
    let board = VirtualBoard::start(&folder, STROKES);
    let line = format!("calibrate --strokes 12 --port {} -o data.csv --forces", board.port);
    fs::remove_file(folder.path("data.csv")).unwrap();
    kill_at(&folder, &format!("{line} board/forces.csv"), "data.csv.partial", 12_000);
    let ran = folder.run(&format!("{line} board/forces.csv"));
    let says =
        "data.csv.partial has the rows of a recording that was cut off: add --finish, and the --forces of that run";
    assert!(ran.code == Some(1) && ran.notes.contains(says), "{}", ran.notes);
    let partial = folder.text("data.csv.partial");
    // The forces of something else: the rows stay.
    let ran = folder.run("calibrate --finish -o data.csv --forces forces.csv");
    assert!(ran.code == Some(1) && ran.notes.contains("data.csv.partial"), "{}", ran.notes);
    assert_eq!(folder.text("data.csv.partial"), partial);
    sleep(Duration::from_millis(300));
    let ran = folder.run("calibrate --finish -o data.csv --forces board/forces.csv");
    // A busy machine lets the two clocks drift apart.
    if ran.code != Some(0) && ran.notes.contains("clocks") {
        return;
    }
    assert_eq!(ran.code, Some(0), "{}", ran.notes);
    let strokes: std::collections::BTreeSet<String> =
        folder.text("data.csv").lines().skip(1).filter_map(|row| row.split(',').nth(1).map(str::to_owned)).collect();
    assert!(strokes.len() > 3, "{strokes:?}");
    assert!(folder.read("data.csv.partial").is_none());
}

/// What a person's finger did on a board is in the files of a play as well.
#[test]
fn a_play_does_not_replace_what_a_finger_did_on_a_board() {
    let folder = Folder::new();
    assert_eq!(folder.run("play scene.toml --seconds 0.1").code, Some(0));
    let summary = folder.text("frixel-out/summary.json");
    assert!(summary.contains("\"simulated\":true"), "{summary}");
    assert_eq!(folder.run("play scene.toml --seconds 0.1").code, Some(0), "a simulation is replaced");
    folder.write("frixel-out/summary.json", &summary.replace("\"simulated\":true", "\"simulated\":false"));
    let before = folder.read("frixel-out/felt.csv").unwrap();
    let ran = folder.run("play scene.toml --seconds 0.2");
    let says = "frixel-out has what a finger did on a board, which no other play replaces: give another folder to --out, \
                or add --overwrite";
    assert!(ran.code == Some(1) && ran.notes.contains(says), "{}", ran.notes);
    assert!(folder.read("frixel-out/felt.csv").unwrap() == before);
    assert_eq!(folder.run("play scene.toml --seconds 0.2 --overwrite").code, Some(0));
}

/// Another command's rows, and the zeros that a crash of the machine leaves in the place of rows.
#[test]
fn a_record_is_not_finished_with_rows_that_no_record_writes() {
    let whole = "t_s,x_mm,y_mm\n0.000000,1.0000,2.0000\n0.005000,1.5000,2.0000\n0.010000,,\n";
    for (text, found) in [
        ("time_s,speed_mm_s,voltage_v_rms\n0,1,2\n".to_owned(), "the header has no column t_s"),
        (format!("{whole}\0\0\0\0\0\0\n0.020000,2.0000,2.0000\n"), "row 5: expected 3 cells as in the header, found 1"),
        (format!("{whole}0.015000,nan,2.0000\n"), "row 5, column x_mm: expected a number, found \"nan\""),
        (format!("{whole}0.015000,2.0000\n"), "row 5: expected 3 cells as in the header, found 2"),
    ] {
        let folder = Folder::new();
        folder.write("me.csv.partial", &text);
        let before = folder.names();
        let ran = folder.run("record --finish -o me.csv");
        let says = format!("me.csv.partial is no recorded stroke, which has t_s,x_mm,y_mm ({found}");
        assert!(ran.code == Some(1) && ran.notes.contains(&says), "{text:?}: {}", ran.notes);
        assert_eq!(folder.names(), before, "{text:?}");
        assert_eq!(folder.text("me.csv.partial"), text);
    }
    let folder = Folder::new();
    folder.write("me.csv.partial", &format!("{whole}\0\0\0"));
    let ran = folder.run("record --finish -o me.csv");
    assert_eq!(ran.code, Some(0), "zeros in place of an unfinished row: {}", ran.notes);
    assert_eq!(folder.text("me.csv"), whole);
}

/// Spreadsheets save a table with a byte order mark.
#[test]
fn a_recording_that_a_spreadsheet_saved_is_a_recording() {
    let folder = Folder::new();
    let recording = "\u{feff}t_s,x_mm,y_mm\r\n0.0,1.0,2.0\r\n0.1,9.0,2.0\r\n";
    folder.write("me.csv", recording);
    let ran = folder.run("model eval --input points.csv --output me.csv");
    assert!(ran.code == Some(1) && ran.notes.contains("is a recording of a person"), "{}", ran.notes);
    assert_eq!(folder.text("me.csv"), recording);
    folder.write("scene.toml", "version = 2\n[[layer]]\nkind = \"constant\"\nfriction_fraction = 0.5\n");
    let ran = folder.run("play scene.toml --stroke me.csv");
    assert!(ran.code == Some(0) && !ran.notes.contains("ignored column"), "{}", ran.notes);
}
