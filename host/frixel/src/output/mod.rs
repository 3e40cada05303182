//! Contents of the output files.
//!
//! - `FeltCsv`, `ForcesCsv` and `EventCsv`: `felt.csv`, `forces.csv` and `events.csv`, row by row while the scene
//!   plays.
//! - `Trace`: the same rows, downsampled for pictures, in bounded memory.
//! - `draw_felt_svg`: friction and voltage over time.
//! - `draw_fit_svg`: the residual plots of a fit.
//! - `draw_score_svg`: the numbers of a score that a person notices.
//! - `draw_scene_png`: the friction map of a program with the stroke over it.
//! - [`draw_preview_png`]: the friction map of a program before it is played.
//! - `FeltLog`: the log of a virtual board, which joins what its finger felt to the rows of a client.
//! - `Report`: the results of a run, as JSON and as a short text.
//!
//! Equal inputs give byte-identical files.

mod csv;
mod decimals;
mod felt_log;
mod felt_svg;
mod fit_svg;
mod map;
mod off_strip;
mod preview_png;
mod report;
mod report_text;
mod scene_png;
mod score_svg;
mod span;
#[cfg(test)]
mod tests;
mod trace;

use frixel_chart::{Chart, DrawError};
use frixel_scene::printable_lines;
use thiserror::Error;

pub(crate) use csv::{EventCsv, EventRow, FeltCsv, ForcesCsv};
pub(crate) use felt_log::FeltLog;
pub(crate) use felt_svg::draw_felt_svg;
pub(crate) use fit_svg::draw_fit_svg;
pub use preview_png::draw_preview_png;
pub(crate) use report::{Effects, Report, WorldReport, is_of_interrupted_play};
pub(crate) use report_text::draft_line;
pub(crate) use scene_png::draw_scene_png;
pub(crate) use score_svg::draw_score_svg;
pub(crate) use span::TracedLayer;
pub(crate) use trace::Trace;

/// The subject of a picture, from which its title is made.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Subject {
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

/// Why a picture could not be drawn.
#[derive(Debug, Error)]
#[error("a picture cannot be drawn ({0})")]
pub struct DrawingError(#[from] DrawError);

/// A chart as an SVG document; its texts may be names that a scene gives, which can have control characters.
fn svg(chart: &Chart) -> Result<String, DrawingError> {
    Ok(printable_lines(&chart.svg()?).into_owned())
}
