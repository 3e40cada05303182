//! The tests of the crate as a whole, one program for all of them.

mod bounds;
mod cost;
mod golden;
mod grid;
mod parsers;
mod protocol_ranges;
mod scene;
mod support;
