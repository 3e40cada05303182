//! Driver library for frixel boards.
#![forbid(unsafe_code)]

pub mod metrics;
pub mod output;
pub mod scene;
pub mod wanted;
