//! The path of the simulated finger.

use std::io::ErrorKind;
use std::path::Path;

use frixel_hil_sim::Stroke;

use super::error::CommandError;
use super::terminal::note;

/// Duration of a generated stroke without `--seconds`, s.
const NATURAL_STROKE_S: f64 = 3.0;
/// Longest stroke from a file: one day, in s.
const FILE_STROKE_MAX_S: f64 = 86_400.0;
/// Time between two positions of a stroke that are checked, s.
const CHECK_PERIOD_S: f64 = 1e-3;
/// Largest number of positions of a stroke that are checked.
const CHECKS_MAX: f64 = 1e6;

/// The stroke from a file, or a generated natural stroke over a screen of this size.
pub(super) fn stroke(
    file: Option<&Path>,
    screen_width_m: f64,
    screen_height_m: f64,
    seconds: Option<f64>,
) -> Result<Stroke, CommandError> {
    match file {
        Some(path) => from_file(path),
        None => Stroke::natural(screen_width_m, screen_height_m, seconds.unwrap_or(NATURAL_STROKE_S))
            .map_err(CommandError::NaturalStroke),
    }
}

fn from_file(path: &Path) -> Result<Stroke, CommandError> {
    let text = std::fs::read_to_string(path).map_err(|error| match error.kind() {
        ErrorKind::InvalidData => CommandError::StrokeNotText { path: path.into() },
        _ => CommandError::reading(path)(error),
    })?;
    let stroke = Stroke::from_csv(&text).map_err(|source| CommandError::Stroke { path: path.into(), source })?;
    let seconds = stroke.duration_s();
    if seconds > FILE_STROKE_MAX_S {
        return Err(CommandError::StrokeTooLong { path: path.into(), seconds });
    }
    Ok(stroke)
}

/// Fails if the stroke from a file is never on the screen in its first `seconds`. Prints a note if it is partly off
/// the screen.
pub(super) fn check_on_screen(
    path: &Path,
    stroke: &Stroke,
    screen_width_m: f64,
    screen_height_m: f64,
    seconds: f64,
) -> Result<(), CommandError> {
    let end_s = seconds.min(stroke.duration_s());
    let checks = (end_s / CHECK_PERIOD_S).ceil().clamp(1.0, CHECKS_MAX);
    let (mut on, mut off) = (0_u32, 0_u32);
    for finger in (0..=checks as u32).filter_map(|check| stroke.at(end_s * f64::from(check) / checks)) {
        if (0.0..=screen_width_m).contains(&finger.x_m) && (0.0..=screen_height_m).contains(&finger.y_m) {
            on += 1;
        } else {
            off += 1;
        }
    }
    // The sides are stored as f32; rounding to a micrometre restores the values of the scene file.
    let in_mm = |side_m: f64| (1e6 * side_m).round() / 1e3;
    let (width_mm, height_mm) = (in_mm(screen_width_m), in_mm(screen_height_m));
    if on == 0 && off > 0 {
        return Err(CommandError::StrokeOffScreen { path: path.into(), width_mm, height_mm });
    }
    if off > 0 {
        let percent = (100.0 * f64::from(off) / f64::from(on + off)).max(0.1);
        let path = path.display();
        note(format_args!(
            "{path}: the finger is off the screen ({width_mm} by {height_mm} mm) for {percent:.1} % of the stroke"
        ));
    }
    Ok(())
}
