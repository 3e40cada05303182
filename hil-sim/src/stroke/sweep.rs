//! A person exploring a texture.

use super::straight::minimum_jerk;
use super::{FingerState, StrokeError};
use crate::error::above_zero;

/// Mean speed of a stroke, in m/s, in the middle of the range in which people slide over textures. The peak speed is
/// 188 mm/s, and the friction lag was measured up to 100 mm/s.
const PACE_M_PER_S: f64 = 0.1;
/// Margin at each edge of the screen, as a share of its size.
const MARGIN: f64 = 0.1;
/// Steepest slope of a stroke: about 10 degrees.
const SLOPE_MAX: f64 = 0.18;
/// Largest number of strokes in a sweep from top to bottom, reached only on a screen thousands of times higher than
/// wide.
const SWEEP_STROKES_MAX: f64 = 10_000.0;

/// Back and forth across the screen, and slowly down and up again.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sweep {
    left_m: f64,
    top_m: f64,
    /// Length of a stroke along x.
    x_step_m: f64,
    /// Length of a stroke along y.
    y_step_m: f64,
    /// Strokes from the top of the screen to its bottom.
    sweep_strokes: u32,
    stroke_s: f64,
    mean_speed_m_per_s: f64,
}

impl Sweep {
    pub(super) fn new(screen_width_m: f64, screen_height_m: f64, duration_s: f64) -> Result<Self, StrokeError> {
        let screen_width_m = above_zero("screen width in m", screen_width_m)?;
        let screen_height_m = above_zero("screen height in m", screen_height_m)?;
        let duration_s = above_zero("duration_s", duration_s)?;
        let reach = 1.0 - 2.0 * MARGIN;
        let (width_m, height_m) = (reach * screen_width_m, reach * screen_height_m);
        let sweep_strokes = libm::ceil(height_m / (SLOPE_MAX * width_m)).min(SWEEP_STROKES_MAX);
        let y_step_m = height_m / sweep_strokes;
        let length_m = above_zero("length of a stroke in m", libm::hypot(width_m, y_step_m))?;
        let paced_strokes = duration_s * PACE_M_PER_S / length_m;
        let strokes = libm::round(paced_strokes).max(1.0);
        let share = paced_strokes.min(1.0);
        let stroke_s = duration_s / strokes;
        Ok(Self {
            left_m: MARGIN * screen_width_m,
            top_m: MARGIN * screen_height_m,
            x_step_m: share * width_m,
            y_step_m: share * y_step_m,
            sweep_strokes: sweep_strokes as u32,
            stroke_s,
            mean_speed_m_per_s: share * length_m / stroke_s,
        })
    }

    /// Returns the finger at a time from 0 to the duration. At the duration it rests at the start of the next stroke.
    pub(super) fn at(&self, t_s: f64) -> FingerState {
        let done = t_s / self.stroke_s;
        let stroke = done as u32;
        let (progress, rate) = minimum_jerk(done - f64::from(stroke));
        let to_the_right = stroke.is_multiple_of(2);
        let step_in_sweep = stroke % self.sweep_strokes;
        let downwards = (stroke / self.sweep_strokes).is_multiple_of(2);
        let along = |forward: bool, progress: f64| if forward { progress } else { 1.0 - progress };
        let down = f64::from(step_in_sweep) + progress;
        let rows_down = if downwards { down } else { f64::from(self.sweep_strokes) - down };
        FingerState {
            x_m: self.left_m + along(to_the_right, progress) * self.x_step_m,
            y_m: self.top_m + rows_down * self.y_step_m,
            speed_m_per_s: rate * self.mean_speed_m_per_s,
        }
    }
}
