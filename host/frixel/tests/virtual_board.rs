//! `frixel sim` and `frixel play` as two processes on a pseudo-terminal, and what happens when one of them is killed.
//!
//! Times are the simulator's own, from the log that it keeps; nothing here is measured by the wall clock.
#![cfg(unix)]
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail")]

use std::fs;
use std::io::{BufRead, BufReader, Read, Write};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread::sleep;
use std::time::Duration;

use frixel::scene_file;
use frixel_driver::{DEFAULT_BAUD, Device, DeviceError, SerialLink};
use frixel_scene::compile;
use frixel_testkit::Random;
use hound::{SampleFormat, WavSpec, WavWriter};
use serialport::{SerialPort, TTYPort};
use tempfile::TempDir;

use crate::processes::{frixel, rows_so_far, said, until};

/// Host timeout of the scene here, s: the longest that there is, for on a busy machine pings are late.
const HOST_TIMEOUT_S: f64 = 1.0;

/// Host timeout where clients are killed, s: for so long each of them keeps the next one waiting.
const SHORT_HOST_TIMEOUT_S: f64 = 0.5;

/// The brick with this host timeout, in a folder.
fn scene(folder: &Path, host_timeout_s: f64) -> PathBuf {
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let brick = fs::read_to_string(scenes.join("brick.toml")).unwrap();
    let path = folder.join("brick.toml");
    let picture = scenes.join("textures/brick.png").display().to_string();
    let timeout = format!("[drive]\nhost_timeout_ms = {}\n", 1e3 * host_timeout_s);
    fs::write(&path, brick.replace("textures/brick.png", &picture).replace("[drive]\n", &timeout)).unwrap();
    path
}

/// Clients that are killed.
const KILLS: usize = 20;
/// Of which the first die while the picture goes over the line.
const UPLOADS_KILLED: usize = 6;

/// One test at a time: on a busy machine a pseudo-terminal may hold bytes back for longer than a client waits.
static TURN: Mutex<()> = Mutex::new(());

fn turn() -> MutexGuard<'static, ()> {
    TURN.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A client in a process of its own.
fn client(scene: &Path, port: &str, seconds: &str, folder: &Path) -> Child {
    play_command(scene, port, seconds, folder).spawn().unwrap()
}

fn play_command(scene: &Path, port: &str, seconds: &str, folder: &Path) -> Command {
    let mut command = frixel();
    command.arg("play").arg(scene).args(["--port", port, "--seconds", seconds, "--json", "--out"]).arg(folder);
    command.stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

/// Most tries of what fails when the machine lets a client or the board wait for longer than an answer may take.
const TRIES_MAX: u32 = 20;

fn tries(what: &str, mut done: impl FnMut() -> bool) {
    assert!((0..TRIES_MAX).any(|_| done()), "{what}: {TRIES_MAX} tries were too late");
}

/// Whether a client has ended because an answer took too long. A client may try again then; anything else is a failure.
fn was_too_late(output: &Output) -> bool {
    let too_late = ["was not answered by the board", "had not heard from this host"];
    output.status.code() == Some(1) && too_late.iter().any(|part| said(output).contains(part))
}

/// Ends a process as a person would.
fn interrupt(process: Child) -> Output {
    let pid = rustix::process::Pid::from_raw(process.id() as i32).unwrap();
    rustix::process::kill_process(pid, rustix::process::Signal::INT).unwrap();
    process.wait_with_output().unwrap()
}

/// A virtual board in a process of its own.
struct VirtualBoard {
    process: Child,
    port: String,
    folder: TempDir,
    /// What clients play.
    scene: PathBuf,
}

impl VirtualBoard {
    fn start() -> Self {
        Self::start_with(HOST_TIMEOUT_S)
    }

    /// One whose clients play with this host timeout.
    fn start_with(host_timeout_s: f64) -> Self {
        let folder = TempDir::new().unwrap();
        let mut process = frixel().args(["sim", "--out"]).arg(folder.path()).stdout(Stdio::piped()).spawn().unwrap();
        let mut line = String::new();
        BufReader::new(process.stdout.take().unwrap()).read_line(&mut line).unwrap();
        let port = line.trim().strip_prefix("port: ").unwrap().to_owned();
        let scene = scene(folder.path(), host_timeout_s);
        Self { process, port, folder, scene }
    }

    /// Ends it as a person would, and reads what it wrote.
    fn interrupt(mut self) -> Log {
        let pid = rustix::process::Pid::from_raw(self.process.id() as i32).unwrap();
        rustix::process::kill_process(pid, rustix::process::Signal::INT).unwrap();
        assert!(self.process.wait().unwrap().success());
        Log::read(self.folder.path())
    }

    /// The events so far, without one that is half written; none before the log is there.
    fn events(&self) -> Vec<Event> {
        let text = fs::read_to_string(self.folder.path().join("events.csv")).unwrap_or_default();
        text.rsplit_once('\n').map_or(Vec::new(), |(lines, _)| read_events(lines))
    }

    fn is_disarmed(&self) -> bool {
        self.events().iter().rfind(|event| event.name != "host-silent").is_none_or(|event| event.name == "disarmed")
    }

    fn play(&self, seconds: &str, folder: &Path) -> Output {
        client(&self.scene, &self.port, seconds, folder).wait_with_output().unwrap()
    }

    /// Plays to the end, with as many tries as a busy machine needs.
    fn play_to_the_end(&self, seconds: &str, folder: &Path) {
        tries("a client plays to the end", || {
            let output = self.play(seconds, folder);
            assert!(output.status.success() || was_too_late(&output), "{}", said(&output));
            output.status.success()
        });
    }

    /// Starts a client and kills it when it has sent so many bytes. Returns whether it lived so long.
    fn kill_client_after(&self, count: usize, folder: &Path) -> bool {
        let mut tap = Tap::new(self);
        let mut process = client(&self.scene, &tap.path, "600", folder);
        tap.pass(&mut process, count);
        let is_running = process.try_wait().unwrap().is_none();
        if is_running {
            process.kill().unwrap();
        }
        let output = process.wait_with_output().unwrap();
        assert!(is_running || was_too_late(&output), "turned away after {count} bytes: {}", said(&output));
        until("the board lets go of a client that is gone", || self.is_disarmed());
        is_running
    }
}

impl Drop for VirtualBoard {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

struct Event {
    t_s: f64,
    name: String,
    last_frame_t_s: f64,
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

    /// When the board next played after a time.
    fn next_active_s(&self, after_s: f64) -> f64 {
        let next = self.events.iter().find(|event| event.name == "active" && event.t_s > after_s);
        next.map_or(f64::INFINITY, |event| event.t_s)
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
            Event { t_s: cells[0].parse().unwrap(), name: cells[1].into(), last_frame_t_s: cells[2].parse().unwrap() }
        })
        .collect()
}

/// What holds however busy the machine is: the scene arrives whole, and the board plays it until the client stops it.
/// How many frames had to be sent again depends on the machine.
#[test]
fn a_scene_plays_through_a_real_serial_port() {
    let _turn = turn();
    let board = VirtualBoard::start();
    let folder = TempDir::new().unwrap();
    let process = client(&board.scene, &board.port, "600", folder.path());
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

const STREAM_SCENE: &str = r#"
version = 1
screen = { width_mm = 120, height_mm = 110, coating = { thickness_um = 10, permittivity = 1 } }
finger = { radius_mm = 8, stiffness_pa_per_m = 1.8e7, friction_coefficient = 0.5, normal_load_n = 0.5, skin_gap_um = 0 }
drive = { host_timeout_ms = 1000 }
[[layer]]
kind = "stream"
low_n = 0.0
high_n = 0.02
"#;

/// A tone that is slow beside the millisecond between two telemetry messages.
fn write_tone(path: &Path) {
    let spec = WavSpec { channels: 1, sample_rate: 1_000, bits_per_sample: 16, sample_format: SampleFormat::Int };
    let mut writer = WavWriter::create(path, spec).unwrap();
    for index in 0..60_000_u32 {
        let turns = 4.0 * f64::from(index) / 1_000.0;
        writer.write_sample((32_767.0 * (std::f64::consts::TAU * turns).sin()) as i16).unwrap();
    }
    writer.finalize().unwrap();
}

/// The board's command is the stream as it is seen from outside. The reference, made from what the host has sent, has
/// to follow it.
#[test]
fn the_reference_of_a_board_at_a_port_has_what_is_streamed() {
    let _turn = turn();
    let board = VirtualBoard::start();
    let folder = TempDir::new().unwrap();
    let (scene, tone) = (folder.path().join("stream.toml"), folder.path().join("tone.wav"));
    fs::write(&scene, STREAM_SCENE).unwrap();
    write_tone(&tone);
    let mut command = play_command(&scene, &board.port, "600", folder.path());
    let process = command.arg("--stream").arg(&tone).spawn().unwrap();
    until("rows are written", || rows_in(folder.path()) > 1_500);
    let played = interrupt(process);
    assert!(played.status.success(), "{}", String::from_utf8_lossy(&played.stderr));
    let json: serde_json::Value = serde_json::from_slice(&played.stdout).unwrap();
    assert!(json["wanted_max_n"].as_f64().unwrap() > 0.265, "{json}");

    let friction_n = |cell: &str| cell.parse::<f64>().ok();
    let rows = felt_cells(folder.path());
    let pairs: Vec<(f64, f64)> =
        rows.iter().filter_map(|row| Some((friction_n(&row[4])?, friction_n(&row[5])?))).collect();
    assert!(pairs.len() > 500, "{} rows with a finger", pairs.len());
    let near = pairs.iter().filter(|(wanted_n, asked_n)| (wanted_n - asked_n).abs() < 2e-3).count();
    assert!(near * 10 > pairs.len() * 9, "the reference is near the command in {near} of {} rows", pairs.len());
    let varied = pairs.iter().filter(|(_, asked_n)| (asked_n - 0.25).abs() > 4e-3).count();
    assert!(varied * 2 > pairs.len(), "something was streamed in {varied} of {} rows", pairs.len());
}

/// How long a write to a client may take that has no processor for itself. Reads do not wait: they ask first.
const WRITE_TIMEOUT: Duration = Duration::from_secs(30);

/// Opens the board's port, which stays exclusive until the board notices that its last client is gone.
fn opened(port: &str) -> TTYPort {
    let builder = serialport::new(port, 2_000_000).timeout(WRITE_TIMEOUT);
    let mut opened = None;
    until("the port is free", || {
        opened = TTYPort::open(&builder).ok();
        opened.is_some()
    });
    opened.unwrap()
}

/// Passes bytes between a client and a board, until the client has sent so many.
struct Tap {
    to_client: TTYPort,
    _client_end: TTYPort,
    path: String,
    to_board: TTYPort,
}

impl Tap {
    fn new(board: &VirtualBoard) -> Self {
        let (mut to_client, client_end) = TTYPort::pair().unwrap();
        to_client.set_timeout(WRITE_TIMEOUT).unwrap();
        let to_board = opened(&board.port);
        let path = client_end.name().unwrap();
        Self { to_client, _client_end: client_end, path, to_board }
    }

    /// Returns when `count` bytes have gone to the board, or when the client has ended.
    fn pass(&mut self, client: &mut Child, count: usize) {
        let mut left = count;
        let mut bytes = [0; 512];
        while left > 0 && client.try_wait().unwrap().is_none() {
            if self.to_client.bytes_to_read().unwrap() > 0 {
                let room = left.min(bytes.len());
                let got = self.to_client.read(&mut bytes[..room]).unwrap();
                self.to_board.write_all(&bytes[..got]).unwrap();
                left -= got;
            } else if self.to_board.bytes_to_read().unwrap() > 0 {
                let got = self.to_board.read(&mut bytes).unwrap();
                self.to_client.write_all(&bytes[..got]).unwrap();
            } else {
                sleep(Duration::from_micros(200));
            }
        }
    }
}

#[test]
fn a_client_killed_at_any_byte_leaves_the_output_at_zero_and_the_next_one_welcome() {
    let _turn = turn();
    let board = VirtualBoard::start_with(SHORT_HOST_TIMEOUT_S);
    let folder = TempDir::new().unwrap();
    let mut random = Random::new(1);
    let mut killed_while_playing = 0;
    for kill in 0..KILLS {
        if kill == UPLOADS_KILLED {
            // Nothing of the dead is in the way of an upload.
            board.play_to_the_end("0.1", folder.path());
        }
        // Once the board holds the picture, some 300 bytes lead to playing, and pings follow.
        let count = if kill < UPLOADS_KILLED { random.below(66_000) } else { 300 + random.below(300) } as usize;
        tries("a client lives until it is killed", || board.kill_client_after(count, folder.path()));
    }
    board.play_to_the_end("0.3", folder.path());

    let log = board.interrupt();
    for silent in log.events.iter().filter(|event| event.name == "host-silent") {
        let zero_from_s = silent.last_frame_t_s + SHORT_HOST_TIMEOUT_S + 1e-3;
        assert!(silent.t_s <= zero_from_s, "{} s after the last frame", silent.t_s - silent.last_frame_t_s);
        assert!(!log.drives_between(zero_from_s, log.next_active_s(silent.t_s)), "driven after {zero_from_s} s");
        killed_while_playing += usize::from(log.drives_between(silent.last_frame_t_s, silent.t_s));
    }
    assert!(killed_while_playing >= 3, "only {killed_while_playing} clients died while the output was driven");
}

/// Plays from this process; `None` when an answer took too long.
fn start_playing(board: &VirtualBoard) -> Option<Device<SerialLink>> {
    let started = Device::connect(SerialLink::open(&board.port, DEFAULT_BAUD).unwrap()).and_then(|mut device| {
        let hello = *device.hello();
        let program = compile(&scene_file::load(&board.scene).unwrap(), &hello.limits, hello.tick_hz).unwrap();
        frixel_play::start(&mut device, &program, &mut |_| ControlFlow::Continue(())).map(|()| device)
    });
    match started {
        Ok(device) => Some(device),
        Err(DeviceError::Silent { .. } | DeviceError::TooSlow { .. }) => None,
        Err(error) => panic!("{error}"),
    }
}

/// The program is there, and makes no call any more.
#[test]
fn a_program_that_hangs_does_not_keep_the_board_playing() {
    let _turn = turn();
    let board = VirtualBoard::start();
    let mut playing = None;
    tries("a program plays", || {
        playing = start_playing(&board);
        playing.is_some()
    });
    let device = playing.unwrap();
    let has = |name: &str| board.events().iter().any(|event| event.name == name);
    until("the board plays", || has("active"));
    until("the board lets go of a program that hangs", || board.is_disarmed() && has("host-silent"));
    assert!(device.counters().frames_sent > 0, "the program is still there");
}

#[test]
fn a_board_that_vanishes_is_said_in_a_sentence() {
    let _turn = turn();
    let mut board = VirtualBoard::start();
    let folder = TempDir::new().unwrap();
    let process = client(&board.scene, &board.port, "600", folder.path());
    until("rows are written", || rows_in(folder.path()) > 0);
    board.process.kill().unwrap();
    board.process.wait().unwrap();
    let ended = process.wait_with_output().unwrap();
    assert_eq!(ended.status.code(), Some(1));
    let said = String::from_utf8(ended.stderr).unwrap();
    let sentence = said.lines().last().unwrap();
    assert!(sentence.starts_with("frixel: ") && sentence.contains(&board.port), "{said}");
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
    let _turn = turn();
    let board = VirtualBoard::start();
    let file = tempfile::NamedTempFile::new().unwrap();
    let refused = board.play("600", &file.path().join("out"));
    assert_eq!(refused.status.code(), Some(1));
    let said = String::from_utf8(refused.stderr).unwrap();
    assert!(said.lines().last().unwrap().contains("cannot be written"), "{said}");
    assert!(board.interrupt().events.is_empty(), "the board was armed");
}

#[test]
fn a_virtual_board_that_cannot_write_announces_no_port() {
    let file = tempfile::NamedTempFile::new().unwrap();
    let refused = frixel().args(["sim", "--out"]).arg(file.path().join("out")).output().unwrap();
    assert_eq!(refused.status.code(), Some(1));
    assert_eq!(String::from_utf8(refused.stdout).unwrap(), "");
    assert!(String::from_utf8(refused.stderr).unwrap().contains("cannot be written"));
}

/// Telemetry that nobody reads any more fills the terminal. Naps count the time, so that a busy machine has more of it.
#[test]
fn a_dead_client_does_not_slow_the_board_down() {
    let _turn = turn();
    let board = VirtualBoard::start();
    let folder = TempDir::new().unwrap();
    let mut process = client(&board.scene, &board.port, "600", folder.path());
    until("rows are written", || rows_in(folder.path()) > 0);
    process.kill().unwrap();
    process.wait().unwrap();
    until("the board lets go of a dead client", || board.is_disarmed());
    // Longer than it takes to fill the terminal.
    let naps_for = |rows: usize| {
        let end = rows_in(board.folder.path()) + rows;
        let mut naps = 0_u32;
        until("virtual time goes on", || {
            naps += 1;
            rows_in(board.folder.path()) >= end
        });
        naps
    };
    naps_for(1000);
    let naps = naps_for(2000);
    assert!(naps < 2000, "{naps} naps of 5 ms for 2 s of virtual time");
    board.play_to_the_end("0.1", folder.path());
}
