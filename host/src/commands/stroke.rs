//! Where the simulated finger goes.

use std::path::Path;

use frixel_hil_sim::Stroke;

use super::error::CommandError;

/// Length of a stroke that nobody asked to be longer or shorter, in s.
const NATURAL_STROKE_S: f64 = 3.0;

/// The stroke of a file, or a natural one over a screen of these sides.
pub(super) fn stroke(
    file: Option<&Path>,
    screen_width_m: f64,
    screen_height_m: f64,
    seconds: Option<f64>,
) -> Result<Stroke, CommandError> {
    match file {
        Some(path) => {
            let text = std::fs::read_to_string(path).map_err(CommandError::reading(path))?;
            Stroke::from_csv(&text).map_err(|source| CommandError::Stroke { path: path.into(), source })
        }
        None => Stroke::natural(screen_width_m, screen_height_m, seconds.unwrap_or(NATURAL_STROKE_S))
            .map_err(CommandError::NaturalStroke),
    }
}
