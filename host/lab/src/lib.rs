//! Measurements on fingers and scenes: values in, values out, on any host.
//!
//! - [`calibration`]: the protocol of a calibration, and the join of what board and force sensor saw.
//! - [`fit`]: a finger's profile from such a recording.
//! - [`simulate`]: the board, world, stroke and finger of a play.
//! - [`scenario`]: what happens to a board while a scene plays, on any rig, and what has to be seen of it.
//! - [`score`]: how faithfully simulated fingers felt a scene.
//! - [`sweep`]: studies of many simulated fingers, scenes, screens and values of a scene's fields.
//! - [`input`]: how much is read of a file, by the command, the page and Python.
//! - [`model_csv`]: the contact model over rows of CSV.
//! - [`recording`]: what a play or an experiment recorded, as Parquet.
//! - [`stroke_file`]: a finger's motion from a file.
//! - [`table`]: the one reader of CSV columns.
//!
//! Files, ports, clocks and the terminal are the caller's: the `frixel` command is one.
#![forbid(unsafe_code)]

mod bootstrap;
pub mod calibration;
pub mod fit;
mod generated_stroke;
pub mod hash;
pub mod input;
pub mod model_csv;
pub mod recording;
pub mod scenario;
pub mod score;
pub mod simulate;
mod statistics;
pub mod stroke_file;
pub mod sweep;
pub mod table;

pub use generated_stroke::GeneratedStroke;
