//! `frixel sim` and `frixel play` as two processes on a pseudo-terminal, and what happens when the board is killed.
//!
//! Times are the simulator's own, from the log that it keeps; nothing here is measured by the wall clock.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Output, Stdio};

use tempfile::TempDir;

use crate::processes::{bundled, frixel};
use crate::{VirtualBoard, rows_so_far, until};

/// The brick in a folder, with the longest host timeout that there is: on a busy machine pings are late.
fn scene(folder: &Path) -> PathBuf {
    let brick = fs::read_to_string(bundled("brick.toml")).unwrap();
    let path = folder.join("brick.toml");
    let picture = bundled("textures/brick.png").display().to_string();
    let timeout = "[drive]\nhost_timeout_ms = 1000\n";
    fs::write(&path, brick.replace("textures/brick.png", &picture).replace("[drive]\n", timeout)).unwrap();
    path
}

/// Ends a process as a person would.
fn interrupt(process: Child) -> Output {
    let pid = rustix::process::Pid::from_raw(process.id() as i32).unwrap();
    rustix::process::kill_process(pid, rustix::process::Signal::INT).unwrap();
    process.wait_with_output().unwrap()
}

/// A virtual board, and what clients play on it.
struct Board {
    board: VirtualBoard,
    folder: TempDir,
    scene: PathBuf,
}

impl Board {
    fn start() -> Self {
        let folder = TempDir::new().unwrap();
        let board = VirtualBoard::start(folder.path(), &[]);
        let scene = scene(folder.path());
        Self { board, folder, scene }
    }

    /// Ends it as a person would, and reads what it wrote.
    fn interrupt(mut self) -> Log {
        assert!(self.board.process.interrupt());
        Log::read(&self.folder.path().join("board"))
    }

    fn play(&self, seconds: &str, folder: &Path) -> Child {
        let mut command = frixel();
        command.arg("play").arg(&self.scene).args(["--port", &self.board.port, "--seconds", seconds]);
        command.args(["--json", "--out"]).arg(folder).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
    }
}

struct Event {
    t_s: f64,
    name: String,
}

struct Log {
    events: Vec<Event>,
    /// Time, rms voltage and DAC code of every row.
    rows: Vec<(f64, f64, i32)>,
}

impl Log {
    fn read(folder: &Path) -> Self {
        let rows = fs::read_to_string(folder.join("felt.csv")).unwrap();
        let rows = rows.lines().skip(1).map(|line| {
            let cells: Vec<&str> = line.split(',').collect();
            (cells[0].parse().unwrap(), cells[7].parse().unwrap(), cells[8].parse().unwrap())
        });
        Self { rows: rows.collect(), events: read_events(&fs::read_to_string(folder.join("events.csv")).unwrap()) }
    }

    fn drives_between(&self, from_s: f64, to_s: f64) -> bool {
        self.rows.iter().any(|(t_s, v_rms, code)| *t_s >= from_s && *t_s < to_s && (*v_rms > 0.0 || *code != 0))
    }
}

/// The cells of each row of a felt.csv.
fn felt_cells(folder: &Path) -> Vec<Vec<String>> {
    let text = fs::read_to_string(folder.join("felt.csv")).unwrap();
    text.lines().skip(1).map(|line| line.split(',').map(str::to_owned).collect()).collect()
}

/// Rows of a felt.csv so far; none before it is there.
fn rows_in(folder: &Path) -> usize {
    rows_so_far(folder).lines().count().saturating_sub(1)
}

/// What happened to the board. How often it dropped time depends on how busy the machine is.
fn read_events(text: &str) -> Vec<Event> {
    text.lines()
        .skip(1)
        .filter(|line| !line.contains(",time-dropped,"))
        .map(|line| {
            let cells: Vec<&str> = line.split(',').collect();
            Event { t_s: cells[0].parse().unwrap(), name: cells[1].into() }
        })
        .collect()
}

/// What holds however busy the machine is: the scene arrives whole, and the board plays it until the client stops it.
/// How many frames had to be sent again depends on the machine.
#[test]
fn a_scene_plays_through_a_real_serial_port() {
    let board = Board::start();
    let folder = TempDir::new().unwrap();
    let process = board.play("600", folder.path());
    until("half a second of rows is written", || rows_in(folder.path()) > 500);
    let played = interrupt(process);
    assert!(played.status.success(), "{}", String::from_utf8_lossy(&played.stderr));
    let json = String::from_utf8(played.stdout).unwrap();
    for part in
        [r#""rig":"board""#, r#""friction_error_rms_n":null"#, r#""payload_bytes":62612"#, r#""saturated_ticks":null"#]
    {
        assert!(json.contains(part), "{part} is not in {json}");
    }
    let rows = felt_cells(folder.path());
    assert!(rows.iter().all(|row| row[6].is_empty()), "a board does not know what is felt");
    assert!(rows.iter().any(|row| row[7].parse::<f64>().unwrap() > 50.0), "it does know its voltage");

    let log = board.interrupt();
    let names: Vec<&str> = log.events.iter().map(|event| event.name.as_str()).collect();
    assert_eq!(names, ["armed", "active", "armed", "disarmed"]);
    let (active_s, stopped_s) = (log.events[1].t_s, log.events[2].t_s);
    assert!(log.drives_between(active_s, stopped_s));
    assert!(!log.drives_between(0.0, active_s));
    assert!(!log.drives_between(stopped_s + 1e-3, f64::INFINITY));
}

#[test]
fn a_board_that_vanishes_is_said_in_a_sentence() {
    let mut board = Board::start();
    let folder = TempDir::new().unwrap();
    let process = board.play("600", folder.path());
    until("rows are written", || rows_in(folder.path()) > 0);
    board.board.process.0.kill().unwrap();
    board.board.process.0.wait().unwrap();
    let ended = process.wait_with_output().unwrap();
    assert_eq!(ended.status.code(), Some(1));
    let said = String::from_utf8(ended.stderr).unwrap();
    let sentence = said.lines().last().unwrap();
    assert!(sentence.starts_with("frixel: ") && sentence.contains(&board.board.port), "{said}");
    assert!(sentence.contains("vanished"), "{said}");
    let json: serde_json::Value = serde_json::from_slice(&ended.stdout).unwrap();
    let ticks = json["ticks"].as_u64().unwrap();
    assert!(ticks > 0, "the summary is of what was played");
    let felt = fs::read_to_string(folder.path().join("felt.csv")).unwrap();
    let last: f64 = felt.lines().last().unwrap().split(',').next().unwrap().parse().unwrap();
    assert!((last * 40_000.0 - ticks as f64).abs() < 1.0, "the rows end at {last} s, {ticks} ticks were reported");
}

#[test]
fn a_folder_that_cannot_be_written_is_said_before_the_board_plays() {
    let board = Board::start();
    let file = tempfile::NamedTempFile::new().unwrap();
    let refused = board.play("600", &file.path().join("out")).wait_with_output().unwrap();
    assert_eq!(refused.status.code(), Some(1));
    let said = String::from_utf8(refused.stderr).unwrap();
    assert!(said.lines().last().unwrap().contains("cannot be written"), "{said}");
    assert!(board.interrupt().events.is_empty(), "the board was armed");
}
