//! Motion along a straight line.

use super::{FingerState, Point, StrokeError};
use crate::error::{OutOfRange, above_zero};

/// A straight path and its duration.
#[derive(Clone, Copy, Debug)]
pub(super) struct Straight {
    from: Point,
    x_step_m: f64,
    y_step_m: f64,
    mean_speed_m_per_s: f64,
    duration_s: f64,
}

impl Straight {
    /// The path from one point to another in `duration_s` seconds.
    pub(super) fn lasting(from: Point, to: Point, duration_s: f64) -> Result<Self, StrokeError> {
        let duration_s = above_zero("duration_s", duration_s)?;
        let length_m = length_m(from, to)?;
        Ok(Self {
            from,
            x_step_m: to.x_m - from.x_m,
            y_step_m: to.y_m - from.y_m,
            mean_speed_m_per_s: length_m / duration_s,
            duration_s,
        })
    }

    /// The path from one point to another at a mean speed.
    pub(super) fn at_speed(from: Point, to: Point, speed_m_per_s: f64) -> Result<Self, StrokeError> {
        let length_m = above_zero("length of the stroke in m", length_m(from, to)?)?;
        let straight = Self::lasting(from, to, length_m / speed_m_per_s)?;
        Ok(Self { mean_speed_m_per_s: speed_m_per_s, ..straight })
    }

    pub(super) fn duration_s(&self) -> f64 {
        self.duration_s
    }

    /// The finger at a time from 0 to the duration, at constant speed.
    pub(super) fn constant_speed(&self, t_s: f64) -> FingerState {
        self.state(t_s / self.duration_s, 1.0)
    }

    /// The finger at a time from 0 to the duration, with minimum jerk.
    pub(super) fn minimum_jerk(&self, t_s: f64) -> FingerState {
        let (progress, rate) = minimum_jerk(t_s / self.duration_s);
        self.state(progress, rate)
    }

    fn state(&self, progress: f64, rate: f64) -> FingerState {
        FingerState {
            x_m: self.from.x_m + progress * self.x_step_m,
            y_m: self.from.y_m + progress * self.y_step_m,
            speed_m_per_s: rate * self.mean_speed_m_per_s,
        }
    }
}

/// Progress of a minimum-jerk motion and its rate, both over `u` from 0 to 1.
pub(super) fn minimum_jerk(u: f64) -> (f64, f64) {
    let rest = 1.0 - u;
    (u * u * u * (10.0 + u * (6.0 * u - 15.0)), 30.0 * u * u * rest * rest)
}

fn length_m(from: Point, to: Point) -> Result<f64, OutOfRange> {
    let length_m = libm::hypot(to.x_m - from.x_m, to.y_m - from.y_m);
    if length_m.is_finite() {
        Ok(length_m)
    } else {
        Err(OutOfRange { name: "length of the stroke in m", expected: "finite", found: length_m })
    }
}
