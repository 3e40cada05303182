//! What every board does in the same way, whatever its processor. A board's own crate holds registers and wiring, and
//! implements the traits of this one.
//!
//! - [`hardware`]: the traits, one for each part of a board;
//! - [`tick`]: what the timer's interrupt does;
//! - [`start`]: the assembly of tick and main loop, and the board's description;
//! - [`main_loop`]: the rest of the firmware, between two ticks;
//! - [`memory`]: the memory of tick and session;
//! - [`serial`]: the port to the host, over a UART and a ring;
//! - [`optical_frame`]: a touch source of the main loop, and its transfers over I2C;
//! - [`fault`]: how a start ends after a panic or a fault, and what the next one learns of it;
//! - [`terminal`]: a person's terminal on the serial port;
//! - [`bring_up`]: the script that takes a new board from nothing connected to stored limits;
//! - [`self_test`]: the script that measures a new board with a few wires, before there is any voltage.
#![cfg_attr(not(test), no_std)]
#![forbid(unsafe_code)]

pub mod bring_up;
pub mod fault;
pub mod hardware;
mod local_host;
mod local_scene;
pub mod main_loop;
pub mod memory;
pub mod optical_frame;
#[cfg(feature = "self-test")]
pub mod self_test;
pub mod serial;
pub mod start;
pub mod terminal;
pub mod tick;
