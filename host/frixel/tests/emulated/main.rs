//! The host on a real serial port to the emulated board.
//!
//! All deadlines are in the board's virtual time; the emulator may be as slow as it likes.
#![cfg(unix)]
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test may fail")]

mod bench;
mod command;
#[path = "../../../../hil-sim/tests/emulator/mod.rs"]
mod emulator;
#[path = "../scenario_page/example.rs"]
mod example;
mod injected_faults;
mod link;
mod pico;
#[allow(dead_code, reason = "the other tests use the rest")]
#[path = "../processes/mod.rs"]
mod processes;
mod scenarios;
