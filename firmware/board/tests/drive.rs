//! A voltage of bring-up, driven through the firmware's main loop, session, ticker and supervisor.

use frixel_board::bring_up::{Drive, DriveError, Reading};
use frixel_wire::fault::{Fault, State};
use frixel_wire::message::Refusal;

use crate::support::firmware::BOARD;
use crate::support::hardware::{Event, Wires, run_tick};
use crate::support::played::Board;

/// Default number of ticks between two rounds of the main loop.
const ROUND_TICKS: u32 = 4;
/// The age at which a report of the finger no longer counts, 40 ms: bring-up's host sends one in each round.
const REPORT_MAX_TICKS: u32 = 1_600;
/// More than a drive takes: ten seconds.
const TICKS_MAX: u32 = 400_000;

/// A board whose person has released the switch and holds it.
fn pressed() -> Board {
    let mut board = Board::new();
    press(&mut board);
    board
}

fn press(board: &mut Board) {
    for closed in [false, true] {
        board.wires.switch_closed.set(closed);
        (0..1_000).for_each(|_| board.step());
    }
    board.wires.take();
}

/// A round of the main loop.
fn round(board: &mut Board, drive: &mut Drive, ticks: u32) -> Option<Result<Reading, DriveError>> {
    (0..ticks).for_each(|_| run_tick());
    let Board { main_loop, wires, shared, .. } = board;
    main_loop.turn(None);
    drive.step(&main_loop.status, shared.count(), wires.monitor_v(), main_loop.session)
}

/// Drives a voltage, while `world` changes the wires at a tick of the drive.
fn drive(board: &mut Board, peak_v: f32, ticks: u32, world: impl Fn(u32, &Wires)) -> Result<Reading, DriveError> {
    let (mut drive, from_tick) = (Drive::new(peak_v, &BOARD), board.shared.count());
    loop {
        let tick = board.shared.count() - from_tick;
        assert!(tick < TICKS_MAX, "it never ends");
        world(tick, &board.wires);
        if let Some(result) = round(board, &mut drive, ticks) {
            return result;
        }
    }
}

const GOOD: fn(u32, &Wires) = |_, _| ();

/// Ticks with an enabled amplifier since the last call, and the largest code, as a part of full scale.
fn driven(board: &Board) -> (usize, i16) {
    let events = board.wires.take();
    let code = |event: &Event| if let Event::Sent(code) = event { Some(code.bits()) } else { None };
    let ticks = events.iter().filter(|event| **event == Event::Kicked).count();
    (ticks, events.iter().filter_map(code).max().unwrap_or(0))
}

#[test]
fn a_voltage_is_driven_and_read_on_the_monitor_at_any_main_loop_speed() {
    for (peak_v, round_ticks) in [(10.0, ROUND_TICKS), (25.0, 1), (50.0, 7), (50.0, 24)] {
        let mut board = pressed();
        let reading = drive(&mut board, peak_v, round_ticks, GOOD).unwrap();
        for (found, expected) in
            [(reading.driven_v_peak, peak_v), (reading.high_v, peak_v), (reading.low_v, -peak_v), (reading.rest_v, 0.0)]
        {
            assert!((found - expected).abs() < 0.05, "{reading:?}");
        }
        let (ticks, code_max) = driven(&board);
        assert!(f32::from(code_max) <= peak_v / 200.0 * f32::from(i16::MAX));
        assert!((115_000..125_000).contains(&ticks), "three seconds: {ticks}");
        assert_eq!(board.state(), State::Disarmed);
    }
}

/// The host's credit, some 4,096 bytes, does not run out.
#[test]
fn repeated_drives_do_not_run_out_of_credit() {
    let mut board = pressed();
    for _ in 0..12 {
        assert!(drive(&mut board, 10.0, ROUND_TICKS, GOOD).is_ok());
        press(&mut board);
    }
}

#[test]
fn a_voltage_beyond_the_limits_is_refused() {
    let mut board = pressed();
    let refused = drive(&mut board, 51.0, ROUND_TICKS, GOOD);
    assert!(matches!(refused, Err(DriveError::Refused(Refusal::Config(_)))), "{refused:?}");
    assert_eq!(driven(&board), (0, 0));
}

#[test]
fn nothing_resumes_after_a_fault() {
    const AT_TICK: u32 = 60_000;
    let mut board = pressed();
    let fault = Err(DriveError::Fault(Fault::Amplifier, 0));
    assert_eq!(drive(&mut board, 50.0, ROUND_TICKS, |tick, wires| wires.ready.set(tick < AT_TICK)), fault);
    // The board is healthy again, and the person presses the switch again.
    board.wires.ready.set(true);
    press(&mut board);
    assert_eq!(drive(&mut board, 10.0, ROUND_TICKS, GOOD), fault);
    assert_eq!(driven(&board), (0, 0));
}

/// A hanging main loop also stops bring-up's host, so its finger is soon too old.
#[test]
fn a_main_loop_that_hangs_ends_the_drive() {
    let mut board = pressed();
    let mut drive = Drive::new(10.0, &BOARD);
    for _ in 0..10_000 {
        assert_eq!(round(&mut board, &mut drive, ROUND_TICKS), None);
    }
    assert_eq!(board.state(), State::Active);
    board.wires.take();
    (0..40_000).for_each(|_| run_tick());
    let (ticks, _) = driven(&board);
    assert!(ticks <= REPORT_MAX_TICKS as usize, "{ticks}");
    // It continues too late. The status in the queue is that of the first tick without it.
    let result = (0..3).find_map(|_| round(&mut board, &mut drive, ROUND_TICKS));
    assert_eq!(result, Some(Err(DriveError::State(State::Disarmed))));
    assert_eq!(driven(&board), (0, 0));
}
