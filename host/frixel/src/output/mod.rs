//! The output files of a play.
//!
//! - [`FeltCsv`], [`ForcesCsv`] and [`EventCsv`]: `felt.csv`, `forces.csv` and `events.csv`, row by row while the scene
//!   plays.
//! - [`Trace`]: the same rows, downsampled for pictures, in bounded memory.
//! - [`write_felt_svg`]: friction and voltage over time.
//! - [`write_fit_svg`]: the residual plots of a fit.
//! - [`write_scene_png`]: the friction map of a program with the stroke over it.
//! - [`write_preview_png`]: the friction map of a program before it is played.
//! - [`FeltLog`]: the log of a virtual board, which joins what its finger felt to the rows of a client.
//! - [`Report`]: the results of a run, as JSON and as a short text.
//!
//! Equal inputs give byte-identical files.

mod csv;
mod felt_log;
mod felt_svg;
mod fit_svg;
mod map;
mod off_strip;
mod preview_png;
mod report;
mod scene_png;
#[cfg(test)]
mod tests;
mod trace;

use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

use crate::chart::Chart;

pub use csv::{CsvFile, CsvRow, EventCsv, EventRow, FeltCsv, ForcesCsv};
pub use felt_log::{FeltLog, FeltLogError};
pub use felt_svg::write_felt_svg;
pub use fit_svg::write_fit_svg;
pub use preview_png::write_preview_png;
pub use report::{Report, WorldReport, draft_line};
pub use scene_png::write_scene_png;
pub use trace::{Trace, TracedLayer};

/// The subject of a picture, from which its title is made.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Subject {
    /// Name of the scene.
    pub name: String,
    /// Whether the finger, and possibly the board as well, is simulated.
    pub simulated: bool,
    /// Whether a board refuses the scene.
    pub draft: bool,
}

impl Subject {
    /// The scene's name, marked as draft and as simulated where it is.
    pub(crate) fn title(&self) -> String {
        let mark = |is: bool, mark: &'static str| if is { mark } else { "" };
        format!("{}{}{}", self.name, mark(self.draft, ", draft"), mark(self.simulated, ", simulated"))
    }
}

/// Why a file could not be written.
#[derive(Debug, Error)]
pub enum OutputError {
    /// The operating system could not write the file.
    #[error("{} cannot be written ({source}): check the folder and its free space", .path.display())]
    File {
        /// Path of the file.
        path: PathBuf,
        /// Error of the operating system.
        source: io::Error,
    },
    /// A picture could not be drawn.
    #[error("{} cannot be drawn ({reason})", .path.display())]
    Drawing {
        /// Path of the picture.
        path: PathBuf,
        /// Error message of the drawing library.
        reason: String,
    },
}

impl OutputError {
    /// Converts an error of the drawing library, for use in `map_err`.
    fn drawing<E: ToString>(path: &Path) -> impl FnOnce(E) -> Self {
        move |error| Self::Drawing { path: path.to_owned(), reason: error.to_string() }
    }
}

/// Draws a chart into an SVG file.
pub(crate) fn write_chart(path: &Path, chart: &Chart) -> Result<(), OutputError> {
    let text = chart.svg().map_err(OutputError::drawing(path))?;
    std::fs::write(path, text).map_err(|source| OutputError::File { path: path.to_owned(), source })
}
