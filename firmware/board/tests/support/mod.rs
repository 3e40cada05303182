//! What the tests of bring-up share.
#![allow(dead_code, reason = "a test uses its part")]

pub(crate) mod firmware;
pub(crate) mod person;
