//! The tests that run firmware in an emulator.
#![allow(clippy::disallowed_methods, reason = "the tests run an emulator, and ask the environment for CI")]

mod emulator;
mod integer_table;
mod parity;
mod pico;
mod script;
