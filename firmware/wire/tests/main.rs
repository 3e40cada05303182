//! The tests of the crate as a whole, one program for all of them.

mod frames;
mod golden;
mod hello;
mod parsers;
mod protocol;
mod sentences;
mod support;
