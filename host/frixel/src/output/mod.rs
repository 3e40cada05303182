//! The files that a played scene leaves behind.
//!
//! - [`FeltCsv`] and [`EventCsv`]: `felt.csv` and `events.csv`, row by row while the scene plays.
//! - [`Trace`]: the same rows thinned out for pictures, in bounded memory.
//! - [`write_felt_svg`]: friction and voltage over time.
//! - [`write_scene_png`]: the friction map of a program with the stroke over it.
//! - [`write_preview_png`]: the friction map of a program before it is played.
//! - [`Report`]: the numbers, as JSON and as a short text.
//!
//! The same input gives the same bytes.

mod csv;
mod felt_svg;
mod map;
mod preview_png;
mod report;
mod scene_png;
#[cfg(test)]
mod tests;
mod trace;

use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

pub use csv::{CsvFile, CsvRow, EventCsv, EventRow, FeltCsv};
pub use felt_svg::write_felt_svg;
pub use preview_png::write_preview_png;
pub use report::Report;
pub use scene_png::write_scene_png;
pub use trace::Trace;

/// What a picture is of: its title.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Subject {
    /// The scene.
    pub name: String,
    /// The finger, or the board as well, is simulated.
    pub simulated: bool,
}

impl Subject {
    /// The scene's name; what is simulated says so.
    fn title(&self) -> String {
        if self.simulated { format!("{}, simulated", self.name) } else { self.name.clone() }
    }
}

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

impl OutputError {
    /// For `map_err` on what is drawn.
    fn drawing<E: ToString>(path: &Path) -> impl FnOnce(E) -> Self {
        move |error| Self::Drawing { path: path.to_owned(), reason: error.to_string() }
    }
}
