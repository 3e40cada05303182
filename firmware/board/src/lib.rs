//! What every board does in the same way, whatever its processor. A board's own crate holds registers and wiring, and
//! implements the traits of this one.
//!
//! - [`bring_up`]: the script that takes a new board from nothing connected to stored limits.
//! - [`self_test`]: the script that measures a new board with a few wires, before there is any voltage.
#![cfg_attr(not(test), no_std)]
#![forbid(unsafe_code)]

pub mod bring_up;
mod local_host;
mod local_scene;
#[cfg(feature = "self-test")]
pub mod self_test;
