//! The unmodified image of the Pico, on a third-party emulator (`hil-sim/pico`).
#![cfg(unix)]
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail")]

mod bench;
mod broken_parts;
mod endings;
mod frame;
mod parity;
mod play;
mod twin;
