//! Driver library for frixel boards.
#![forbid(unsafe_code)]

pub mod check;
pub mod model_csv;
pub mod output;
pub mod player;
pub mod report;
pub mod rigs;
pub mod scene_file;
pub mod stream;
