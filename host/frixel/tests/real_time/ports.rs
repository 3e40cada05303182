//! Playing to the port of a virtual board.

use std::fs;
use std::path::Path;

use tempfile::TempDir;

use crate::VirtualBoard;
use crate::processes::{bundled, run, said, succeed};

/// Writes the keyboard with the longest host timeout that there is: on a busy machine pings are late.
fn write_patient_scene(path: &Path) {
    let text = fs::read_to_string(bundled("keyboard.toml")).unwrap();
    assert!(!text.contains("[drive]"));
    fs::write(path, text.replacen("[[layer]]", "[drive]\nhost_timeout_ms = 1000\n\n[[layer]]", 1)).unwrap();
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
    let output = run(folder.path(), &play);
    let (printed, notes) = (String::from_utf8_lossy(&output.stdout), said(&output));
    assert!(output.status.success() && !notes.contains("left"), "no progress bar off a terminal: {notes}");
    assert!(printed.contains("commanded.svg") && printed.contains("scene.png"), "{printed}");
    let svg = fs::read_to_string(folder.path().join("frixel-out/commanded.svg")).unwrap();
    let has = |text: &str| svg.lines().any(|line| line == text);
    assert!(has("commanded") && has("scene.toml, simulated") && has("path, mm") && !has("felt"));
    assert!(fs::metadata(folder.path().join("frixel-out/scene.png")).unwrap().len() > 10_000);
    let (rows, felt_rows) = felt(folder.path());
    assert!(rows > 500 && felt_rows == 0, "{rows} rows, {felt_rows} felt");

    let printed = succeed(folder.path(), &[&play[..], &["--with-log", "board/felt.csv"]].concat());
    assert!(printed.contains("felt.svg") && !printed.contains("commanded.svg"), "{printed}");
    let (rows, felt_rows) = felt(folder.path());
    assert!(rows > 500 && felt_rows > rows / 2, "{rows} rows, {felt_rows} felt");
    // A log of something else.
    fs::write(folder.path().join("old.csv"), "t_s,x_mm,y_mm,speed_mm_s,felt_n\n0.001,,,,\n").unwrap();
    let refused = run(folder.path(), &[&play[..], &["--with-log", "old.csv"]].concat());
    assert!(!refused.status.success() && said(&refused).contains("that has this port"), "{}", said(&refused));
}

#[test]
fn a_finger_on_a_board_is_recorded_as_a_stroke() {
    let folder = TempDir::new().unwrap();
    let stroke = ["--from", "10,20", "--to", "90,20", "--speed", "80"];
    let board = VirtualBoard::start(folder.path(), &stroke);
    let record = ["board", "record", "--port", &board.port, "-o", "mine.csv", "--overwrite", "--seconds", "3"];
    let printed = succeed(folder.path(), &record);
    assert!(printed.contains("mine.csv"), "{printed}");
    drop(board);
    let text = fs::read_to_string(folder.path().join("mine.csv")).unwrap();
    assert!(text.starts_with("t_s,x_mm,y_mm\n0.000000,"), "{text}");
    // One second of stroke, 0.2 s of pause, over and over: there are rows of both.
    assert!(text.lines().any(|line| line.ends_with(",,")), "the finger is lifted");
    let y_mm = |line: &str| line.rsplit(',').next().unwrap().parse::<f64>();
    let near = text.lines().skip(1).filter_map(|line| y_mm(line).ok()).all(|y_mm| (y_mm - 20.0).abs() < 2.0);
    assert!(near && text.lines().count() > 300, "{text}");
    let brick = bundled("brick.toml").display().to_string();
    let printed = succeed(folder.path(), &["play", &brick, "--stroke", "mine.csv"]);
    assert!(printed.contains("friction error"), "{printed}");
}

#[test]
fn faults_and_the_selftest_describe_a_board() {
    let folder = TempDir::new().unwrap();
    let board = VirtualBoard::start(folder.path(), &[]);
    let printed = succeed(folder.path(), &["board", "faults", "--port", &board.port]);
    assert!(printed.contains("none since power-on") && printed.contains("last reset"), "{printed}");
    let output = run(folder.path(), &["board", "selftest", "--port", &board.port]);
    let printed = String::from_utf8_lossy(&output.stdout);
    for name in ["no fault", "round trip", "clock", "telemetry", "output zero", "tick time", "clean line"] {
        assert!(printed.lines().any(|line| line.starts_with(name)), "{name}: {printed}");
    }
    // Round trips and clock depend on the load of the machine.
    for (name, verdict) in [("no fault", " ok "), ("output zero", " ok "), ("tick time", " -  ")] {
        assert!(printed.lines().any(|line| line.starts_with(name) && line.contains(verdict)), "{name}: {printed}");
    }
    let failed = printed.contains("FAILED");
    assert_eq!(output.status.code(), Some(i32::from(failed)), "{printed}");
}
