//! Boards that are absent, of another version, silent, reset or unplugged. Each is known within a second of virtual
//! time.

use std::cell::Cell;
use std::ops::ControlFlow;
use std::rc::Rc;
use std::time::Duration;

use frixel_driver::{Bitmap, Device, DeviceError, Event, Link, PollingLink, Upload};
use frixel_wire::fault::State;
use frixel_wire::frame::{FRAME_MAX_LEN, crc32};
use frixel_wire::hello::{Hello, PROTOCOL_MAJOR};
use frixel_wire::message::{Command, FromBoard, Telemetry};
use frixel_wire::payload::from_board_frame;

use crate::calls::{connected, reconnected, scene};
use crate::fake_board::FakeBoard;
use crate::virtual_link::{Fate, VirtualLine, VirtualLink, line_of};

const SECOND: Duration = Duration::from_secs(1);

fn refused_connection(line: VirtualLine) -> DeviceError {
    match Device::connect(PollingLink::new(line)) {
        Ok(_) => panic!("there is no board to connect to"),
        Err(error) => error,
    }
}

/// A line whose board can be silenced while the device holds it.
fn silenceable() -> (VirtualLine, Rc<Cell<bool>>) {
    let silent = Rc::new(Cell::new(false));
    let mut line = VirtualLine::new(FakeBoard::new());
    let weather = Rc::clone(&silent);
    line.to_host_weather = Box::new(move |_, _| if weather.get() { Fate::Lost } else { Fate::Arrives });
    (line, silent)
}

#[test]
fn a_silent_port_gives_a_timeout() {
    let mut board = FakeBoard::new();
    board.mute = true;
    let error = refused_connection(VirtualLine::new(board));
    let DeviceError::NoHello { waited, heard_bytes: 0, .. } = error else { panic!("{error}") };
    assert!(Duration::from_millis(500) <= waited && waited < SECOND, "{waited:?}");
    assert!(error.to_string().starts_with("no frixel board answered on the virtual line within 750 ms; "), "{error}");
}

/// A board that accepts a command and says that it did something else.
#[test]
fn a_state_that_the_command_does_not_lead_to_is_an_error() {
    type Call = fn(&mut Device<VirtualLink>) -> Result<(), DeviceError>;
    let commands: [(&str, Call, State); 5] = [
        ("arm", Device::arm, State::Armed),
        ("play", Device::play, State::Active),
        ("stop", Device::stop, State::Armed),
        ("disarm", Device::disarm, State::Disarmed),
        ("clear the fault", Device::clear_fault, State::Disarmed),
    ];
    for (number, (name, call, right)) in commands.into_iter().enumerate() {
        for claimed in [State::Disarmed, State::Armed, State::Active, State::Faulted] {
            let mut device = connected(VirtualLine::new(FakeBoard::new()));
            for (_, earlier, _) in commands.iter().take(number.min(4)) {
                earlier(&mut device).unwrap();
            }
            let board = &mut line_of(&mut device).board;
            if number == 4 {
                board.state = State::Faulted;
            }
            board.claims = Some(claimed);
            match call(&mut device) {
                Ok(()) => assert_eq!(claimed, right, "{name}"),
                Err(DeviceError::WrongState { command, found, expected, .. }) => {
                    assert_eq!((command, found, expected), (name, claimed, right));
                    assert_ne!(found, right);
                }
                Err(error) => panic!("{name}, {claimed:?}: {error}"),
            }
        }
    }
    let mut device = connected(VirtualLine::new(FakeBoard::new()));
    line_of(&mut device).board.claims = Some(State::Active);
    assert_eq!(
        device.disarm().unwrap_err().to_string(),
        "the board on the virtual line accepted disarm and then said that it is Active, not Disarmed: its firmware is \
         faulty; its output may be driven: switch off its supply, then flash its firmware anew"
    );
}

#[test]
fn something_else_answers() {
    let mut line = VirtualLine::new(FakeBoard::new());
    line.board.garbage = b"login: \r\n".to_vec();
    line.to_host_weather = Box::new(|_, frame| if frame.starts_with(b"log") { Fate::Tail(30) } else { Fate::Lost });
    let error = refused_connection(line);
    assert!(matches!(error, DeviceError::NoHello { heard_bytes: 30, .. }), "{error:?}");
    assert!(error.to_string().contains("something else talks there"), "{error}");
}

#[test]
fn another_major_version_is_refused_and_left_alone() {
    for (major, cure) in
        [(PROTOCOL_MAJOR - 1, "flash newer firmware"), (PROTOCOL_MAJOR + 1, "update the frixel command")]
    {
        let mut board = FakeBoard::new();
        board.hello.protocol = (major, 7);
        board.refuse = Some(Box::new(|command| panic!("{command:?} was sent to a board of another version")));
        let error = refused_connection(VirtualLine::new(board));
        assert!(matches!(error, DeviceError::Version { .. }), "{error:?}");
        assert!(error.to_string().contains(cure), "{error}");
        assert!(error.to_string().contains(&format!("protocol {major}.7")), "{error}");
    }
}

#[test]
fn a_newer_minor_version_is_welcome() {
    let mut board = FakeBoard::new();
    board.hello.protocol.1 += 1;
    connected(VirtualLine::new(board));
}

#[test]
fn garbage_before_the_hello_is_skipped() {
    let mut line = VirtualLine::new(FakeBoard::new());
    line.board.garbage = b"half a frame \x00 and \x00\x00 boot messages".to_vec();
    let mut device = connected(line);
    device.ping().unwrap();
    assert_eq!(device.counters().frames_rejected, 0);
}

#[test]
fn half_a_frame_of_an_earlier_host_does_not_spoil_the_hello() {
    let mut link = PollingLink::new(VirtualLine::new(FakeBoard::new()));
    link.write(b"half a frame").unwrap();
    let device = Device::connect(link).unwrap();
    assert_eq!(device.counters().frames_sent, 3, "the half frame, one hello, one ping");
}

#[test]
fn lost_hellos_are_sent_again() {
    for lost in 1..=4 {
        let mut line = VirtualLine::new(FakeBoard::new());
        line.to_board_weather = Box::new(move |number, _| if number < lost { Fate::Lost } else { Fate::Arrives });
        connected(line);
        let mut line = VirtualLine::new(FakeBoard::new());
        line.to_host_weather = Box::new(move |number, _| if number < lost { Fate::Lost } else { Fate::Arrives });
        connected(line);
    }
}

/// The board counts from its last hello on, the host from the first answer; the next ping brings the two together.
#[test]
fn hellos_that_are_answered_late_do_not_confuse_the_credit() {
    let mut line = VirtualLine::new(FakeBoard::new());
    line.board_delay = Duration::from_millis(200);
    let mut device = connected(line);
    let scene = scene(0.25);
    device.upload(&Upload { scene: &scene, bitmaps: Vec::new() }, &mut |_| ControlFlow::Continue(())).unwrap();
    assert_eq!(line_of(&mut device).board.hellos, 2);
}

#[test]
fn two_hosts_one_after_the_other() {
    let mut first = connected(VirtualLine::new(FakeBoard::new()));
    first.arm().unwrap();
    let mut second = reconnected(first);
    assert_eq!(second.hello().state, State::Disarmed, "what the first armed is not the second's");
    second.arm().unwrap();
    assert_eq!(line_of(&mut second).board.state, State::Armed);
}

#[test]
fn an_unanswered_command_is_known_within_a_second() {
    let (line, silent) = silenceable();
    let mut device = connected(line);
    silent.set(true);
    let error = device.arm().unwrap_err();
    let DeviceError::Silent { command: "arm", waited, .. } = error else { panic!("{error}") };
    assert!(waited < SECOND, "{waited:?}");
}

#[test]
fn a_board_that_falls_silent_is_missed_while_waiting() {
    let (line, silent) = silenceable();
    let mut device = connected(line);
    device.wait(5 * SECOND, &mut |_| {}).unwrap();
    silent.set(true);
    let error = device.wait(60 * SECOND, &mut |_| {}).unwrap_err();
    assert!(matches!(error, DeviceError::Silent { command: "ping", .. }), "{error}");
    assert!(device.now() < 6 * SECOND);
}

#[test]
fn silence_is_missed_in_short_waits_too() {
    let (line, silent) = silenceable();
    let mut device = connected(line);
    silent.set(true);
    let waits = (0..100).take_while(|_| device.wait(Duration::from_millis(10), &mut |_| {}).is_ok()).count();
    assert!((50..=80).contains(&waits), "missed after {waits} waits of 10 ms");
}

#[test]
fn a_board_that_falls_silent_in_an_upload_is_known_within_a_second() {
    let mut line = VirtualLine::new(FakeBoard::new());
    line.to_board_weather = Box::new(|number, _| if number >= 100 { Fate::Lost } else { Fate::Arrives });
    let mut device = connected(line);
    let samples = vec![7; 62_500];
    let bitmap = Bitmap { crc32: crc32(&samples), width: 250, height: 250, samples: &samples };
    let error = device
        .upload(&Upload { scene: &scene(0.25), bitmaps: vec![bitmap] }, &mut |_| ControlFlow::Continue(()))
        .unwrap_err();
    assert!(matches!(error, DeviceError::Silent { .. }), "{error}");
    assert!(device.now() < SECOND);
}

#[test]
fn a_board_that_is_reset_is_noticed() {
    let mut board = FakeBoard::new();
    board.reset_at = Some(2 * SECOND);
    let mut device = connected(VirtualLine::new(board));
    let error = device.wait(10 * SECOND, &mut |_| {}).unwrap_err();
    assert!(matches!(error, DeviceError::Restarted { .. }), "{error}");
    assert!(device.now() < 3 * SECOND);
}

#[test]
fn a_pulled_cable_ends_every_call_at_once() {
    let pulled_at = |ms| {
        let mut line = VirtualLine::new(FakeBoard::new());
        line.pulled_at = Some(Duration::from_millis(ms));
        line
    };
    let error = refused_connection(pulled_at(0));
    assert!(matches!(error, DeviceError::Vanished { command: "hello", .. }), "{error}");

    let mut device = connected(pulled_at(5000));
    let error = device.wait(10 * SECOND, &mut |_| {}).unwrap_err();
    assert!(matches!(error, DeviceError::Vanished { command: "wait", .. }), "{error}");
    let error = device.arm().unwrap_err();
    assert!(matches!(error, DeviceError::Vanished { command: "arm", .. }), "{error}");
    assert_eq!(device.now(), 5 * SECOND);

    let mut device = connected(pulled_at(100));
    let samples = vec![7; 62_500];
    let bitmap = Bitmap { crc32: crc32(&samples), width: 250, height: 250, samples: &samples };
    let error = device
        .upload(&Upload { scene: &scene(0.25), bitmaps: vec![bitmap] }, &mut |_| ControlFlow::Continue(()))
        .unwrap_err();
    assert!(matches!(error, DeviceError::Vanished { command: "upload of a bitmap", .. }), "{error}");
    assert!(error.to_string().starts_with("the virtual line vanished (pulled) during: upload of a bitmap; "));
    let line = line_of(&mut device);
    assert!(!line.board.commands.contains(&Command::UploadEnd));
}

#[test]
fn a_hello_whose_limits_are_no_limits_is_refused() {
    type Spoil = fn(&mut Hello);
    let spoilt: [(&str, Spoil); 6] = [
        ("tick_hz", |hello| hello.tick_hz = 0),
        ("tick_hz", |hello| hello.tick_hz = 1 << 31),
        ("voltage_max_v_peak", |hello| hello.limits.voltage_max_v_peak = f32::NAN),
        ("electrode_capacitance_max_f", |hello| hello.limits.electrode_capacitance_max_f = f32::NAN),
        ("current_max_a_rms", |hello| hello.limits.current_max_a_rms = -1.0),
        ("touch_report_period_s", |hello| hello.limits.touch_report_period_s = f32::INFINITY),
    ];
    for (name, spoil) in spoilt {
        let mut board = FakeBoard::new();
        spoil(&mut board.hello);
        board.refuse = Some(Box::new(|command| panic!("{command:?} was sent to a board without limits")));
        let error = refused_connection(VirtualLine::new(board));
        assert!(matches!(error, DeviceError::Limit { limit, .. } if limit == name), "{error}");
        assert!(error.to_string().contains("flash its firmware anew"), "{error}");
    }
}

#[test]
fn telemetry_that_goes_back_in_time_is_an_error() {
    let mut line = VirtualLine::new(FakeBoard::new());
    let mut backwards = [0; FRAME_MAX_LEN];
    let telemetry = Telemetry { tick: 100, state: State::Active, ..Telemetry::default() };
    let backwards = from_board_frame(&FromBoard::Telemetry(telemetry), &mut backwards).unwrap().to_vec();
    line.board.says_at = Some((Duration::from_secs(2), backwards));
    let mut device = connected(line);
    device.subscribe(4_000).unwrap();
    let mut ticks = Vec::new();
    let waited = device.wait(Duration::from_secs(3), &mut |event| {
        if let Event::Telemetry(telemetry) = event {
            ticks.push(telemetry.tick);
        }
    });
    assert!(matches!(waited, Err(DeviceError::TelemetryBackwards { tick: 100, .. })), "{waited:?}");
    assert!(ticks.len() > 10 && ticks.is_sorted(), "{ticks:?}");
}
