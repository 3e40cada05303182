//! The emulated board: the firmware's image for `qemu-system-arm -M mps2-an386`, and the simulator around it.
//!
//! - [`Image::build`] builds the image when it is not there yet.
//! - [`replay`] gives the board a [`Journal`](crate::Journal) of the in-process rig and compares all that it does, bit
//!   for bit. The board ticks when it is given a tick; nothing knows wall time.
//! - [`LinkBoard`] lets the board tick by itself, with its serial port behind a pseudo-terminal for a real host, and a
//!   [`World`](crate::World) that lives on what the board drives. Virtual time is never ahead of wall time.
//!
//! Simulator and board share the board's PSRAM, which is a file ([`frixel_exchange`] says what stands in it).

mod error;
mod image;
mod link;
mod machine;
mod memory;
mod replay;

pub use error::EmulatorError;
pub use frixel_exchange::BOARD;
pub use image::{Image, available};
pub use link::{LinkBoard, LinkRecord, Mishap};
pub use replay::{Mismatch, ReplayError, replay};
