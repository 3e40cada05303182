//! The library behind the `frixel` command: playing scenes, recording them, drawing charts and writing reports.
#![forbid(unsafe_code)]

pub mod chart;
mod default_stroke;
pub mod input;
pub mod output;
pub mod output_file;
pub mod player;
pub mod rehearsal;
pub mod report;
pub mod rigs;
pub mod scene_file;
pub mod score;
pub mod stream;
pub mod studio;

pub use default_stroke::default_stroke;
