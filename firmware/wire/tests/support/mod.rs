//! Helpers shared by several tests, not all of which use all of it.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "helpers of tests fail as tests do")]
#![allow(dead_code, unreachable_pub)]

pub mod hex;
pub mod samples;
pub mod variants;
