//! Checks of a play's rows, duration and stroke.

use frixel_hil_sim::Stroke;

use super::{PlayOptionsError, STROKE_MAX_S};

/// Time between two checked places of a stroke, s.
const LOOK_PERIOD_S: f64 = 1e-3;
/// Largest number of checked places of a stroke.
const LOOKS_MAX: f64 = 1e6;

/// Ticks between two rows of a record with `rows_hz` rows per second. Refuses a rate that does not divide `tick_hz`,
/// the board's ticks per second.
pub fn ticks_per_row(rows_hz: u32, tick_hz: u32) -> Result<u32, PlayOptionsError> {
    let divides = |rate: &u32| tick_hz.is_multiple_of(*rate);
    if rows_hz > 0 && divides(&rows_hz) {
        return Ok(tick_hz / rows_hz);
    }
    let below = (1..rows_hz.min(tick_hz)).rev().find(divides);
    let above = (rows_hz.max(1)..=tick_hz).find(divides);
    let nearest: Vec<String> = [below, above].iter().flatten().map(u32::to_string).collect();
    Err(PlayOptionsError::RowRate { found: rows_hz, tick_hz, nearest: nearest.join(" or ") })
}

/// Refuses a play shorter than a tick or longer than a day.
pub fn check_duration(seconds: f64, tick_hz: u32) -> Result<(), PlayOptionsError> {
    let tick_s = 1.0 / f64::from(tick_hz);
    if (tick_s..=STROKE_MAX_S).contains(&seconds) {
        Ok(())
    } else {
        Err(PlayOptionsError::Duration { seconds, tick_s })
    }
}

/// A sentence on the part of a stroke's first `seconds` that is off a screen of this width and height, in m; `None` if
/// all of it is on the screen.
///
/// # Errors
///
/// The finger is never down on the screen.
pub fn off_screen_note(stroke: &Stroke, screen_m: [f64; 2], seconds: f64) -> Result<Option<String>, PlayOptionsError> {
    let fraction = fraction_off_screen(stroke, screen_m, seconds)?;
    Ok((fraction > 0.0).then(|| {
        let [width_mm, height_mm] = screen_m.map(side_mm);
        let percent = (100.0 * fraction).max(0.1);
        format!("the finger is off the screen ({width_mm} by {height_mm} mm) for {percent:.1} % of the stroke")
    }))
}

/// Fraction of the first `seconds` of a stroke for which the finger is off a screen of this width and height, in m.
///
/// From 0 to 1. Fails if the finger is never down on the screen.
pub(super) fn fraction_off_screen(
    stroke: &Stroke,
    [width_m, height_m]: [f64; 2],
    seconds: f64,
) -> Result<f64, PlayOptionsError> {
    let end_s = seconds.min(stroke.duration_s());
    let looks = (end_s / LOOK_PERIOD_S).ceil().clamp(1.0, LOOKS_MAX);
    let (mut on, mut off) = (0_u32, 0_u32);
    for finger in (0..=looks as u32).filter_map(|look| stroke.at(end_s * f64::from(look) / looks)) {
        if (0.0..=width_m).contains(&finger.x_m) && (0.0..=height_m).contains(&finger.y_m) {
            on += 1;
        } else {
            off += 1;
        }
    }
    match (on, off) {
        (0, 0) => Ok(0.0),
        (0, _) => Err(PlayOptionsError::OffScreen { width_mm: side_mm(width_m), height_mm: side_mm(height_m) }),
        _ => Ok(f64::from(off) / f64::from(on + off)),
    }
}

/// A side of a screen, which a program stores as f32, as its file has it: in mm, to a micrometre.
fn side_mm(side_m: f64) -> f64 {
    (1e6 * side_m).round() / 1e3
}
