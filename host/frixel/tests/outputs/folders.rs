//! A folder has one writer.

use std::fs;
use std::io::{BufRead, BufReader};
use std::process::{Child, Stdio};
use std::thread::sleep;
use std::time::Duration;

use super::Folder;

/// `frixel sim`, until it is dropped.
pub(crate) struct VirtualBoard {
    process: Child,
    pub(crate) port: String,
}

impl VirtualBoard {
    pub(crate) fn start(folder: &Folder, line: &str) -> Self {
        let mut process = folder.command(line).stderr(Stdio::null()).spawn().unwrap();
        let mut port = String::new();
        BufReader::new(process.stdout.take().unwrap()).read_line(&mut port).unwrap();
        let port = port.trim().strip_prefix("port: ").unwrap().to_owned();
        Self { process, port }
    }
}

impl Drop for VirtualBoard {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

/// A minute of naps: whatever is waited for longer has hung.
pub(crate) fn until(what: &str, mut done: impl FnMut() -> bool) {
    for _ in 0..12_000 {
        if done() {
            return;
        }
        sleep(Duration::from_millis(5));
    }
    panic!("hung: {what}");
}

#[test]
fn a_virtual_board_and_a_play_do_not_write_one_felt_csv() {
    let folder = Folder::new();
    let board = VirtualBoard::start(&folder, "sim --out out");
    for line in [
        format!("play scene.toml --seconds 1 --out out --port {}", board.port),
        "play scene.toml --seconds 0.1 --out ./out".to_owned(),
        "demo --out out".to_owned(),
        "score scene.toml --strokes 1 --seeds 1 --seconds 0.2 --out out".to_owned(),
        "sim --out out".to_owned(),
    ] {
        let ran = folder.run(&line);
        let says = "out: wait for it, or give another folder to --out";
        assert!(ran.code == Some(1) && ran.notes.contains(says), "{line}: {}", ran.notes);
        assert!(ran.notes.contains("another frixel writes into "), "{line}: {}", ran.notes);
    }
    let rows = folder.text("out/felt.csv");
    assert_eq!(rows.lines().filter(|row| row.starts_with("t_s,")).count(), 1, "one log");
    drop(board);
    // A process that was killed holds no folder.
    let ran = folder.run("play scene.toml --seconds 0.1 --out out");
    assert_eq!(ran.code, Some(0), "{}", ran.notes);
    assert!(folder.names().iter().all(|name| !name.contains("frixel-")), "{:?}", folder.names());
}

#[test]
fn a_virtual_board_and_a_play_have_folders_of_their_own() {
    let folder = Folder::new();
    let board = VirtualBoard::start(&folder, "sim");
    assert_eq!(folder.run("play scene.toml --seconds 0.1").code, Some(0));
    until("a row of the board", || folder.text("frixel-sim/felt.csv").lines().count() > 2);
    assert!(fs::metadata(folder.path("frixel-out/felt.csv")).is_ok());
    drop(board);
}

/// The files of a play to a port have another picture than those of a play on the simulator.
#[test]
fn no_picture_of_an_earlier_play_is_left() {
    let folder = Folder::new();
    folder.write("frixel-out/commanded.svg", "of an earlier play");
    assert_eq!(folder.run("play scene.toml --seconds 0.1").code, Some(0));
    let names = folder.names().into_iter().filter(|name| name.starts_with("frixel-out"));
    let expected = ["felt.csv", "felt.svg", "scene.png", "summary.json"].map(|name| format!("frixel-out/{name}"));
    assert_eq!(names.collect::<Vec<_>>(), expected);
}
