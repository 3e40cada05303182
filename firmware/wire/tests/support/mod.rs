//! Helpers shared by several tests.
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "helpers of tests fail as tests do")]
#![allow(dead_code, unreachable_pub)]

pub mod hex;
pub mod samples;
pub mod variants;
