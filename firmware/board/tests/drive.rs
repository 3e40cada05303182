//! A voltage of bring-up, driven through the firmware's session, ticker and supervisor.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail")]

use crate::support::firmware::{BOARD, Firmware};
use frixel_board::bring_up::{Drive, DriveError, Reading};
use frixel_control::Sense;
use frixel_wire::fault::{Fault, State};
use frixel_wire::message::Refusal;

/// Default number of ticks between two rounds of the main loop.
const ROUND_TICKS: u32 = 4;
/// The age at which a report of the finger no longer counts, 40 ms: bring-up's host sends one in each round.
const REPORT_MAX_TICKS: u32 = 1_600;
/// More than a drive takes: ten seconds.
const TICKS_MAX: u32 = 400_000;

/// The changes of the board's inputs at a tick of a drive.
type World<'w> = &'w dyn Fn(u32, &mut Sense);

struct TestBoard {
    firmware: Firmware,
    round_ticks: u32,
    /// Largest code that was driven, as a part of full scale.
    code_max: i16,
    /// The last tick with an enabled amplifier.
    last_driven_tick: Option<u32>,
}

impl TestBoard {
    fn new() -> Self {
        Self { firmware: Firmware::new(), round_ticks: ROUND_TICKS, code_max: 0, last_driven_tick: None }
    }

    fn tick(&mut self, tick: u32, switch_held: bool, world: World) {
        let monitor_v = self.firmware.monitor.voltage_v();
        let mut sense = Sense { arm_switch: switch_held, monitor_v, ..Sense::default() };
        world(tick, &mut sense);
        let drive = self.firmware.tick(&sense);
        self.code_max = self.code_max.max(drive.dac_code.bits());
        if drive.amplifier_enable {
            self.last_driven_tick = Some(tick);
        }
    }

    fn press(&mut self) {
        self.tick(0, false, &|_, _| ());
        self.tick(0, true, &|_, _| ());
    }

    /// Drives a voltage with the switch held, while `world` changes what the board senses.
    fn drive(&mut self, peak_v: f32, world: World) -> Result<Reading, DriveError> {
        let mut drive = Drive::new(peak_v, &BOARD);
        let mut next_status = self.firmware.ticker.status();
        (self.code_max, self.last_driven_tick) = (0, None);
        for tick in 1..TICKS_MAX {
            self.tick(tick, true, world);
            if tick.is_multiple_of(self.round_ticks) {
                // The main loop has taken its status a round ago; tick count and monitor are as they are now.
                let Firmware { session, ticker, monitor } = &mut self.firmware;
                let status = core::mem::replace(&mut next_status, ticker.status());
                let result = drive.step(&status, next_status.telemetry.tick, monitor.voltage_v(), session);
                self.firmware.poll(&status);
                if let Some(result) = result {
                    return result;
                }
            }
        }
        panic!("it never ends")
    }

    fn state(&self) -> State {
        self.firmware.ticker.state()
    }
}

const GOOD: World<'static> = &|_, _| ();

#[test]
fn a_voltage_is_driven_through_the_firmware_and_read_on_the_monitor() {
    let mut board = TestBoard::new();
    for peak_v in [10.0, 25.0, 50.0] {
        board.press();
        let reading = board.drive(peak_v, GOOD).unwrap();
        let expected = Reading { driven_v_peak: peak_v, high_v: peak_v, low_v: -peak_v, rest_v: 0.0 };
        for (found, expected) in [
            (reading.driven_v_peak, expected.driven_v_peak),
            (reading.high_v, expected.high_v),
            (reading.low_v, expected.low_v),
            (reading.rest_v, expected.rest_v),
        ] {
            assert!((found - expected).abs() < 0.05, "{reading:?}");
        }
        assert!(f32::from(board.code_max) <= peak_v / 200.0 * f32::from(i16::MAX));
        assert_eq!(board.state(), State::Disarmed);
        let driven_ticks = board.last_driven_tick.unwrap();
        assert!((115_000..125_000).contains(&driven_ticks), "three seconds: {driven_ticks}");
    }
}

#[test]
fn a_main_loop_of_any_speed_reads_the_same() {
    for round_ticks in [1, 3, 7, 15, 24] {
        let mut board = TestBoard { round_ticks, ..TestBoard::new() };
        board.press();
        let reading = board.drive(50.0, GOOD).unwrap();
        assert!((reading.high_v - 50.0).abs() < 0.05 && (reading.low_v + 50.0).abs() < 0.05, "{reading:?}");
    }
}

/// The host's credit, some 4,096 bytes, does not run out.
#[test]
fn one_drive_after_the_other_is_heard() {
    let mut board = TestBoard::new();
    for _ in 0..12 {
        board.press();
        assert!(board.drive(10.0, GOOD).is_ok());
    }
}

#[test]
fn nothing_is_driven_without_a_press_after_the_last_drive() {
    let mut board = TestBoard::new();
    board.press();
    board.drive(10.0, GOOD).unwrap();
    // The switch is still held.
    assert_eq!(board.drive(25.0, GOOD), Err(DriveError::State(State::Disarmed)));
    assert_eq!((board.last_driven_tick, board.code_max), (None, 0));
}

#[test]
fn a_voltage_beyond_the_limits_is_refused() {
    let mut board = TestBoard::new();
    board.press();
    let refused = board.drive(51.0, GOOD);
    assert!(matches!(refused, Err(DriveError::Refused(Refusal::Config(_)))), "{refused:?}");
    assert_eq!(board.last_driven_tick, None);
}

#[test]
fn nothing_resumes_after_a_fault() {
    const AT_TICK: u32 = 60_000;
    let at = |tick: u32| tick >= AT_TICK;
    let amplifier: World = &|tick, sense| sense.amplifier_fault |= at(tick);
    let switch: World = &|tick, sense| sense.arm_switch &= !at(tick);
    let monitor: World = &|tick, sense| {
        if at(tick) {
            sense.monitor_v = 0.0;
        }
    };
    for (world, fault) in [(amplifier, Fault::Amplifier), (switch, Fault::ArmSwitch), (monitor, Fault::Monitor)] {
        let mut board = TestBoard::new();
        board.press();
        let result = board.drive(50.0, world);
        assert!(matches!(result, Err(DriveError::Fault(found, _)) if found == fault), "{result:?}");
        let last = board.last_driven_tick.unwrap();
        assert!((AT_TICK - 1..AT_TICK + 40).contains(&last), "{fault}: {last}");
        // The board is healthy again, and the person presses the switch again.
        board.press();
        let result = board.drive(10.0, GOOD);
        assert!(matches!(result, Err(DriveError::Fault(found, _)) if found == fault), "{result:?}");
        assert_eq!(board.last_driven_tick, None);
    }
}

/// A hanging main loop also stops bring-up's host, so the host timeout ends the drive.
#[test]
fn a_main_loop_that_hangs_ends_the_drive() {
    let mut board = TestBoard::new();
    board.press();
    let mut drive = Drive::new(10.0, &BOARD);
    for tick in 1..80_000 {
        board.tick(tick, true, GOOD);
        if tick < 40_000 && tick.is_multiple_of(ROUND_TICKS) {
            let status = board.firmware.ticker.status();
            assert_eq!(drive.step(&status, status.telemetry.tick, 0.0, &mut board.firmware.session), None);
            board.firmware.session.poll(&status);
        }
    }
    assert_eq!(board.state(), State::Disarmed);
    let last = board.last_driven_tick.unwrap();
    assert!(last <= 40_000 + REPORT_MAX_TICKS, "{last}");
    // It goes on too late.
    let status = board.firmware.ticker.status();
    let result = drive.step(&status, status.telemetry.tick, 0.0, &mut board.firmware.session);
    assert_eq!(result, Some(Err(DriveError::State(State::Disarmed))));
}
