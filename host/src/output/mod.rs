//! The files that a played scene leaves behind.
//!
//! - [`FeltCsv`]: `felt.csv`, row by row while the scene plays.
//! - [`Trace`]: the same rows thinned out for pictures, in bounded memory.
//! - [`write_felt_svg`]: friction and voltage over time.
//! - [`write_scene_png`]: the friction map of a program with the stroke over it.
//! - [`Report`]: the numbers, as JSON and as a short text.
//!
//! The same input gives the same bytes.

mod canvas;
mod csv;
mod felt_svg;
mod report;
pub(crate) mod scale;
mod scene_png;
#[cfg(test)]
mod tests;
mod trace;

use std::io;
use std::path::PathBuf;

use thiserror::Error;

pub use csv::{FeltCsv, FeltRow};
pub use felt_svg::write_felt_svg;
pub use report::Report;
pub use scene_png::write_scene_png;
pub use trace::Trace;

/// Why a file could not be written.
#[derive(Debug, Error)]
pub enum OutputError {
    /// The system refused it.
    #[error("{} cannot be written ({source}): check the folder and its free space", .path.display())]
    File {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// A picture could not be drawn.
    #[error("{} cannot be drawn ({reason})", .path.display())]
    Drawing {
        /// The file.
        path: PathBuf,
        /// What the drawing library said.
        reason: String,
    },
}
