//! The start of every board: the order of its assembly, and the board's description of itself.

use frixel_board::fault::LastReset;
use frixel_board::start::{describe, prepare};
use frixel_control::Board as Description;
use frixel_session::store::{CeilingPolicy, Flash};
use frixel_wire::fault::{Fault, State};
use frixel_wire::hello::{ResetCause, notice};

use crate::support::firmware::BOARD;
use crate::support::hardware::{Event, Part, wires};
use crate::support::played::Board;

/// A flash that holds the same byte everywhere.
struct Filled(u8);

impl Flash for Filled {
    const PAGE_LEN: u32 = 2048;

    fn read(&self, _: u32, bytes: &mut [u8]) -> bool {
        bytes.fill(self.0);
        true
    }
}

fn described(flash: Option<&Filled>) -> Description {
    let last_reset = LastReset { cause: ResetCause::Pin, fault: Some((Fault::Panic, 7)), text: b"main.rs" };
    let built_in = Description { notices: notice::OPTION_BYTES, ..BOARD };
    describe(built_in, flash, CeilingPolicy::InForce, &last_reset)
}

/// A watchdog that starts earlier would reset the board before the first tick feeds it.
#[test]
fn the_tick_starts_before_the_watchdog_and_nothing_is_driven() {
    let board = Board::new();
    assert_eq!(board.wires.take(), [Event::TickStarted, Event::WatchdogStarted]);
    assert_eq!((board.state(), board.shared.count()), (State::Disarmed, 0));
}

#[test]
fn the_dac_is_prepared_once_and_a_missing_one_is_no_fault_yet() {
    let wires = wires();
    wires.dac.set(Err(1));
    prepare(&mut Part(wires.clone()));
    assert_eq!(wires.take(), [Event::Prepared]);
}

#[test]
fn missing_or_damaged_limits_become_the_built_in_ones_and_only_damaged_ones_set_a_notice() {
    let refused = notice::OPTION_BYTES | notice::STORED_LIMITS_REFUSED;
    for (flash, notices) in
        [(None, notice::OPTION_BYTES), (Some(Filled(0xff)), notice::OPTION_BYTES), (Some(Filled(0x55)), refused)]
    {
        let expected = Description {
            notices,
            reset_cause: ResetCause::Pin,
            reset_fault: Some((Fault::Panic, 7)),
            reset_text: b"main.rs",
            ..BOARD
        };
        assert_eq!(described(flash.as_ref()), expected);
    }
}
