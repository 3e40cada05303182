//! The tests of the crate as a whole, one program for all of them: the samples of all kinds of layers, and the bytes of
//! scenes that they make.

mod golden;
mod parsers;
mod samples;
mod scene;
mod support;
