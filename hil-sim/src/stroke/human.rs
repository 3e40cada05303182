//! Human strokes: touches with the statistics of recorded ones.
//!
//! A person lands, crosses a part of the screen, and lifts. The speed of a touch varies around a minimum-jerk profile,
//! and the heading around its mean. Recorded strokes were reconstructed in two ways, which bracket the actual motion:
//! [`Reconstruction::Smooth`] and [`Reconstruction::Rough`].

use core::f64::consts::TAU;
use core::ops::RangeInclusive;

use super::rows::Rows;
use super::straight::minimum_jerk;
use super::{Point, StrokeError, StrokeRow};
use crate::error::{OutOfRange, above_zero};
use crate::random::{Purpose, Random};

/// Seeds of [`Stroke::human`](super::Stroke::human) and [`Stroke::human_rough`](super::Stroke::human_rough) for
/// evaluation in tests and tables. Tune constants and train predictors on larger seeds.
pub const HUMAN_TEST_SEEDS: RangeInclusive<u64> = 1..=999;

/// Median speeds of about 1,300 strokes recorded on a surface-haptic tablet, m/s.
const MEDIANS_M_PER_S: [f64; 2] = [0.048, 0.436];
/// Largest median speed, m/s.
const MEDIAN_MAX_M_PER_S: f64 = 10.0;
/// Longest stroke of a person, s, since every millisecond is stored.
pub const HUMAN_STROKE_MAX_S: f64 = 600.0;
/// Time between two stored places, s. Linear interpolation deviates by less than 1 um from the true path.
const ROW_S: f64 = 1e-3;
/// Margin at each edge of the screen, as a fraction of its size, at which a touch ends.
const MARGIN: f64 = 0.05;
/// Spread of durations and median speeds of a person's touches: the standard deviation of their logarithm (assumed).
const DURATION_SPREAD: f64 = 0.2;
const SPEED_SPREAD: f64 = 0.1;
/// Largest rate of a minimum-jerk movement over its mean.
const PEAK_RATE: f64 = 1.875;
/// Speed of landing and lifting, as a fraction of the largest (assumed).
const LANDING_SHARE: f64 = 0.35;
/// Largest slope of a touch against the width of the screen, rad (assumed).
const SLOPE_MAX: f64 = 0.3;
/// Time between two touches, s (assumed).
const LIFTS_S: [f64; 2] = [0.15, 0.45];
/// Fraction of touches that reverse, duration of the reversal in s, and its time as a fraction of the touch (assumed).
const TURN_SHARE: f64 = 0.08;
const TURN_S: f64 = 0.2;
const TURNS_AT: [f64; 2] = [0.3, 0.7];
/// Band in which speed and heading vary, Hz (assumed).
const WANDER_HZ: [f64; 2] = [1.0, 6.0];
/// Additional band of [`Reconstruction::Rough`], Hz: the uppermost below 8 Hz, where the acceleration needs the least
/// speed.
const ROUGH_HZ: [f64; 2] = [5.0, 8.0];
/// Physiological tremor: its band in Hz, and its amplitude in each axis in m rms (assumed).
const TREMOR_HZ: [f64; 2] = [8.0, 12.0];
const TREMOR_RMS_M: f64 = 0.1e-3;
/// Number of sines in a random motion.
const SINES: usize = 6;
/// Steps of the bisection for a touch's median speed.
const BISECTIONS: u32 = 20;

/// Dependence of a person's touches on their median speed. The numbers are fitted to the duration, acceleration below 8
/// Hz and 95th percentile of speed of recorded strokes, which `tests.rs` states.
#[derive(Clone, Copy, Debug)]
struct TouchStatistics {
    median_m_per_s: f64,
    /// Median duration of a touch, s.
    duration_s: f64,
    /// Root mean square of the logarithm of speed around its rise and fall, and of the heading around its mean, in rad.
    wander: f64,
    /// Addition of [`Reconstruction::Rough`] to the velocity in each axis, rms, m/s.
    rough_m_per_s: f64,
}

const TOUCH_STATISTICS: [TouchStatistics; 4] = [
    TouchStatistics { median_m_per_s: 0.05, duration_s: 1.03, wander: 0.36, rough_m_per_s: 0.02 },
    TouchStatistics { median_m_per_s: 0.1, duration_s: 0.68, wander: 0.24, rough_m_per_s: 0.028 },
    TouchStatistics { median_m_per_s: 0.2, duration_s: 0.80, wander: 0.20, rough_m_per_s: 0.122 },
    TouchStatistics { median_m_per_s: 0.34, duration_s: 0.58, wander: 0.17, rough_m_per_s: 0.084 },
];

impl TouchStatistics {
    /// Statistics at a median speed: interpolated over its logarithm between table entries, constant beyond.
    fn at(median_m_per_s: f64) -> Self {
        let [first, .., last] = TOUCH_STATISTICS;
        let pairs = TOUCH_STATISTICS.iter().zip(TOUCH_STATISTICS.iter().skip(1));
        let mut between = pairs.filter(|(_, faster)| median_m_per_s < faster.median_m_per_s);
        let Some((slower, faster)) = between.next() else { return Self { median_m_per_s, ..last } };
        if median_m_per_s < first.median_m_per_s {
            return Self { median_m_per_s, ..first };
        }
        let share = libm::log(median_m_per_s / slower.median_m_per_s)
            / libm::log(faster.median_m_per_s / slower.median_m_per_s);
        let mixed = |value: fn(&Self) -> f64| value(slower) + share * (value(faster) - value(slower));
        Self {
            median_m_per_s,
            duration_s: mixed(|statistics| statistics.duration_s),
            wander: mixed(|statistics| statistics.wander),
            rough_m_per_s: mixed(|statistics| statistics.rough_m_per_s),
        }
    }
}

/// Which accelerations of recorded strokes a generated one has.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Reconstruction {
    /// Smoothed.
    Smooth,
    /// Including the noise of pixels and report times.
    Rough,
}

/// The touches of one person on a screen.
struct Person {
    random: Random,
    reconstruction: Reconstruction,
    statistics: TouchStatistics,
    /// Width and height of the screen within its margins, m.
    inner_m: [f64; 2],
    tremor: [Wave; 2],
    goes_right: bool,
}

/// Rows of a seed's stroke, at the given median speed or, by default, that of the seed's person.
pub(super) fn rows(
    reconstruction: Reconstruction,
    [width_m, height_m]: [f64; 2],
    duration_s: f64,
    median_speed_m_per_s: Option<f64>,
    seed: u64,
) -> Result<Rows, StrokeError> {
    let screen_m = [above_zero("screen width in m", width_m)?, above_zero("screen height in m", height_m)?];
    if !(duration_s > ROW_S && duration_s <= HUMAN_STROKE_MAX_S) {
        let expected = "above 0.001 and at most 600 for a human stroke";
        return Err(OutOfRange { name: "duration_s", expected, found: duration_s }.into());
    }
    let mut random = Random::new(seed, Purpose::HumanStroke);
    let [slowest, fastest] = MEDIANS_M_PER_S;
    let drawn_m_per_s = slowest * libm::pow(fastest / slowest, random.uniform());
    let found = above_zero("median speed in m/s", median_speed_m_per_s.unwrap_or(drawn_m_per_s))?;
    let too_fast = || StrokeError::from(OutOfRange { name: "median speed in m/s", expected: "at most 10", found });
    if found > MEDIAN_MAX_M_PER_S {
        return Err(too_fast());
    }
    let tremor = [(); 2].map(|()| Wave::drawn(&mut random, TREMOR_HZ));
    let inner_m = screen_m.map(|side_m| (1.0 - 2.0 * MARGIN) * side_m);
    let mut person =
        Person { random, reconstruction, statistics: TouchStatistics::at(found), inner_m, tremor, goes_right: true };
    let margin_m = screen_m.map(|side_m| MARGIN * side_m);
    Rows::new(&person.rows(margin_m, (duration_s / ROW_S) as usize)).ok_or_else(too_fast)
}

impl Person {
    /// Further rows at intervals of [`ROW_S`], or fewer where the finger is up.
    fn rows(&mut self, [left_m, top_m]: [f64; 2], count: usize) -> Vec<StrokeRow> {
        let mut rows = Vec::with_capacity(count + 1);
        let row =
            |index: usize, place: Option<Point>| StrokeRow { t_s: ROW_S * index as f64, place, normal_load_n: None };
        let mut index = 0;
        while index < count {
            for [x_m, y_m] in self.touch() {
                let [x_tremor, y_tremor] = self.tremor.map(|wave| TREMOR_RMS_M * wave.at(ROW_S * index as f64));
                let place = Point { x_m: left_m + x_m + x_tremor, y_m: top_m + y_m + y_tremor };
                rows.push(row(index, Some(place)));
                index += 1;
            }
            rows.push(row(index, None));
            index += (self.within(LIFTS_S) / ROW_S) as usize;
        }
        rows.truncate(rows.partition_point(|row| row.t_s <= ROW_S * count as f64));
        if rows.last().is_some_and(|last| last.t_s < ROW_S * (count as f64 - 0.5)) {
            rows.push(row(count, None));
        }
        rows
    }

    /// Uniform between two values.
    fn within(&mut self, [least, most]: [f64; 2]) -> f64 {
        least + (most - least) * self.random.uniform()
    }

    /// Places of the next touch, one every [`ROW_S`], within the margins.
    fn touch(&mut self) -> Vec<[f64; 2]> {
        let median_m_per_s = self.statistics.median_m_per_s * libm::exp(SPEED_SPREAD * self.random.gaussian());
        let duration_s = self.statistics.duration_s * libm::exp(DURATION_SPREAD * self.random.gaussian());
        let slope = self.within([-SLOPE_MAX, SLOPE_MAX]);
        let turns = self.random.uniform() < TURN_SHARE;
        let turn_s = self.within(TURNS_AT) * duration_s;
        let [speed, heading] = [(); 2].map(|()| Wave::drawn(&mut self.random, WANDER_HZ));
        let rough = [(); 2].map(|()| Wave::drawn(&mut self.random, ROUGH_HZ));
        let rough_m_per_s =
            if self.reconstruction == Reconstruction::Rough { self.statistics.rough_m_per_s } else { 0.0 };
        let wander = self.statistics.wander;
        let velocities = (0..(duration_s / ROW_S) as usize).map(|index| {
            let t_s = ROW_S * index as f64;
            let direction = if turns { 1.0 - 2.0 * smooth_step((t_s - turn_s) / TURN_S + 0.5) } else { 1.0 };
            let speed = direction * profile(t_s / duration_s) * libm::exp(wander * speed.at(t_s));
            let angle = slope + wander * heading.at(t_s);
            Velocity {
                of_speed: [speed * libm::cos(angle), speed * libm::sin(angle)],
                beside_m_per_s: rough.map(|wave| rough_m_per_s * wave.at(t_s)),
            }
        });
        let path = Path::of_median(&velocities.collect::<Vec<_>>(), median_m_per_s, self.inner_m);
        let goes_right = self.goes_right;
        self.goes_right = !goes_right;
        let [[x_min, x_max], [y_min, y_max]] = path.spans_m;
        let [width_m, height_m] = self.inner_m;
        let left_m = self.random.uniform() * (width_m - (x_max - x_min)) - x_min;
        let top_m = self.random.uniform() * (height_m - (y_max - y_min)) - y_min;
        let place = |[x_m, y_m]: [f64; 2]| {
            let x_m = left_m + x_m;
            [if goes_right { x_m } else { width_m - x_m }, top_m + y_m]
        };
        path.places_m.into_iter().map(place).collect()
    }
}

/// Speed of a touch over its largest, from its start at 0 to its end at 1: the minimum-jerk profile, at least
/// [`LANDING_SHARE`] at both ends.
fn profile(share: f64) -> f64 {
    let (_, rate) = minimum_jerk(share);
    LANDING_SHARE + (1.0 - LANDING_SHARE) * rate / PEAK_RATE
}

/// Rises from 0 to 1 as `share` does, with a continuous slope.
fn smooth_step(share: f64) -> f64 {
    let share = share.clamp(0.0, 1.0);
    share * share * (3.0 - 2.0 * share)
}

/// Velocity at a moment of a touch, before its speed is known.
#[derive(Clone, Copy, Debug)]
struct Velocity {
    /// The part proportional to the touch's speed.
    of_speed: [f64; 2],
    /// The other part, m/s.
    beside_m_per_s: [f64; 2],
}

impl Velocity {
    fn at_speed(&self, speed_m_per_s: f64) -> [f64; 2] {
        let [x, y] = self.of_speed;
        let [x_beside, y_beside] = self.beside_m_per_s;
        [speed_m_per_s * x + x_beside, speed_m_per_s * y + y_beside]
    }
}

/// A way from its start, with a place every [`ROW_S`].
struct Path {
    places_m: Vec<[f64; 2]>,
    /// Least and largest place along each axis.
    spans_m: [[f64; 2]; 2],
    median_m_per_s: f64,
}

impl Path {
    /// The path with a given median speed.
    fn of_median(velocities: &[Velocity], median_m_per_s: f64, inner_m: [f64; 2]) -> Self {
        // The median is above 0.3 of the largest speed, but a touch may be cut off at the edge, and start slowly.
        let (mut low, mut high) = (0.0, 8.0 * median_m_per_s);
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (low + high);
            let is_slow = Self::at_speed(velocities, middle, inner_m).median_m_per_s < median_m_per_s;
            (low, high) = if is_slow { (middle, high) } else { (low, middle) };
        }
        Self::at_speed(velocities, low, inner_m)
    }

    /// The path at a given speed, up to the edge of the screen.
    fn at_speed(velocities: &[Velocity], speed_m_per_s: f64, inner_m: [f64; 2]) -> Self {
        let (mut place_m, mut spans_m) = ([0.0_f64; 2], [[0.0_f64; 2]; 2]);
        let mut places_m = vec![place_m];
        let mut speeds_m_per_s = Vec::with_capacity(velocities.len());
        for velocity in velocities {
            let [x_m_per_s, y_m_per_s] = velocity.at_speed(speed_m_per_s);
            let [x_m, y_m] = place_m;
            place_m = [x_m + ROW_S * x_m_per_s, y_m + ROW_S * y_m_per_s];
            let mut grown_m = spans_m;
            for ([least_m, most_m], m) in grown_m.iter_mut().zip(place_m) {
                (*least_m, *most_m) = (least_m.min(m), most_m.max(m));
            }
            if grown_m.iter().zip(inner_m).any(|([least_m, most_m], side_m)| most_m - least_m > side_m) {
                break;
            }
            spans_m = grown_m;
            places_m.push(place_m);
            speeds_m_per_s.push(libm::hypot(x_m_per_s, y_m_per_s));
        }
        let middle = speeds_m_per_s.len() / 2;
        let median_m_per_s = if speeds_m_per_s.is_empty() {
            // Too fast to fit.
            f64::INFINITY
        } else {
            *speeds_m_per_s.select_nth_unstable_by(middle, f64::total_cmp).1
        };
        Self { places_m, spans_m, median_m_per_s }
    }
}

/// A random motion in a frequency band: a sum of a few sines, 1 rms in total.
#[derive(Clone, Copy, Debug)]
struct Wave {
    /// Frequency in Hz and phase in rad.
    sines: [(f64, f64); SINES],
}

impl Wave {
    fn drawn(random: &mut Random, [lowest_hz, highest_hz]: [f64; 2]) -> Self {
        let hz = |share: f64| lowest_hz * libm::pow(highest_hz / lowest_hz, share);
        Self { sines: [(); SINES].map(|()| (hz(random.uniform()), TAU * random.uniform())) }
    }

    fn at(&self, t_s: f64) -> f64 {
        let sum: f64 = self.sines.iter().map(|(hz, phase)| libm::sin(TAU * hz * t_s + phase)).sum();
        // Each sine has a mean square of a half.
        sum * (2.0 / SINES as f64).sqrt()
    }
}

#[cfg(test)]
mod tests;
