//! Emulated boards and their simulator: `qemu-system-arm -M mps2-an386` with its own firmware, and the Pico's image on
//! `rp2040js`.
//!
//! - [`Image::find`] finds the image shipped with the program, or builds it if necessary.
//! - [`replay`] sends the board the inputs of a [`Journal`](crate::Journal) of the in-process rig and compares its
//!   outputs, bit for bit. The board advances only when it receives a tick; wall time has no influence.
//! - [`LinkBoard`] lets the board tick by itself, with its serial port behind a pseudo-terminal for a real host, and a
//!   [`World`](crate::World) that follows the board's output. Virtual time never runs ahead of wall time.
//! - [`PicoRig`] drives a third-party emulator in lockstep, through the levels of the board's pins.
//!
//! The simulator and the MPS2 board share the board's PSRAM as a file; [`frixel_exchange`] describes its content.

mod error;
mod harness;
mod image;
mod link;
mod machine;
mod memory;
mod pico;
mod replay;

pub use error::EmulatorError;
pub use frixel_exchange::BOARD;
pub use image::{EmulatedBoard, Image};
pub use link::{InjectedFault, LinkBoard};
pub use pico::{
    AppliedOrder, BrokenInputs, PicoBoardRig, PicoRig, Stamped, StartCause, TouchFrame, Watched, WireEvent,
};
pub use replay::{Mismatch, ReplayError, replay};
