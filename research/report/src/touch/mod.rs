//! Comparison of estimators that follow a finger from touch reports: a recording in, places and errors out.

mod filters;
use std::error::Error;
use std::hint::black_box;
use std::time::Instant;

use frixel_felt::fidelity::{self, Fidelity, FidelitySample};
use frixel_hil_sim::{Stroke, TouchConfig, TouchReport, World, WorldConfig};

pub(super) use filters::{Filter, Path, best_of_grid, methods};

/// Ticks a second of the recorded world. A report's time is as exact as a tick.
const TICK_HZ: u32 = 8_000;
/// Samples a second.
const SAMPLE_HZ: u32 = fidelity::SAMPLE_HZ as u32;
/// Samples that are compared, and time before them.
const SAMPLES: usize = 1 << 15;
const SETTLING_S: f64 = 0.4;
/// Swing of the texture, in N.
const SWING_N: f64 = 0.11;
/// A smoother's weights fall off over these times, in intervals between reports; the best counts.
const SMOOTHER_INTERVALS: [f64; 3] = [0.6, 1.0, 1.6];

/// A kind of touch source, with the smallest feature that it is to be good for.
#[derive(Clone, Copy)]
pub(super) struct Class {
    pub(super) rate_hz: f64,
    pub(super) latency_s: f64,
    pub(super) wavelength_m: f64,
}

/// Reports of a touch source, and where the finger was.
pub(super) struct Recording {
    class: Class,
    /// Places at [`SAMPLE_HZ`], in m.
    places_m: Vec<[f64; 2]>,
    reports: Vec<TouchReport>,
}

impl Recording {
    /// Records the stroke of a person with a median speed. One report in eight is lost, one in thirty is bunched.
    pub(super) fn new(class: Class, median_m_per_s: f64, seed: u64) -> Result<Self, Box<dyn Error>> {
        let touch = TouchConfig {
            rate_hz: class.rate_hz,
            latency_s: class.latency_s,
            jitter_rms_s: 0.05 / class.rate_hz,
            step_m: 0.0,
            pause_rate_hz: 0.0,
            ..TouchConfig::REALISTIC
        };
        let seconds = SAMPLES as f64 / f64::from(SAMPLE_HZ) + SETTLING_S;
        let stroke = Stroke::human(0.12, 0.08, seconds + 0.5, Some(median_m_per_s), seed)?;
        let config = WorldConfig { tick_hz: TICK_HZ, touch, ..WorldConfig::IDEAL };
        let mut world = World::new(config, stroke, seed)?;
        world.start_stroke();
        let (mut places_m, mut reports) = (Vec::new(), Vec::new());
        for tick in 0..(seconds * f64::from(TICK_HZ)) as u32 {
            reports.extend(world.touch_report());
            if tick.is_multiple_of(TICK_HZ / SAMPLE_HZ) {
                places_m.extend(world.finger().map(|finger| [finger.x_m, finger.y_m]));
            }
            world.apply(frixel_hil_sim::Drive::default());
        }
        Ok(Self { class, places_m, reports })
    }

    /// The error of a texture that is played where `places_m` say instead of where the finger is.
    fn error(&self, places_m: &[[f64; 2]]) -> f64 {
        let texture =
            |[x_m, _]: &[f64; 2]| 0.5 * SWING_N * (core::f64::consts::TAU * x_m / self.class.wavelength_m).sin();
        let skipped = self.places_m.len().saturating_sub(SAMPLES);
        let compared = self.places_m.iter().zip(places_m).skip(skipped).map(|(true_m, place_m)| FidelitySample {
            speed_m_per_s: Some(0.0),
            reference_n: texture(true_m),
            felt_n: texture(place_m),
            natural_n: 0.0,
            is_driven: true,
            ..FidelitySample::default()
        });
        let fidelity = Fidelity::of(&compared.collect::<Vec<_>>());
        fidelity.and_then(|fidelity| fidelity.error_below_40_hz).unwrap_or(f64::NAN)
    }

    /// The error of a filter that sees each report when it arrives.
    pub(super) fn filtered_error(&self, filter: &mut dyn Filter) -> f64 {
        let mut reports = self.reports.iter().peekable();
        let mut path: Option<Path> = None;
        let places_m: Vec<[f64; 2]> = self
            .places_m
            .iter()
            .enumerate()
            .map(|(index, true_m)| {
                let now_s = index as f64 / f64::from(SAMPLE_HZ);
                while let Some(report) = reports.next_if(|report| report.arrived_s <= now_s) {
                    path = filter.take(report).or(path);
                }
                path.map_or(*true_m, |path| path.place_m(now_s))
            })
            .collect();
        self.error(&places_m)
    }

    /// Shortest time that a filter takes for a report, in s.
    pub(super) fn seconds_per_report(&self, make: impl Fn() -> Box<dyn Filter>) -> f64 {
        let round = |_| {
            let mut filter = make();
            let start = Instant::now();
            for report in &self.reports {
                black_box(filter.take(black_box(report)));
            }
            start.elapsed().as_secs_f64()
        };
        (0..8).map(round).fold(f64::INFINITY, f64::min) / self.reports.len() as f64
    }

    /// The error of a smoother that sees all reports, later ones too: a parabola through the samples around each time.
    pub(super) fn smoothed_error(&self) -> f64 {
        let interval_s = 1.0 / self.class.rate_hz;
        let smoothed = |width_s: f64| {
            let place = |index: usize| self.parabola_at(index as f64 / f64::from(SAMPLE_HZ), width_s);
            self.error(&(0..self.places_m.len()).map(place).collect::<Vec<_>>())
        };
        SMOOTHER_INTERVALS.iter().map(|intervals| smoothed(intervals * interval_s)).fold(f64::INFINITY, f64::min)
    }

    /// Value at a time of the weighted least-squares parabola through the samples.
    fn parabola_at(&self, time_s: f64, width_s: f64) -> [f64; 2] {
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
        sums.map(|[s, t, u]| (s * cofactor_0 + t * cofactor_1 + u * cofactor_2) / determinant)
    }
}
