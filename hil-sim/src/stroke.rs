//! Strokes: the place of the finger over time.

mod human;
mod rows;
mod straight;
mod sweep;

use thiserror::Error;

use crate::error::{OutOfRange, above_zero, zero_to_ten};
use human::Reconstruction;
pub use human::{HUMAN_STROKE_MAX_S, HUMAN_TEST_SEEDS};
use rows::Rows;
use straight::Straight;
use sweep::Sweep;

/// A number in the description of a stroke is out of range.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("stroke: {0}")]
pub struct StrokeError(#[from] OutOfRange);

/// A place on the screen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// From the left edge of the screen, m.
    pub x_m: f64,
    /// From the top edge of the screen, m.
    pub y_m: f64,
}

/// Place and sliding speed of a finger on the screen.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FingerState {
    /// From the left edge of the screen, m.
    pub x_m: f64,
    /// From the top edge of the screen, m.
    pub y_m: f64,
    /// Sliding speed, regardless of direction, m/s.
    pub speed_m_per_s: f64,
}

/// A point in time of a stroke.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StrokeRow {
    /// Time from the start of the stroke, s.
    pub t_s: f64,
    /// Place of the finger; `None` while it is off the screen.
    pub place: Option<Point>,
    /// Normal load, N; `None` if unknown.
    pub normal_load_n: Option<f64>,
}

/// Motion of a finger over the screen. The finger is up before the start and after the end.
///
/// ```
/// use frixel_hil_sim::{Point, Stroke};
///
/// let from = Point { x_m: 0.01, y_m: 0.03 };
/// let to = Point { x_m: 0.09, y_m: 0.03 };
/// let stroke = Stroke::minimum_jerk(from, to, 0.8)?;
/// let middle = stroke.at(0.4).ok_or("the finger is on the screen")?;
/// assert!((middle.x_m - 0.05).abs() < 1e-12);
/// assert!((middle.speed_m_per_s - 1.875 * 0.08 / 0.8).abs() < 1e-12);
/// assert!(stroke.at(0.9).is_none());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Stroke {
    path: Path,
    /// Time at which the finger leaves the screen, s.
    end_s: f64,
    /// Period of a looped stroke, s.
    round_s: Option<f64>,
}

#[derive(Clone, Debug)]
enum Path {
    ConstantSpeed(Straight),
    MinimumJerk(Straight),
    Sweep(Sweep),
    Rows(Rows),
}

impl Stroke {
    /// A straight stroke at a constant speed above 0, in m/s.
    pub fn constant_speed(from: Point, to: Point, speed_m_per_s: f64) -> Result<Self, StrokeError> {
        let speed_m_per_s = above_zero("speed_m_per_s", speed_m_per_s)?;
        let straight = Straight::at_speed(from, to, speed_m_per_s)?;
        Ok(Self::once(straight.duration_s(), Path::ConstantSpeed(straight)))
    }

    /// A straight stroke of minimum jerk (Flash and Hogan, doi:10.1523/JNEUROSCI.05-07-01688.1985), like a hand
    /// movement: at rest at both ends, and at 1.875 times the mean speed in the middle. `duration_s` is above 0.
    pub fn minimum_jerk(from: Point, to: Point, duration_s: f64) -> Result<Self, StrokeError> {
        let straight = Straight::lasting(from, to, duration_s)?;
        Ok(Self::once(straight.duration_s(), Path::MinimumJerk(straight)))
    }

    /// A resting finger for `duration_s` seconds, above 0.
    pub fn still(place: Point, duration_s: f64) -> Result<Self, StrokeError> {
        let straight = Straight::lasting(place, place, duration_s)?;
        Ok(Self::once(straight.duration_s(), Path::ConstantSpeed(straight)))
    }

    /// The stroke of a person exploring a texture: back and forth across the screen in slightly oblique strokes of
    /// minimum jerk, at about 100 mm/s on average, with the finger down for `duration_s` seconds (above 0).
    ///
    /// It stays a tenth of the screen away from every edge, and consists of whole strokes. If `duration_s` is too short
    /// for a full stroke at this speed, the stroke is shorter.
    pub fn sweep(screen_width_m: f64, screen_height_m: f64, duration_s: f64) -> Result<Self, StrokeError> {
        let sweep = Sweep::new(screen_width_m, screen_height_m, duration_s)?;
        Ok(Self::once(duration_s, Path::Sweep(sweep)))
    }

    /// Touches with the statistics of people recorded on a surface-haptic tablet, for `duration_s` seconds, 0.001 to
    /// 600. The finger lands, crosses a part of the screen with varying speed and heading, lifts, and lands again; few
    /// touches reverse on the way. The default median speed depends on the seed's person, 48 to 436 mm/s; an explicit
    /// one is above 0 and at most 10 m/s.
    ///
    /// Acceleration below 8 Hz, 95th percentile of speed, and duration of touches match those of about 1,300 recorded
    /// strokes at each median speed. The recordings cannot be shipped, and were reconstructed with smoothing
    /// ([`Self::human_rough`] uses another reconstruction). A touch ends at the margin of the screen, so fast touches
    /// on a small screen are shorter than the recorded ones. Positions are interpolated linearly between milliseconds.
    /// Tremor from 8 to 12 Hz is included, with an assumed amplitude.
    ///
    /// Tests are evaluated on [`HUMAN_TEST_SEEDS`]. [`Self::sweep`] is a deterministic stroke of any duration.
    ///
    /// ```
    /// use frixel_hil_sim::Stroke;
    ///
    /// let stroke = Stroke::human(0.12, 0.08, 10.0, Some(0.1), 1)?;
    /// assert!(stroke.at(0.2).is_some());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn human(
        screen_width_m: f64,
        screen_height_m: f64,
        duration_s: f64,
        median_speed_m_per_s: Option<f64>,
        seed: u64,
    ) -> Result<Self, StrokeError> {
        let screen_m = [screen_width_m, screen_height_m];
        let rows = human::rows(Reconstruction::Smooth, screen_m, duration_s, median_speed_m_per_s, seed)?;
        Ok(Self::once(rows.end_s(), Path::Rows(rows)))
    }

    /// Like [`Self::human`], with 2 to 5 times the acceleration, as in a reconstruction of the recorded strokes without
    /// smoothing, which includes the noise of pixels and times. The actual motion lies between the two.
    pub fn human_rough(
        screen_width_m: f64,
        screen_height_m: f64,
        duration_s: f64,
        median_speed_m_per_s: Option<f64>,
        seed: u64,
    ) -> Result<Self, StrokeError> {
        let screen_m = [screen_width_m, screen_height_m];
        let rows = human::rows(Reconstruction::Rough, screen_m, duration_s, median_speed_m_per_s, seed)?;
        Ok(Self::once(rows.end_s(), Path::Rows(rows)))
    }

    /// Motion through places at ascending times from 0 on; `None` is a finger off the screen. Motion between two places
    /// is straight, at constant speed.
    pub fn through(places: &[(f64, Option<Point>)]) -> Result<Self, StrokeError> {
        let row = |(t_s, place): &(f64, Option<Point>)| StrokeRow { t_s: *t_s, place: *place, normal_load_n: None };
        Self::through_rows(&places.iter().map(row).collect::<Vec<_>>())
    }

    /// Like [`Self::through`], with normal loads where they are known.
    pub fn through_rows(rows: &[StrokeRow]) -> Result<Self, StrokeError> {
        let mut before_s = -f64::MIN_POSITIVE;
        for row in rows {
            if !(row.t_s > before_s && row.t_s.is_finite()) {
                let expected = "finite, 0 or later, and rising";
                return Err(OutOfRange { name: "time of a place in s", expected, found: row.t_s }.into());
            }
            before_s = row.t_s;
        }
        let found = f64::INFINITY;
        let jump = OutOfRange { name: "speed between two places", expected: "finite", found };
        let motion = Rows::new(rows).ok_or(jump)?;
        Ok(Self::once(motion.end_s(), Path::Rows(motion)))
    }

    /// Repeats the stroke, with the finger off the screen for `pause_s` seconds (0 to 10) between rounds.
    ///
    /// Without a pause the finger jumps from the end of the stroke to its start.
    pub fn looped(self, pause_s: f64) -> Result<Self, StrokeError> {
        let round_s = self.end_s + zero_to_ten("pause_s", pause_s)?;
        Ok(Self { round_s: Some(round_s), ..self })
    }

    /// Whether the stroke states normal loads.
    pub(crate) fn has_loads(&self) -> bool {
        matches!(&self.path, Path::Rows(rows) if rows.has_loads)
    }

    /// Returns the normal load `t_s` seconds after the start of the stroke, in N; `None` if the stroke does not state
    /// it, or while the finger is off the screen.
    pub fn normal_load_n(&self, t_s: f64) -> Option<f64> {
        match &self.path {
            Path::Rows(rows) => rows.normal_load_n(self.in_round(t_s)?),
            Path::ConstantSpeed(_) | Path::MinimumJerk(_) | Path::Sweep(_) => None,
        }
    }

    /// Time since the start of the round, s; `None` while the finger is off the screen.
    fn in_round(&self, t_s: f64) -> Option<f64> {
        let t_s = match self.round_s {
            Some(round_s) if t_s >= 0.0 => (t_s - libm::trunc(t_s / round_s) * round_s).max(0.0),
            _ => t_s,
        };
        (t_s >= 0.0 && t_s <= self.end_s).then_some(t_s)
    }

    fn once(end_s: f64, path: Path) -> Self {
        Self { path, end_s, round_s: None }
    }

    /// Time from the start of the stroke until the finger leaves the screen, in seconds; infinite when looped.
    pub fn duration_s(&self) -> f64 {
        if self.round_s.is_some() { f64::INFINITY } else { self.end_s }
    }

    /// Returns the finger `t_s` seconds after the start of the stroke; `None` while it is off the screen.
    pub fn at(&self, t_s: f64) -> Option<FingerState> {
        let t_s = self.in_round(t_s)?;
        match &self.path {
            Path::ConstantSpeed(straight) => Some(straight.constant_speed(t_s)),
            Path::MinimumJerk(straight) => Some(straight.minimum_jerk(t_s)),
            Path::Sweep(sweep) => Some(sweep.at(t_s)),
            Path::Rows(rows) => rows.at(t_s),
        }
    }
}

#[cfg(test)]
mod tests;
