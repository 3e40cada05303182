//! The serial link over a pseudo-terminal, in real time. Nothing here is measured by the clock.

use std::io::Write;
use std::ops::ControlFlow;
use std::time::Duration;

use frixel_driver::{DEFAULT_BAUD, Device, DeviceError, Link, PortError, SerialLink, Upload, ignore_progress};
use frixel_wire::fault::State;
use frixel_wire::frame::FRAME_MAX_LEN;
use frixel_wire::message::{Command, Request};
use frixel_wire::payload::{hello_request_frame, request_frame};
use serialport::{SerialPort, TTYPort};

use crate::calls::scene;
use crate::pty_board::{Patient, PtyBoard};
use crate::uploads::{picture, samples};

const LONG: Duration = Duration::from_mins(10);

fn open(path: &str) -> Result<SerialLink, PortError> {
    SerialLink::open(path, DEFAULT_BAUD)
}

fn connect(board: &PtyBoard) -> Device<Patient> {
    Device::connect(Patient(open(&board.path).unwrap())).unwrap()
}

fn not_opened(path: &str) -> PortError {
    match open(path) {
        Ok(_) => panic!("{path} opened"),
        Err(error) => error,
    }
}

#[test]
fn a_scene_plays_over_a_serial_port() {
    let board = PtyBoard::start();
    let mut device = connect(&board);
    let (samples, scene) = (samples(62_500), scene(0.25));
    let upload = Upload { scene: &scene, bitmaps: vec![picture(&samples)] };
    device.upload(&upload, &mut ignore_progress).unwrap();
    device.commit(upload.scene_crc32()).unwrap();
    device.arm().unwrap();
    device.play().unwrap();
    device.subscribe(40).unwrap();
    let mut heard = 0;
    let waits = (0..100).take_while(|_| {
        device.wait(Duration::from_millis(10), &mut |_| heard += 1).unwrap();
        heard < 5
    });
    waits.count();
    assert!(heard >= 5, "{heard} messages of telemetry in a second");
    let counters = device.counters();
    assert_eq!((counters.payload_bytes, counters.frames_rejected), ((samples.len() + scene.len()) as u64, 0));
    assert_eq!(board.line.lock().unwrap().state, State::Active);
}

/// `host/python/tests` checks that they end when the application hangs.
#[test]
fn pings_go_out_while_nobody_calls() {
    let board = PtyBoard::start();
    let mut device = connect(&board);
    // Then a ping is due every 5 ms, some 200 before the keep-alive timeout.
    device.arm().unwrap();
    let before = board.line.lock().unwrap().pings;
    board.until(|line| line.pings > before + 5);
}

#[test]
fn a_dropped_device_stops_and_disarms_and_the_next_host_is_welcome() {
    let board = PtyBoard::start();
    for _ in 0..3 {
        let mut device = connect(&board);
        device.arm().unwrap();
        drop(device);
        board.until(|line| line.commands.ends_with(&[Command::Arm, Command::Stop, Command::Disarm]));
    }
    assert_eq!(board.line.lock().unwrap().hellos, 3);
}

#[test]
fn an_answer_that_an_earlier_host_did_not_read_is_thrown_away() {
    let board = PtyBoard::start();
    let mut earlier = TTYPort::open(&serialport::new(&board.path, DEFAULT_BAUD)).unwrap();
    earlier.write_all(hello_request_frame(&mut [0; FRAME_MAX_LEN]).unwrap()).unwrap();
    board.until(|line| line.hellos == 1);
    // Once the board has seen this, it has sent its hello.
    let ping = Request { sequence: 1, command: Command::Ping };
    earlier.write_all(request_frame(&ping, &mut [0; FRAME_MAX_LEN]).unwrap()).unwrap();
    board.until(|line| line.pings == 1);
    drop(earlier);
    board.line.lock().unwrap().change_hello(|hello| hello.fault_detail = 42);
    assert_eq!(connect(&board).hello().fault_detail, 42);
}

#[test]
fn a_pulled_cable_ends_a_long_wait() {
    let mut board = PtyBoard::start();
    let mut device = connect(&board);
    let waiting = std::thread::spawn(move || (device.wait(LONG, &mut |_| {}), device));
    board.until(|line| line.pings > 2);
    board.unplug();
    let (outcome, mut device) = waiting.join().unwrap();
    let error = outcome.unwrap_err();
    assert!(matches!(error, DeviceError::Vanished { command: "wait", .. }), "{error}");
    let error = device.ping().unwrap_err();
    assert!(matches!(error, DeviceError::Vanished { command: "ping", .. }), "{error}");
}

#[test]
fn a_cable_pulled_in_an_upload_ends_it() {
    let mut board = PtyBoard::start();
    let mut device = connect(&board);
    let (samples, scene) = (samples(62_500), scene(0.25));
    let upload = Upload { scene: &scene, bitmaps: vec![picture(&samples)] };
    let outcome = device.upload(&upload, &mut |progress| {
        if progress.done_bytes > 20_000 {
            board.unplug();
        }
        ControlFlow::Continue(())
    });
    let error = outcome.unwrap_err();
    assert!(matches!(error, DeviceError::Vanished { command: "upload of a bitmap", .. }), "{error}");
}

#[test]
fn a_port_in_use_is_refused() {
    let board = PtyBoard::start();
    let _first = connect(&board);
    let error = not_opened(&board.path);
    assert_eq!(error, PortError::Busy { port: board.path.clone() });
}

/// A client that opens the port while the previous one is still closing it waits for that.
#[test]
fn a_port_that_is_let_go_soon_opens() {
    let board = PtyBoard::start();
    let first = open(&board.path).unwrap();
    std::thread::spawn(move || drop(first));
    connect(&board);
}

#[test]
fn a_port_that_is_not_there_is_refused() {
    let error = not_opened("/dev/frixel-is-not-there");
    assert!(matches!(error, PortError::NotThere { .. }), "{error}");
    assert!(error.to_string().starts_with("there is no port /dev/frixel-is-not-there; "), "{error}");
}

#[test]
fn a_file_that_is_no_port_is_refused() {
    let error = not_opened("/dev/null");
    assert!(matches!(error, PortError::NotOpened { .. }), "{error}");
}

/// The operating system stops accepting bytes long before this point. Neither a write nor a drop may wait for it.
#[test]
fn an_end_that_does_not_read_blocks_nobody() {
    let (master, slave) = TTYPort::pair().unwrap();
    let mut link = open(&slave.name().unwrap()).unwrap();
    for count in 1..=2000 {
        assert_eq!(link.write(&[1; 192]).unwrap(), 192 * count);
    }
    drop(link);
    drop(master);
}
