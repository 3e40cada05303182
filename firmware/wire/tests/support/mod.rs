//! Helpers shared by several tests, not all of which use all of it.
#![allow(dead_code, unreachable_pub)]

pub mod hex;
pub mod samples;
pub mod variants;
