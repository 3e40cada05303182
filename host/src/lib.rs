//! Driver library for frixel boards.
#![forbid(unsafe_code)]

pub mod scene;
pub mod wanted;
