//! Playing to the port of a virtual board.

use std::fs;
use std::path::Path;

use tempfile::TempDir;

use super::{frixel, scene, succeed};
use crate::processes::VirtualBoard;

/// The longest host timeout that there is: on a busy machine pings are late.
pub(crate) fn write_patient_scene(path: &Path) {
    let text = fs::read_to_string(scene("keyboard.toml")).unwrap();
    assert!(!text.contains("[drive]"));
    fs::write(path, text.replacen("[[layer]]", "[drive]\nhost_timeout_ms = 1000\n\n[[layer]]", 1)).unwrap();
}

/// Most tries of what fails when the machine lets a client or the board wait for longer than an answer may take.
pub(crate) const TRIES_MAX: u32 = 20;

/// Whether a command ended because the machine let it or the board wait for too long.
pub(crate) fn was_too_late(notes: &str) -> bool {
    let too_late = ["was not answered by the board", "had not heard from this host", "no frixel board answered"];
    too_late.iter().any(|part| notes.contains(part))
}

/// As [`succeed`], with as many tries as a busy machine needs.
fn succeed_in_time(folder: &Path, arguments: &[&str]) -> (String, String) {
    for _ in 0..TRIES_MAX {
        let output = frixel(folder, arguments);
        let notes = String::from_utf8(output.stderr).unwrap();
        if output.status.success() {
            return (String::from_utf8(output.stdout).unwrap(), notes);
        }
        assert!(was_too_late(&notes), "{arguments:?}: {notes}");
    }
    panic!("{arguments:?}: {TRIES_MAX} tries were too late");
}

fn felt(folder: &Path) -> (usize, usize) {
    let text = fs::read_to_string(folder.join("frixel-out/felt.csv")).unwrap();
    let felt = |line: &&str| !line.split(',').nth(6).unwrap().is_empty();
    (text.lines().count() - 1, text.lines().skip(1).filter(felt).count())
}

#[test]
fn a_play_to_a_port_draws_what_the_board_commanded_and_joins_what_was_felt() {
    let folder = TempDir::new().unwrap();
    write_patient_scene(&folder.path().join("scene.toml"));
    let board = VirtualBoard::start(folder.path(), &[]);
    let play = ["play", "scene.toml", "--port", &board.port, "--seconds", "2"];
    let (said, notes) = succeed_in_time(folder.path(), &play);
    assert!(said.contains("commanded.svg") && said.contains("scene.png"), "{said}");
    assert!(!notes.contains("left"), "no progress bar off a terminal: {notes}");
    let svg = fs::read_to_string(folder.path().join("frixel-out/commanded.svg")).unwrap();
    let has = |text: &str| svg.lines().any(|line| line == text);
    assert!(has("commanded") && has("scene.toml, simulated") && has("path, mm") && !has("felt"));
    assert!(fs::metadata(folder.path().join("frixel-out/scene.png")).unwrap().len() > 10_000);
    let (rows, felt_rows) = felt(folder.path());
    assert!(rows > 500 && felt_rows == 0, "{rows} rows, {felt_rows} felt");

    let (said, _) = succeed_in_time(folder.path(), &[&play[..], &["--with-log", "board/felt.csv"]].concat());
    assert!(said.contains("felt.svg") && !said.contains("commanded.svg"), "{said}");
    let (rows, felt_rows) = felt(folder.path());
    assert!(rows > 500 && felt_rows > rows / 2, "{rows} rows, {felt_rows} felt");
    // A log of something else.
    fs::write(folder.path().join("old.csv"), "t_s,x_mm,y_mm,speed_mm_s,felt_n\n0.001,,,,\n").unwrap();
    let said = loop {
        let output = frixel(folder.path(), &[&play[..], &["--with-log", "old.csv"]].concat());
        assert!(!output.status.success());
        let said = String::from_utf8(output.stderr).unwrap();
        if !said.contains("was not answered by the board") {
            break said;
        }
    };
    assert!(said.contains("whose port this is"), "{said}");
}

#[test]
fn a_finger_on_a_board_is_recorded_as_a_stroke() {
    let folder = TempDir::new().unwrap();
    let stroke = ["--from", "10,20", "--to", "90,20", "--speed", "80"];
    let board = VirtualBoard::start(folder.path(), &stroke);
    let record = ["board", "record", "--port", &board.port, "-o", "mine.csv", "--overwrite", "--seconds", "3"];
    let (said, _) = succeed_in_time(folder.path(), &record);
    assert!(said.contains("mine.csv"), "{said}");
    drop(board);
    let text = fs::read_to_string(folder.path().join("mine.csv")).unwrap();
    assert!(text.starts_with("t_s,x_mm,y_mm\n0.000000,"), "{text}");
    // One second of stroke, 0.2 s of pause, over and over: there are rows of both.
    assert!(text.lines().any(|line| line.ends_with(",,")), "the finger is lifted");
    let y_mm = |line: &str| line.rsplit(',').next().unwrap().parse::<f64>();
    let near = text.lines().skip(1).filter_map(|line| y_mm(line).ok()).all(|y_mm| (y_mm - 20.0).abs() < 2.0);
    assert!(near && text.lines().count() > 300, "{text}");
    let (said, _) = succeed(folder.path(), &["play", &scene("brick.toml"), "--stroke", "mine.csv"]);
    assert!(said.contains("friction error"), "{said}");
}

#[test]
fn faults_and_the_selftest_describe_a_board() {
    let folder = TempDir::new().unwrap();
    let board = VirtualBoard::start(folder.path(), &[]);
    let (said, _) = succeed_in_time(folder.path(), &["board", "faults", "--port", &board.port]);
    assert!(said.contains("none since power-on") && said.contains("last reset"), "{said}");
    let output = loop {
        let output = frixel(folder.path(), &["board", "selftest", "--port", &board.port]);
        // On a busy machine an answer may be too late.
        if !output.stdout.is_empty() {
            break output;
        }
    };
    let said = String::from_utf8(output.stdout).unwrap();
    for name in ["no fault", "round trip", "clock", "telemetry", "output zero", "tick time", "clean line"] {
        assert!(said.lines().any(|line| line.starts_with(name)), "{name}: {said}");
    }
    // Round trips and clock depend on the load of the machine.
    for name in ["no fault", "output zero", "tick time"] {
        assert!(said.lines().any(|line| line.starts_with(name) && line.contains(" ok ")), "{name}: {said}");
    }
    let failed = said.contains("FAILED");
    assert_eq!(output.status.code(), Some(i32::from(failed)), "{said}");
}
