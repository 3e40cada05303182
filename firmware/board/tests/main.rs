//! The tests of the crate as a whole, one program for all of them.

mod bring_up;
mod drive;
mod fault;
mod main_loop;
mod optical_frame;
mod serial;
mod start;
mod support;
mod tick;
mod whole;
