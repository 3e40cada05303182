//! The parts of the firmware that are the same on every board and processor. A board's own crate contains registers and
//! wiring, and implements the traits of this one.
//!
//! - [`hardware`]: the traits, one for each part of a board;
//! - [`tick`]: the timer's interrupt;
//! - [`start`]: the assembly of tick and main loop, and the board's description;
//! - [`main_loop`]: the rest of the firmware, between ticks;
//! - [`memory`]: the memory of tick and session;
//! - [`serial`]: the port to the host, over a UART and a ring;
//! - [`optical_frame`]: a touch source of the main loop, and its transfers over I2C;
//! - [`fault`]: the end of a start after a panic or a fault, and its report in the next start;
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
