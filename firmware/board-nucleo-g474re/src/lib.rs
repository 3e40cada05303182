//! The firmware on a NUCLEO-G474RE: registers and wiring. `docs/hardware.md` has the pins and the parts; RM0440 is
//! the reference manual of the STM32G4, DS12288 the data sheet of the STM32G474, and what stands in quotes behind them are
//! headings there.
//!
//! One interrupt, [`tick`], runs above everything, 40,000 times a second. All else is the main loop, [`main_loop`]: serial
//! port, session, stores, optical frame, watchdog. Between them go the lock-free queues of `heapless`; no critical section
//! masks the tick ([`critical`]). None of it has run on hardware in this repository's CI: what can be tested without is in
//! `firmware/control`, `firmware/session` and `firmware/drivers`.
#![no_std]

pub mod adc;
pub mod arming;
pub mod board;
pub mod clock;
pub mod critical;
pub mod dac;
mod dma;
pub mod fault;
pub mod flash;
pub mod guard;
pub mod indicator;
pub mod main_loop;
#[cfg(feature = "optical-frame")]
pub mod optical_frame;
pub mod output;
mod owned;
pub mod period;
pub mod pins;
pub mod serial;
pub mod tick;
pub mod watchdog;

/// Polls that a part of the processor may take to become ready; more than a tenth of a second.
const ROUNDS_MAX: u32 = 5_000_000;

/// Waits until a part of the processor is ready. When it never is, the panic that says so puts the output to zero and
/// resets.
pub(crate) fn wait_until(ready: impl Fn() -> bool, what: &str) {
    let mut poll = limited_polls(what);
    while !ready() {
        poll();
    }
}

/// To be called in every round of a loop that waits. The panic after the last round puts the output to zero and resets.
pub(crate) fn limited_polls(what: &str) -> impl FnMut() {
    let mut rounds = 0;
    move || {
        rounds += 1;
        assert!(rounds < ROUNDS_MAX, "waited in vain for {what}");
    }
}
