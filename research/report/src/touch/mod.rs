//! Comparison of estimators that follow a finger from touch reports: a recording in, places and errors out.

mod filters;
mod trained;

use std::error::Error;
use std::hint::black_box;
use std::time::Instant;

use frixel_felt::fidelity::{self, Fidelity, FidelitySample};
use frixel_hil_sim::{Stroke, StrokeError, TouchConfig, TouchReport, World, WorldConfig};

pub(super) use filters::{Filter, Path, best_of_grid, methods};
pub(super) use trained::Trained;

/// Ticks a second of the recorded world. A report's time is as exact as a tick.
const TICK_HZ: u32 = 8_000;
/// Samples a second.
const SAMPLE_HZ: u32 = fidelity::SAMPLE_HZ as u32;
/// Length of a stroke, s.
const SECONDS: f64 = 8.5;
/// Swing of the texture, in N.
const SWING_N: f64 = 0.11;
/// A smoother's weights fall off over these times, in intervals between reports; the best counts.
const SMOOTHER_INTERVALS: [f64; 3] = [0.6, 1.0, 1.6];

/// Determinant of a parabola's moments over the product of its diagonal, below which there are too few samples for it.
const DETERMINANT_MIN: f64 = 1e-6;

/// A kind of touch source, with the smallest feature that it is to be good for.
#[derive(Clone, Copy)]
pub(super) struct Class {
    pub(super) rate_hz: f64,
    pub(super) latency_s: f64,
    pub(super) wavelength_m: f64,
}

/// Makes the stroke of a person, as [`Stroke::human`] does.
pub(super) type Hand = fn(f64, f64, f64, Option<f64>, u64) -> Result<Stroke, StrokeError>;

/// Touches of a finger, as a touch source reports them.
pub(super) struct Recording {
    class: Class,
    touches: Vec<Touch>,
}

/// Reports of a touch, and where the finger was.
struct Touch {
    start_s: f64,
    /// Places at [`SAMPLE_HZ`], in m.
    places_m: Vec<[f64; 2]>,
    reports: Vec<TouchReport>,
}

impl Touch {
    /// Time of the place of an index, s.
    fn time_s(&self, index: usize) -> f64 {
        self.start_s + index as f64 / f64::from(SAMPLE_HZ)
    }
}

impl Recording {
    /// Records the stroke of a person with a median speed. One report in eight is lost, one in thirty is bunched.
    pub(super) fn new(class: Class, hand: Hand, median_m_per_s: f64, seed: u64) -> Result<Self, Box<dyn Error>> {
        let touch = TouchConfig {
            rate_hz: class.rate_hz,
            latency_s: class.latency_s,
            jitter_rms_s: 0.05 / class.rate_hz,
            ..TouchConfig::REALISTIC
        };
        let stroke = hand(0.12, 0.08, SECONDS, Some(median_m_per_s), seed)?;
        let config = WorldConfig { tick_hz: TICK_HZ, touch, ..WorldConfig::IDEAL };
        let mut world = World::new(config, stroke, seed)?;
        world.start_stroke();
        let mut touches: Vec<Touch> = Vec::new();
        let mut is_down = false;
        for tick in 0..(SECONDS * f64::from(TICK_HZ)) as u32 {
            if let Some((report, touch)) = world.touch_report().zip(touches.last_mut()) {
                // The report of a finger that has left since is of no use.
                touch.reports.extend((report.sampled_s >= touch.start_s).then_some(report));
            }
            if tick.is_multiple_of(TICK_HZ / SAMPLE_HZ) {
                let finger = world.finger();
                if finger.is_some() && !is_down {
                    let start_s = f64::from(tick) / f64::from(TICK_HZ);
                    touches.push(Touch { start_s, places_m: Vec::new(), reports: Vec::new() });
                }
                is_down = finger.is_some();
                if let Some((finger, touch)) = finger.zip(touches.last_mut()) {
                    touch.places_m.push([finger.x_m, finger.y_m]);
                }
            }
            world.apply(frixel_hil_sim::Drive::default());
        }
        Ok(Self { class, touches })
    }

    /// The error of a texture that is played where `places_m` say instead of where the finger is, from the first place
    /// of each touch on.
    fn error(&self, mut places_m: impl FnMut(&Touch) -> Vec<Option<[f64; 2]>>) -> f64 {
        let texture =
            |[x_m, _]: [f64; 2]| 0.5 * SWING_N * (core::f64::consts::TAU * x_m / self.class.wavelength_m).sin();
        let mut samples = Vec::new();
        for touch in &self.touches {
            let places_m = places_m(touch);
            samples.extend(touch.places_m.iter().zip(places_m).map(|(true_m, place_m)| FidelitySample {
                speed_m_per_s: place_m.map(|_| 0.0),
                reference_n: texture(*true_m),
                felt_n: place_m.map_or(0.0, texture),
                natural_n: 0.0,
                is_driven: true,
                ..FidelitySample::default()
            }));
            samples.push(FidelitySample::default());
        }
        Fidelity::of(&samples).and_then(|fidelity| fidelity.error).unwrap_or(f64::NAN)
    }

    /// The error of a filter that sees each report when it arrives; a new one is made for each touch.
    pub(super) fn filtered_error(&self, make: impl Fn() -> Box<dyn Filter>) -> f64 {
        self.error(|touch| {
            let mut filter = make();
            let mut reports = touch.reports.iter().peekable();
            let mut path: Option<Path> = None;
            let place_m = |index| {
                let now_s = touch.time_s(index);
                while let Some(report) = reports.next_if(|report| report.arrived_s <= now_s) {
                    path = filter.take(report).or(path);
                }
                path.map(|path| path.place_m(now_s))
            };
            (0..touch.places_m.len()).map(place_m).collect()
        })
    }

    /// Shortest time that a filter takes for a report, in s.
    pub(super) fn seconds_per_report(&self, make: impl Fn() -> Box<dyn Filter>) -> f64 {
        let round = |_| {
            let mut filter = make();
            let start = Instant::now();
            for report in self.reports() {
                black_box(filter.take(black_box(report)));
            }
            start.elapsed().as_secs_f64()
        };
        (0..8).map(round).fold(f64::INFINITY, f64::min) / self.reports().count() as f64
    }

    fn reports(&self) -> impl Iterator<Item = &TouchReport> {
        self.touches.iter().flat_map(|touch| &touch.reports)
    }

    /// The error of a trained predictor.
    pub(super) fn trained_error(&self, trained: &Trained) -> f64 {
        self.error(|touch| {
            let place_m = |index| trained.place_m(&touch.reports, touch.time_s(index));
            (0..touch.places_m.len()).map(place_m).collect()
        })
    }

    /// The error of a smoother that sees all reports, later ones too: a parabola through the samples around each time.
    pub(super) fn smoothed_error(&self) -> f64 {
        let interval_s = 1.0 / self.class.rate_hz;
        let smoothed = |width_s: f64| {
            self.error(|touch| {
                let place = |index| touch.parabola_at(touch.time_s(index), width_s);
                (0..touch.places_m.len()).map(place).collect()
            })
        };
        SMOOTHER_INTERVALS.iter().map(|intervals| smoothed(intervals * interval_s)).fold(f64::INFINITY, f64::min)
    }
}

impl Touch {
    /// Value at a time of the weighted least-squares parabola through the samples; `None` with too few of them.
    fn parabola_at(&self, time_s: f64, width_s: f64) -> Option<[f64; 2]> {
        let first = self.reports.partition_point(|report| report.sampled_s < time_s - 4.0 * width_s);
        let near = self.reports.iter().skip(first).take_while(|report| report.sampled_s < time_s + 4.0 * width_s);
        // Moments of the weights, and of the places under them.
        let (mut moments, mut sums) = ([0.0; 5], [[0.0; 3]; 2]);
        for report in near {
            let u = (report.sampled_s - time_s) / width_s;
            let mut power = (-0.5 * u * u).exp();
            for (order, moment) in moments.iter_mut().enumerate() {
                *moment += power;
                for (axis, place_m) in sums.iter_mut().zip(report.place_m) {
                    if let Some(sum) = axis.get_mut(order) {
                        *sum += power * place_m;
                    }
                }
                power *= u;
            }
        }
        let [a, b, c, d, e] = moments;
        // Cramer's rule for the constant of the parabola.
        let (cofactor_0, cofactor_1, cofactor_2) = (c * e - d * d, d * c - b * e, b * d - c * c);
        let determinant = a * cofactor_0 + b * cofactor_1 + c * cofactor_2;
        let places_m = sums.map(|[s, t, u]| (s * cofactor_0 + t * cofactor_1 + u * cofactor_2) / determinant);
        (determinant > DETERMINANT_MIN * a * c * e).then_some(places_m)
    }
}
