//! Strokes with the statistics of recorded people.

use core::f64::consts::TAU;

use super::rows::Rows;
use super::straight::minimum_jerk;
use super::{Point, StrokeError, StrokeRow};
use crate::error::{OutOfRange, above_zero};
use crate::random::{Purpose, Random};

/// Median speeds of about 1,300 strokes recorded on a surface-haptic tablet, m/s.
const MEDIANS_M_PER_S: [f64; 2] = [0.048, 0.436];
/// Longest stroke, s: it is stored millisecond by millisecond.
const DURATION_MAX_S: f64 = 600.0;
/// Time between two stored places, s. Between them the finger goes straight, less than 1 um beside the true path.
const ROW_S: f64 = 1e-3;
/// Margin at each edge of the screen that targets keep, as a share of its size.
const MARGIN: f64 = 0.08;
/// Part of the movements that cross the screen; the others turn somewhere on the way.
const CROSSING_SHARE: f64 = 0.7;
/// Part of the turns at which the finger pauses, and how long, s (assumed).
const PAUSE_SHARE: f64 = 0.2;
const PAUSES_S: [f64; 2] = [0.1, 0.4];
/// Largest number of minimum-jerk submovements of a movement (Flash and Henis, doi:10.1162/jocn.1991.3.3.220); each
/// starts after this part of the one before.
const SUBMOVEMENTS_MAX: usize = 3;
const SUBMOVEMENT_STEP: f64 = 0.55;
/// Spread of the durations of movements: the standard deviation of their logarithm (assumed).
const DURATION_SPREAD: f64 = 0.25;
/// Physiological tremor: its band in Hz, and its size in each axis in m rms (assumed).
const TREMOR_HZ: [f64; 2] = [8.0, 12.0];
const TREMOR_RMS_M: f64 = 0.1e-3;
/// Sines that the tremor is a sum of.
const TREMOR_SINES: usize = 3;

/// A part of the motion with minimum jerk. Those that overlap are added.
#[derive(Clone, Copy, Debug)]
struct Submovement {
    start_s: f64,
    duration_s: f64,
    x_step_m: f64,
    y_step_m: f64,
}

/// The strokes of one person on a screen.
struct Hand {
    random: Random,
    screen_m: [f64; 2],
    speed_m_per_s: f64,
    place: Point,
    /// The side of the screen that the next crossing goes to.
    goes_right: bool,
}

/// Rows of the stroke of a seed, at a median speed or, without one, at that of the seed's person.
pub(super) fn rows(
    screen_m: [f64; 2],
    duration_s: f64,
    median_speed_m_per_s: Option<f64>,
    seed: u64,
) -> Result<Rows, StrokeError> {
    let [width_m, height_m] = screen_m;
    above_zero("screen width in m", width_m)?;
    above_zero("screen height in m", height_m)?;
    if !(duration_s > ROW_S && duration_s <= DURATION_MAX_S) {
        let expected = "above 0.001 and at most 600 for a human stroke";
        return Err(OutOfRange { name: "duration_s", expected, found: duration_s }.into());
    }
    let mut random = Random::new(seed, Purpose::HumanStroke);
    let [slowest, fastest] = MEDIANS_M_PER_S;
    let drawn_m_per_s = slowest * libm::pow(fastest / slowest, random.uniform());
    let speed_m_per_s = above_zero("median speed in m/s", median_speed_m_per_s.unwrap_or(drawn_m_per_s))?;
    let tremor = [(); 2].map(|()| Tremor::drawn(&mut random));
    let place = Point { x_m: MARGIN * width_m, y_m: (0.2 + 0.6 * random.uniform()) * height_m };
    let mut hand = Hand { random, screen_m, speed_m_per_s, place, goes_right: true };
    let start = hand.place;
    // The speed of movements is scaled so that its median is the given one; half again as much motion covers it.
    let submovements = hand.moves(1.5 * duration_s + 2.0);
    let nominal = places(start, &submovements, 1.0, duration_s);
    let scale = (median_m_per_s(&nominal) / speed_m_per_s).clamp(0.5, 1.5);
    let rows: Vec<StrokeRow> = places(start, &submovements, scale, duration_s)
        .into_iter()
        .enumerate()
        .map(|(index, place)| {
            let t_s = ROW_S * index as f64;
            let [x, y] = &tremor;
            let place = Some(Point { x_m: place.x_m + x.at(t_s), y_m: place.y_m + y.at(t_s) });
            StrokeRow { t_s, place, normal_load_n: None }
        })
        .collect();
    Rows::new(&rows).ok_or_else(|| {
        OutOfRange { name: "median speed in m/s", expected: "a speed of a finger", found: speed_m_per_s }.into()
    })
}

/// Places every [`ROW_S`], with all times of the motion multiplied by `scale`.
fn places(start: Point, submovements: &[Submovement], scale: f64, duration_s: f64) -> Vec<Point> {
    let count = libm::round(duration_s / ROW_S) as usize;
    // Submovements are in the order of their starts, and only a few overlap.
    let (mut done, mut place) = (0, start);
    (0..=count)
        .map(|index| {
            let t_s = ROW_S * index as f64 / scale;
            while let Some(ended) = submovements.get(done).filter(|ended| ended.start_s + ended.duration_s <= t_s) {
                place = Point { x_m: place.x_m + ended.x_step_m, y_m: place.y_m + ended.y_step_m };
                done += 1;
            }
            let under_way = submovements.iter().skip(done).take_while(|submovement| submovement.start_s < t_s);
            under_way.fold(place, |place, submovement| {
                let (progress, _) = minimum_jerk(((t_s - submovement.start_s) / submovement.duration_s).min(1.0));
                Point {
                    x_m: place.x_m + progress * submovement.x_step_m,
                    y_m: place.y_m + progress * submovement.y_step_m,
                }
            })
        })
        .collect()
}

fn median_m_per_s(places: &[Point]) -> f64 {
    let mut speeds: Vec<f64> = places
        .windows(2)
        .filter_map(|pair| match pair {
            [from, to] => Some(libm::hypot(to.x_m - from.x_m, to.y_m - from.y_m) / ROW_S),
            _ => None,
        })
        .collect();
    speeds.sort_by(f64::total_cmp);
    speeds.get(speeds.len() / 2).copied().unwrap_or_default()
}

impl Hand {
    /// The submovements of at least `seconds` seconds, in the order of their starts.
    fn moves(&mut self, seconds: f64) -> Vec<Submovement> {
        let mut submovements = Vec::new();
        let mut start_s = 0.0;
        while start_s < seconds {
            start_s = self.movement(start_s, &mut submovements);
            if self.random.uniform() < PAUSE_SHARE {
                let [shortest_s, longest_s] = PAUSES_S;
                start_s += shortest_s + (longest_s - shortest_s) * self.random.uniform();
            }
        }
        submovements
    }

    /// Appends the submovements of one movement, and returns its end.
    fn movement(&mut self, start_s: f64, submovements: &mut Vec<Submovement>) -> f64 {
        let target = self.target();
        let (x_m, y_m) = (target.x_m - self.place.x_m, target.y_m - self.place.y_m);
        self.place = target;
        let count = 1 + (self.random.uniform() * SUBMOVEMENTS_MAX as f64) as usize;
        let parts: Vec<f64> = (0..count).map(|_| 0.5 + self.random.uniform()).collect();
        let sum: f64 = parts.iter().sum();
        // The whole takes as long as its length at the hand's speed; its parts overlap.
        let whole_s = libm::hypot(x_m, y_m) / self.speed_m_per_s * libm::exp(DURATION_SPREAD * self.random.gaussian());
        let duration_s = (whole_s / (1.0 + SUBMOVEMENT_STEP * (count - 1) as f64)).max(ROW_S);
        for (index, part) in parts.iter().enumerate() {
            submovements.push(Submovement {
                start_s: start_s + SUBMOVEMENT_STEP * duration_s * index as f64,
                duration_s,
                x_step_m: x_m * part / sum,
                y_step_m: y_m * part / sum,
            });
        }
        start_s + duration_s * (1.0 + SUBMOVEMENT_STEP * (count - 1) as f64)
    }

    /// Where the next movement goes: to the other side of the screen, or to a place before it.
    fn target(&mut self) -> Point {
        let [width_m, height_m] = self.screen_m;
        let crosses = self.random.uniform() < CROSSING_SHARE;
        let far = if crosses { 0.02 + 0.15 * self.random.uniform() } else { 0.2 + 0.4 * self.random.uniform() };
        let from_left = if self.goes_right { 1.0 - MARGIN - far } else { MARGIN + far };
        self.goes_right = !self.goes_right;
        // Slightly oblique.
        let y_step_m = 0.12 * width_m * (2.0 * self.random.uniform() - 1.0);
        let y_m = self.place.y_m + y_step_m;
        let (top_m, bottom_m) = (MARGIN * height_m, (1.0 - MARGIN) * height_m);
        let reflected_m = if y_m < top_m || y_m > bottom_m { self.place.y_m - y_step_m } else { y_m };
        Point { x_m: from_left * width_m, y_m: reflected_m.clamp(top_m, bottom_m) }
    }
}

/// Tremor along one axis: a few sines in its band.
#[derive(Clone, Copy, Debug)]
struct Tremor {
    /// Frequency in Hz and phase in rad.
    sines: [(f64, f64); TREMOR_SINES],
}

impl Tremor {
    fn drawn(random: &mut Random) -> Self {
        let [lowest_hz, highest_hz] = TREMOR_HZ;
        let sines = [(); TREMOR_SINES]
            .map(|()| (lowest_hz + (highest_hz - lowest_hz) * random.uniform(), TAU * random.uniform()));
        Self { sines }
    }

    fn at(&self, t_s: f64) -> f64 {
        let sum: f64 = self.sines.iter().map(|(hz, phase)| libm::sin(TAU * hz * t_s + phase)).sum();
        // Each sine has a mean square of a half.
        sum * TREMOR_RMS_M * (2.0 / TREMOR_SINES as f64).sqrt()
    }
}
