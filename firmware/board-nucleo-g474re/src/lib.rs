//! The firmware on a NUCLEO-G474RE: registers and wiring. `docs/board/hardware.md` lists the pins and the parts. RM0440
//! is the reference manual of the STM32G4, DS12288 the data sheet of the STM32G474; text in quotes after them refers to
//! headings in these documents.
//!
//! One interrupt, [`tick`], runs above everything, 40,000 times a second. Everything else runs in the main loop,
//! [`frixel_board::main_loop`]: serial port, session, stores, optical frame, watchdog. The lock-free queues of
//! `heapless` connect the two; no critical section masks the tick ([`critical`]). This repository's CI runs none of it
//! on hardware. The code that can be tested without hardware is in `firmware/board`, `firmware/control`,
//! `firmware/session` and `firmware/drivers`.
#![no_std]

pub mod adc;
pub mod board;
pub mod clock;
pub mod critical;
pub mod dac;
mod dma;
pub mod fault;
pub mod flash;
pub mod indicator;
#[cfg(feature = "optical-frame")]
pub mod optical_frame;
pub mod output;
pub mod period;
pub mod pins;
pub mod serial;
pub mod start;
pub mod tick;
pub mod watchdog;

/// Largest number of polls until a part of the processor is ready; more than a tenth of a second.
const ROUNDS_MAX: u32 = 5_000_000;

/// Waits until a part of the processor is ready. If it never is, this panics, which sets the output to zero and
/// resets.
pub(crate) fn wait_until(ready: impl Fn() -> bool, what: &str) {
    assert!((0..ROUNDS_MAX).any(|_| ready()), "timed out: {what}");
}
