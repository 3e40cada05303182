//! The parts of a link that need an operating system: serial ports, waiting, and a thread that keeps the board alive.
//!
//! The rest of the crate runs without an operating system. `clippy.toml` lists the types and methods that it must not
//! use; this module is the exception.
#![allow(clippy::disallowed_types, clippy::disallowed_methods, reason = "the one module that may use clocks and files")]

mod port_error;
mod ports;
mod serial;

pub use port_error::PortError;
pub use ports::{PortInfo, UsbDevice, ports};
pub use serial::{DEFAULT_BAUD, SerialLink};
