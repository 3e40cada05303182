//! Boards that are absent, of another version, silent, reset or unplugged. Each is reported within a second of virtual
//! time.

use std::cell::RefCell;
use std::rc::Rc;
use std::time::Duration;

use frixel_driver::{Device, DeviceError, Event, Link, PollingLink};
use frixel_hil_sim::{BoardMemory, BoardRig, RigFault};
use frixel_wire::fault::{Fault, State};
use frixel_wire::frame::Decoder;
use frixel_wire::hello::{Hello, PROTOCOL_MAJOR};
use frixel_wire::message::{Command, Request};
use frixel_wire::payload::Payload;

use crate::calls::{MS, commit, connected, virtual_board};
use crate::uploads::upload;
use crate::virtual_link::{Fate, VirtualLine, VirtualLink, line_of};

const SECOND: Duration = Duration::from_secs(1);

fn refused_connection(line: VirtualLine) -> DeviceError {
    match Device::connect(PollingLink::new(line)) {
        Ok(_) => panic!("there is no board to connect to"),
        Err(error) => error,
    }
}

/// Drops everything that the board sends from now on.
fn silence(device: &mut Device<VirtualLink>) {
    line_of(device).to_host_weather = Box::new(|_, _| Fate::Lost);
}

/// A line whose board sends a modified hello, and receives only hello requests.
fn with_hello(spoil: impl Fn(&mut Hello) + 'static) -> VirtualLine {
    let mut line = VirtualLine::new();
    line.change_hello(spoil);
    line.refuse = Some(Box::new(|command| panic!("{command:?} was sent to a board that is refused")));
    line
}

#[test]
fn a_silent_port_gives_a_timeout() {
    let mut line = VirtualLine::new();
    line.to_host_weather = Box::new(|_, _| Fate::Lost);
    let error = refused_connection(line);
    let DeviceError::NoHello { waited, heard_bytes: 0, .. } = error else { panic!("{error}") };
    assert!(Duration::from_millis(500) <= waited && waited < SECOND, "{waited:?}");
    assert!(error.to_string().starts_with("no frixel board answered on the virtual line within 750 ms; "), "{error}");
}

/// The board accepts a command, and then reports another state.
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
            let mut device = virtual_board();
            commit(&mut device, 0.25);
            for (_, earlier, _) in commands.iter().take(number.min(3)) {
                earlier(&mut device).unwrap();
            }
            if number == 4 {
                line_of(&mut device).rig.raise(Fault::Deadline, 1);
            }
            device.wait(MS, &mut |_| {}).unwrap();
            line_of(&mut device).change_answers(move |answer| answer.state = claimed);
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
    let mut device = virtual_board();
    line_of(&mut device).change_answers(|answer| answer.state = State::Active);
    assert_eq!(
        device.disarm().unwrap_err().to_string(),
        "the board on the virtual line accepted disarm and then reported that it is Active, not Disarmed: its \
         firmware is faulty; its output may be driven: switch off its supply, then flash its firmware again"
    );
}

#[test]
fn something_else_answers() {
    let mut line = VirtualLine::new();
    line.garbage = b"login: \r\n".to_vec();
    line.to_host_weather = Box::new(|_, _| Fate::Lost);
    let error = refused_connection(line);
    assert!(matches!(error, DeviceError::NoHello { heard_bytes: 9, .. }), "{error:?}");
    assert!(error.to_string().contains("something else was received"), "{error}");
}

#[test]
fn another_major_version_is_refused_and_left_alone() {
    for (major, cure) in
        [(PROTOCOL_MAJOR - 1, "flash newer firmware"), (PROTOCOL_MAJOR + 1, "update the frixel command")]
    {
        let error = refused_connection(with_hello(move |hello| hello.protocol = (major, 7)));
        assert!(matches!(error, DeviceError::Version { .. }), "{error:?}");
        assert!(error.to_string().contains(cure), "{error}");
        assert!(error.to_string().contains(&format!("protocol {major}.7")), "{error}");
    }
}

#[test]
fn a_newer_minor_version_is_welcome() {
    let mut line = VirtualLine::new();
    line.change_hello(|hello| hello.protocol.1 += 1);
    connected(line);
}

#[test]
fn garbage_before_the_hello_is_skipped() {
    let mut line = VirtualLine::new();
    line.garbage = b"half a frame \x00 and \x00\x00 boot messages".to_vec();
    let mut device = connected(line);
    device.ping().unwrap();
    assert_eq!(device.counters().frames_rejected, 0);
}

#[test]
fn half_a_frame_of_an_earlier_host_does_not_spoil_the_hello() {
    let mut link = PollingLink::new(VirtualLine::new());
    link.write(b"half a frame").unwrap();
    let device = Device::connect(link).unwrap();
    assert_eq!(device.counters().frames_sent, 3, "the half frame, one hello, one ping");
}

#[test]
fn lost_hellos_are_sent_again() {
    for lost in 1..=4 {
        let mut line = VirtualLine::new();
        line.to_board_weather = Box::new(move |number, _| if number < lost { Fate::Lost } else { Fate::Arrives });
        connected(line);
        let mut line = VirtualLine::new();
        line.to_host_weather = Box::new(move |number, _| if number < lost { Fate::Lost } else { Fate::Arrives });
        connected(line);
    }
}

/// The board counts from its last hello, the host from the first answer. The next ping reconciles the two counts.
#[test]
fn hellos_that_are_answered_late_do_not_confuse_the_credit() {
    let mut line = VirtualLine::new();
    line.board_delay = Duration::from_millis(200);
    let mut device = connected(line);
    commit(&mut device, 0.25);
    assert_eq!(line_of(&mut device).hellos, 2);
}

#[test]
fn a_dropped_device_stops_and_disarms() {
    let mut line = VirtualLine::new();
    let written = Rc::new(RefCell::new(Vec::new()));
    let seen = Rc::clone(&written);
    line.to_board_weather = Box::new(move |_, bytes| {
        seen.borrow_mut().extend_from_slice(bytes);
        Fate::Arrives
    });
    let mut device = connected(line);
    device.arm().unwrap();
    drop(device);
    let (mut decoder, mut commands) = (Decoder::new(), Vec::new());
    let mut written = &written.borrow()[..];
    while let Some(payload) = decoder.next_frame(&mut written) {
        if let Ok(Payload::Request(Request { command, .. })) = Payload::parse_from_host(payload) {
            commands.push(command);
        }
    }
    assert!(commands.ends_with(&[Command::Stop, Command::Disarm]), "{commands:?}");
}

#[test]
fn an_unanswered_command_is_known_within_a_second() {
    let mut device = virtual_board();
    silence(&mut device);
    let error = device.arm().unwrap_err();
    let DeviceError::Silent { command: "arm", waited, .. } = error else { panic!("{error}") };
    assert!(waited < SECOND, "{waited:?}");
}

#[test]
fn a_board_that_falls_silent_is_missed_while_waiting() {
    let mut device = virtual_board();
    device.wait(5 * SECOND, &mut |_| {}).unwrap();
    silence(&mut device);
    let error = device.wait(60 * SECOND, &mut |_| {}).unwrap_err();
    assert!(matches!(error, DeviceError::Silent { command: "ping", .. }), "{error}");
    assert!(device.now() < 6 * SECOND);
}

#[test]
fn silence_is_missed_in_short_waits_too() {
    let mut device = virtual_board();
    silence(&mut device);
    let waits = (0..100).take_while(|_| device.wait(Duration::from_millis(10), &mut |_| {}).is_ok()).count();
    assert!((50..=80).contains(&waits), "missed after {waits} waits of 10 ms");
}

#[test]
fn a_board_that_falls_silent_in_an_upload_is_known_within_a_second() {
    let mut line = VirtualLine::new();
    line.to_board_weather = Box::new(|number, _| if number >= 100 { Fate::Lost } else { Fate::Arrives });
    let mut device = connected(line);
    let error = upload(&mut device).unwrap_err();
    assert!(matches!(error, DeviceError::Silent { .. }), "{error}");
    assert!(device.now() < SECOND);
}

#[test]
fn a_board_that_is_reset_is_noticed() {
    let mut device = virtual_board();
    device.wait(2 * SECOND, &mut |_| {}).unwrap();
    line_of(&mut device).rig.reset(Box::leak(BoardMemory::new()));
    let error = device.wait(10 * SECOND, &mut |_| {}).unwrap_err();
    assert!(matches!(error, DeviceError::Restarted { .. }), "{error}");
    assert!(device.now() < 3 * SECOND);
}

#[test]
fn a_pulled_cable_ends_every_call_at_once() {
    let pulled_at = |ms| {
        let mut line = VirtualLine::new();
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
    let error = upload(&mut device).unwrap_err();
    assert!(matches!(error, DeviceError::Vanished { command: "upload of a bitmap", .. }), "{error}");
    assert!(error.to_string().starts_with("the virtual line vanished (pulled) during: upload of a bitmap; "));
    assert!(!line_of(&mut device).commands.contains(&Command::UploadEnd));
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
        let error = refused_connection(with_hello(spoil));
        assert!(matches!(error, DeviceError::Limit { limit, .. } if limit == name), "{error}");
        assert!(error.to_string().contains("flash its firmware again"), "{error}");
    }
}

#[test]
fn telemetry_that_goes_back_in_time_is_an_error() {
    let mut device = virtual_board();
    device.subscribe(800).unwrap();
    let mut ticks = Vec::new();
    let mut waited = |device: &mut Device<VirtualLink>| {
        device.wait(2 * SECOND, &mut |event| {
            if let Event::Telemetry(telemetry) = event {
                ticks.push(telemetry.tick);
            }
        })
    };
    waited(&mut device).unwrap();
    line_of(&mut device).rig.cause(RigFault::WrapSoon { ticks: 100_000 }, 0).unwrap();
    let error = waited(&mut device).unwrap_err();
    assert!(matches!(error, DeviceError::TelemetryBackwards { .. }), "{error}");
    assert!(ticks.len() > 10 && ticks.is_sorted(), "{ticks:?}");
}
