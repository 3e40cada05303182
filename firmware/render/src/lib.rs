//! The firmware without the hardware: a session that turns bytes into scenes, and a tick that turns touch into voltage.
#![no_std]
#![forbid(unsafe_code)]

mod io;

pub use io::{Drive, Sense, Touch};
