//! What several tests share. Not each of them uses all of it.
#![allow(dead_code, unreachable_pub)]

pub mod hex;
pub mod samples;
pub mod variants;
