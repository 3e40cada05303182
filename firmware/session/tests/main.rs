//! The tests of the crate as a whole, one program for all of them.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "helpers of tests fail as tests do")]

mod credit;
mod details;
mod disabled;
mod law;
mod live;
mod loader;
mod queues;
mod session;
mod store;
mod support;
mod table_cut;
mod touch;
