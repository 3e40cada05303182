//! The firmware on a Raspberry Pi Pico 2 (RP2350) or Pico (RP2040): registers and wiring. `docs/board/hardware.md`
//! lists the pins and the parts. Numbers and headings after "RP2040" and "RP2350" refer to the data sheets of the two
//! chips; where only one is cited, the other agrees.
//!
//! The Pico 2 is the board. The RP2040 has no floating-point unit, so the Pico reaches a fifth of the tick rate. It is
//! supported because an emulator runs its image in this repository's CI. One source serves both. The differences are in
//! [`chip`], [`clock`], [`boot`] and the unique number.
//!
//! One interrupt, [`tick`], runs above everything. Everything else runs in the main loop, except the interrupt that
//! stores received bytes ([`serial`]). Code that is independent of the chip is in `firmware/board`.
//!
//! | part | use |
//! |---|---|
//! | PIO 0 | the beat of the tick, and the frames of the DAC on it ([`period`], [`dac`]) |
//! | PIO 1 | the one-shot of the output ([`output`]) |
//! | PWM 0 | counts the cycles of the period ([`period`]) |
//! | ADC | the amplifier's monitor ([`adc`]) |
//! | UART 0 | the host ([`serial`]) |
//! | I2C 0 | the optical frame, with the feature `optical-frame` |
//!
//! No DMA and no second core are used.
#![no_std]

pub mod adc;
pub mod board;
pub mod boot;
pub mod chip;
pub mod clock;
pub mod critical;
pub mod dac;
pub mod fault;
pub mod flash;
pub mod indicator;
#[cfg(feature = "optical-frame")]
pub mod optical_frame;
pub mod output;
pub mod period;
pub mod pins;
mod pio;
#[cfg(feature = "rp2040")]
mod rom;
pub mod serial;
pub mod tick;
mod unique_number;
pub mod watchdog;

/// Largest number of polls until a part of the processor is ready; more than 20 ms.
const ROUNDS_MAX: u32 = 1_000_000;

/// Waits until a part of the processor is ready. If it never is, this panics, which sets the output to zero and
/// resets.
pub(crate) fn wait_until(ready: impl Fn() -> bool, what: &str) {
    assert!((0..ROUNDS_MAX).any(|_| ready()), "timed out: {what}");
}
