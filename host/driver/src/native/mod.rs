//! What the operating system gives a link: serial ports, waiting, and a thread that keeps the board alive.
//!
//! The rest of the crate runs where there is none of these. The types that it must not use are in `clippy.toml`; here
//! they are what the module is for.
#![allow(clippy::disallowed_types, clippy::disallowed_methods, reason = "the one module that may use clocks and files")]

mod port_error;
mod ports;
mod serial;

pub use port_error::PortError;
pub use ports::{PortInfo, UsbDevice, ports};
pub use serial::{DEFAULT_BAUD, SerialLink};
