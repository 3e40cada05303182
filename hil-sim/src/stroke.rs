//! Strokes: the place of the finger over time.

mod error;
mod human;
mod rows;
mod straight;
mod sweep;

use crate::error::{OutOfRange, above_zero, zero_to_ten};
pub use error::StrokeError;
use human::Hand;
pub use human::{HUMAN_TEST_SEEDS, HUMAN_TUNING_SEEDS};
use rows::Rows;
use straight::Straight;
use sweep::Sweep;

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
    /// Where the finger is; `None` while it is off the screen.
    pub place: Option<Point>,
    /// Normal load, N; `None` if it is not known.
    pub normal_load_n: Option<f64>,
}

/// The motion of a finger over the screen, with the finger up before its start and after its end.
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
    /// Time from one round to the next if the stroke is looped, s.
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

    /// A straight stroke of minimum jerk (Flash and Hogan, doi:10.1523/JNEUROSCI.05-07-01688.1985): at rest at both
    /// ends, and 1.875 times the mean speed in the middle, as a hand moves. `duration_s` is above 0.
    pub fn minimum_jerk(from: Point, to: Point, duration_s: f64) -> Result<Self, StrokeError> {
        let straight = Straight::lasting(from, to, duration_s)?;
        Ok(Self::once(straight.duration_s(), Path::MinimumJerk(straight)))
    }

    /// A finger that rests at a place for `duration_s` seconds, above 0.
    pub fn still(place: Point, duration_s: f64) -> Result<Self, StrokeError> {
        let straight = Straight::lasting(place, place, duration_s)?;
        Ok(Self::once(straight.duration_s(), Path::ConstantSpeed(straight)))
    }

    /// The stroke of a person who explores a texture: back and forth across the screen in slightly oblique strokes of
    /// minimum jerk, about 100 mm/s on average, with the finger down for all of `duration_s` seconds (above 0).
    ///
    /// It keeps a tenth of the screen away from every edge, and consists of whole strokes. If `duration_s` is too
    /// short for a full stroke at this speed, the stroke is shorter.
    pub fn sweep(screen_width_m: f64, screen_height_m: f64, duration_s: f64) -> Result<Self, StrokeError> {
        let sweep = Sweep::new(screen_width_m, screen_height_m, duration_s)?;
        Ok(Self::once(duration_s, Path::Sweep(sweep)))
    }

    /// Touches with the statistics of people recorded on a surface-haptic tablet, for `duration_s` seconds, 0.001 to
    /// 600: the finger lands, crosses a part of the screen with a speed and a heading that wander, lifts, and lands
    /// again; few touches turn on the way. Without a median speed, above 0 and at most 10 m/s, the stroke has that of
    /// the seed's person, 48 to 436 mm/s.
    ///
    /// Acceleration below 8 Hz, 95th percentile of speed and duration of the touches at each median speed are those of
    /// about 1,300 strokes, whose recordings cannot be shipped, as they come out of a reconstruction that smooths
    /// ([`Self::human_rough`] has another). A touch ends at the margin of the screen, so on a small screen fast touches
    /// are shorter than the recorded ones. Between milliseconds the finger goes straight. There is tremor at 8 to 12
    /// Hz, whose size is assumed.
    ///
    /// Tests judge on [`HUMAN_TEST_SEEDS`], and constants are tuned on [`HUMAN_TUNING_SEEDS`].
    /// [`Self::sweep`] is an even stroke: it has no random part, and goes on for any time.
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
        let rows = human::rows(Hand::Smooth, screen_m, duration_s, median_speed_m_per_s, seed)?;
        Ok(Self::once(rows.end_s(), Path::Rows(rows)))
    }

    /// As [`Self::human`], with the acceleration that the recorded strokes have in a reconstruction that does not
    /// smooth, whose noise of pixels and times is in it: 2 to 5 times as much. What fingers did lies between the two.
    pub fn human_rough(
        screen_width_m: f64,
        screen_height_m: f64,
        duration_s: f64,
        median_speed_m_per_s: Option<f64>,
        seed: u64,
    ) -> Result<Self, StrokeError> {
        let screen_m = [screen_width_m, screen_height_m];
        let rows = human::rows(Hand::Rough, screen_m, duration_s, median_speed_m_per_s, seed)?;
        Ok(Self::once(rows.end_s(), Path::Rows(rows)))
    }

    /// A motion through places at times that rise from 0 or later; `None` is a finger off the screen. Between two
    /// places the finger goes straight and at constant speed.
    pub fn through(places: &[(f64, Option<Point>)]) -> Result<Self, StrokeError> {
        let row = |(t_s, place): &(f64, Option<Point>)| StrokeRow { t_s: *t_s, place: *place, normal_load_n: None };
        Self::through_rows(&places.iter().map(row).collect::<Vec<_>>())
    }

    /// As [`Self::through`], with the normal loads that are known.
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

    /// Whether the stroke says with which load the finger presses.
    pub fn has_loads(&self) -> bool {
        matches!(&self.path, Path::Rows(rows) if rows.has_loads())
    }

    /// Returns the normal load `t_s` seconds after the start of the stroke, in N; `None` if the stroke does not say it,
    /// or while the finger is off the screen.
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
