//! The tests that run firmware in an emulator.

mod emulator;
mod integer_table;
mod parity;
mod script;
