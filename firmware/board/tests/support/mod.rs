//! Helpers shared by the tests.
#![allow(dead_code, reason = "a test uses its part")]

pub(crate) mod firmware;
pub(crate) mod hardware;
pub(crate) mod played;
