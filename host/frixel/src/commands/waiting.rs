//! Messages about a board that takes long to answer.

use std::time::Duration;

use frixel_driver::{Device, Link, Waiting};
use frixel_play::break_if;

use super::interrupt::Interrupt;
use super::terminal::note;

/// Delay after which the command prints what it waits for. A working board answers within milliseconds.
const NOTE_AFTER: Duration = Duration::from_secs(2);

/// Prints on standard error what a long call to `device` waits for, and breaks it off when the command should end.
pub(super) fn watch<L: Link>(mut device: Device<L>, interrupt: &Interrupt) -> Device<L> {
    let interrupt = interrupt.clone();
    let mut said = None;
    device.while_waiting(move |waiting| {
        let Waiting { command, waited, waited_max } = *waiting;
        if waited < NOTE_AFTER {
            said = None;
        } else if said.replace(command) != Some(command) {
            note(format_args!(
                "frixel: the board has not answered for {} s (waiting for: {command}; timeout: {} s)",
                waited.as_secs(),
                waited_max.as_secs()
            ));
        }
        break_if(interrupt.is_requested() && waiting.may_break_off())
    });
    device
}
