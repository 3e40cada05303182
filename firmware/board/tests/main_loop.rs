//! The main loop of every board: the DAC's checks, the watchdog, the serial port, and the measurement of time.

use embedded_io::ErrorKind;
use frixel_wire::dac_code::DacCode;
use frixel_wire::fault::{Fault, State};
use frixel_wire::frame::Decoder;
use frixel_wire::message::Command;

use crate::support::firmware::BOARD;
use crate::support::hardware::{Event, run_tick};
use crate::support::played::Board;

/// The events of one kind of part, in order.
fn only(events: &[Event], of: impl Fn(&Event) -> bool) -> Vec<Event> {
    events.iter().copied().filter(|event| of(event)).collect()
}

fn is_of_dac(event: &Event) -> bool {
    matches!(event, Event::Prepared | Event::Checked)
}

fn is_of_tick(event: &Event) -> bool {
    matches!(event, Event::Sent(_) | Event::Kicked | Event::Disabled)
}

/// Feeding the watchdog takes a new tick and a turn of the main loop: the board is reset if either of them stops.
#[test]
fn only_a_new_tick_feeds_the_watchdog() {
    let is_fed = |event: &Event| *event == Event::Fed;
    let mut board = Board::new();
    board.step();
    board.wires.take();
    for _ in 0..100 {
        board.main_loop.turn(None);
    }
    assert_eq!(only(&board.wires.take(), is_fed), [], "the tick stands still");
    for _ in 0..100 {
        run_tick();
    }
    assert_eq!(only(&board.wires.take(), is_fed), [], "the main loop stands still");
    for _ in 0..100 {
        board.step();
    }
    assert_eq!(only(&board.wires.take(), is_fed).len(), 100);
}

/// The DAC is configured and read back before arming, and read back before play, with no frame or kick in between.
#[test]
fn the_dac_is_checked_before_the_board_arms_and_before_it_plays() {
    let board = Board::until(|board| board.state() == State::Active);
    let events = only(&board.wires.take(), |event| is_of_dac(event) || is_of_tick(event));
    assert_eq!(only(&events, is_of_dac), [Event::Prepared, Event::Checked]);
    let zero = Event::Sent(DacCode::ZERO);
    for at in (0..events.len()).filter(|&at| is_of_dac(&events[at])) {
        // A tick that sends zero, one that sends nothing, the check, and a tick that sends zero again.
        assert_eq!(events[at - 3..at], [zero, Event::Disabled, Event::Disabled]);
        assert_eq!(events[at + 1..at + 3], [zero, Event::Disabled]);
    }
    assert!(!events.contains(&Event::Kicked), "the board is active, and has no finger yet");
}

#[test]
fn a_dac_that_loses_its_configuration_is_not_driven() {
    for (before, found_by) in [(State::Disarmed, Event::Prepared), (State::Armed, Event::Checked)] {
        let mut board = Board::until(|board| board.state() == before);
        board.wires.dac.set(Err(0x1234));
        board.wires.take();
        for _ in 0..100 {
            board.step_with_host();
        }
        let events = board.wires.take();
        assert_eq!(only(&events, is_of_dac), [found_by], "{before}");
        assert!(!events.contains(&Event::Kicked), "{before}");
        assert_eq!((board.state(), board.main_loop.status.fault), (State::Faulted, Some((Fault::Dac, 0x1234))));
    }
}

#[test]
fn a_debugger_stops_the_watchdog_of_a_disarmed_board_only() {
    let may_stop = |events: &[Event]| only(events, |event| matches!(event, Event::DebuggerMayStop(_)));
    let mut board = Board::new();
    board.step();
    assert_eq!(may_stop(&board.wires.take()).last(), Some(&Event::DebuggerMayStop(true)));
    // The turn that takes the order passes it on: no status in between shows that the board will be armed.
    let mut board = Board::until(|board| board.wires.events.borrow().is_empty());
    board.receive(Command::Arm);
    board.step();
    let events = board.wires.take();
    let arms = events.iter().position(|event| *event == Event::Prepared).unwrap();
    assert_eq!(may_stop(&events[..arms]), [Event::DebuggerMayStop(true), Event::DebuggerMayStop(false)]);
    for _ in 0..100 {
        board.step();
    }
    assert_eq!(board.state(), State::Armed);
    assert!(!may_stop(&board.wires.take()).contains(&Event::DebuggerMayStop(true)));
}

#[test]
fn a_host_on_the_serial_port_is_answered() {
    let mut board = Board::new();
    board.receive(Command::Ping);
    for _ in 0..10 {
        board.step();
    }
    assert!(board.wires.received.borrow().is_empty());
    let mut decoder = Decoder::new();
    let answers = board.wires.transmitted.take().into_iter().filter(|&byte| decoder.push(byte).is_some()).count();
    assert_eq!(answers, 1);
}

#[test]
fn the_light_shows_the_state() {
    let mut board = Board::new();
    board.step();
    assert!(!board.wires.light.get());
    assert!(Board::until(|board| board.state() == State::Armed).wires.light.get());
    let mut board = Board::playing();
    assert!(board.wires.light.get());
    board.wires.ready.set(false);
    let mut changes = 0;
    for _ in 0..BOARD.tick_hz {
        let before = board.wires.light.get();
        board.step();
        changes += u32::from(board.wires.light.get() != before);
    }
    assert!((7..=9).contains(&changes), "eight changes a second: {changes}");
}

/// A failing port means that the host is gone: the host timeout ends the drive, and the watchdog is still fed.
#[test]
fn a_serial_port_that_fails_neither_stops_the_loop_nor_keeps_the_output_on() {
    let mut board = Board::playing();
    board.wires.port.set(Err(ErrorKind::Other));
    for _ in 0..BOARD.tick_hz {
        board.step();
    }
    assert_eq!(only(&board.wires.take(), |event| *event == Event::Fed).len(), BOARD.tick_hz as usize);
    board.step();
    assert!(board.wires.take().contains(&Event::Disabled));
    assert_ne!(board.state(), State::Active);
}
