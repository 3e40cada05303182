//! The tests of the crate as a whole, one program for all of them.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail")]

mod bring_up;
mod drive;
mod fault;
mod main_loop;
mod optical_frame;
mod serial;
mod start;
mod support;
mod tick;
