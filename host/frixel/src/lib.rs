//! What the `frixel` command is made of: playing, recording, pictures and reports.
#![forbid(unsafe_code)]

mod chart;
pub mod check;
pub mod model_csv;
pub mod output;
pub mod player;
pub mod report;
pub mod rigs;
pub mod scene_file;
pub mod stream;
