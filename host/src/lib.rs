//! Driver library for frixel boards.
#![forbid(unsafe_code)]

pub mod device;
pub mod scene;
pub mod wanted;
