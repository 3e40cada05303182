//! Filters behind a force sensor, causal ones and those that look ahead.

use std::f64::consts::{PI, TAU};
use std::fmt;

use frixel_lab::fit::Row;

/// Rows a second of the recordings.
const ROWS_HZ: f64 = 1000.0;

/// What is done to friction and load of each stroke.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Filter {
    None,
    /// A sensor of one pole with this cutoff, in Hz.
    OnePole(f64),
    /// A causal Butterworth filter of second order.
    Butterworth(f64),
    /// The same forwards and backwards.
    Filtfilt(f64),
    /// A mean over this number of rows around each.
    Mean(usize),
    /// A parabola through this number of rows around each (Savitzky and Golay).
    SavitzkyGolay(usize),
}

impl fmt::Display for Filter {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::None => write!(formatter, "unfiltered"),
            Self::OnePole(hz) => write!(formatter, "one pole, {hz} Hz"),
            Self::Butterworth(hz) => write!(formatter, "Butterworth, {hz} Hz"),
            Self::Filtfilt(hz) => write!(formatter, "filtfilt, {hz} Hz"),
            Self::Mean(rows) => write!(formatter, "centred mean, {rows} ms"),
            Self::SavitzkyGolay(rows) => write!(formatter, "Savitzky-Golay, {rows} ms"),
        }
    }
}

impl Filter {
    /// Filters of 10 to 300 Hz, and smoothing over 3 to 75 ms.
    pub(super) fn sweep() -> Vec<Self> {
        let one_pole = [300.0, 150.0, 100.0, 60.0, 30.0, 10.0].map(Self::OnePole);
        let butterworth = [300.0, 150.0, 120.0, 80.0, 60.0, 30.0, 10.0].map(Self::Butterworth);
        let filtfilt = [300.0, 200.0, 150.0, 120.0, 100.0, 80.0, 60.0, 40.0, 20.0, 10.0].map(Self::Filtfilt);
        let mean = [3, 7, 11, 21, 51, 75].map(Self::Mean);
        let savitzky_golay = [7, 9, 11, 21, 51].map(Self::SavitzkyGolay);
        [&one_pole[..], &butterworth, &filtfilt, &mean, &savitzky_golay].concat()
    }

    /// Filters friction and load, in each stroke apart.
    pub(super) fn apply(self, rows: &[Row]) -> Vec<Row> {
        let filtered = rows.chunk_by(|one, next| one.stroke == next.stroke).flat_map(|stroke| {
            let friction_n = self.filtered(stroke.iter().map(|row| row.friction_n).collect());
            let load_n = self.filtered(stroke.iter().map(|row| row.normal_force_n).collect());
            let forces = friction_n.into_iter().zip(load_n);
            stroke
                .iter()
                .zip(forces)
                .map(|(row, (friction_n, normal_force_n))| Row { friction_n, normal_force_n, ..row.clone() })
                .collect::<Vec<_>>()
        });
        filtered.collect()
    }

    fn filtered(self, values: Vec<f64>) -> Vec<f64> {
        match self {
            Self::None => values,
            Self::OnePole(hz) => {
                let left = (-TAU * hz / ROWS_HZ).exp();
                let mut now = values[0];
                let follow = |value: f64| {
                    now = value + left * (now - value);
                    now
                };
                values.into_iter().map(follow).collect()
            }
            Self::Butterworth(hz) => butterworth(values, hz),
            Self::Filtfilt(hz) => {
                let mut back = butterworth(values, hz);
                back.reverse();
                let mut forth = butterworth(back, hz);
                forth.reverse();
                forth
            }
            Self::Mean(rows) => around(&values, rows / 2, |_| 1.0),
            Self::SavitzkyGolay(rows) => {
                let half = (rows / 2) as f64;
                around(&values, rows / 2, |place| 3.0 * half * (half + 1.0) - 1.0 - 5.0 * place * place)
            }
        }
    }
}

/// A Butterworth filter of second order that begins at rest on the first value.
fn butterworth(values: Vec<f64>, hz: f64) -> Vec<f64> {
    let k = (PI * hz / ROWS_HZ).tan();
    let norm = 1.0 / (1.0 + 2.0_f64.sqrt() * k + k * k);
    let (b, a1, a2) = (k * k * norm, 2.0 * (k * k - 1.0) * norm, (1.0 - 2.0_f64.sqrt() * k + k * k) * norm);
    let (mut x1, mut x2, mut y1, mut y2) = (values[0], values[0], values[0], values[0]);
    let follow = |x: f64| {
        let y = b * (x + 2.0 * x1 + x2) - a1 * y1 - a2 * y2;
        (x2, x1, y2, y1) = (x1, x, y1, y);
        y
    };
    values.into_iter().map(follow).collect()
}

/// Weighted means around each value.
fn around(values: &[f64], half: usize, weight: impl Fn(f64) -> f64) -> Vec<f64> {
    let at = |index: usize| {
        let from = index.saturating_sub(half);
        let near = values.iter().enumerate().skip(from).take(index + half + 1 - from);
        let (sum, weights) = near.fold((0.0, 0.0), |(sum, weights), (place, value)| {
            let weight = weight(place as f64 - index as f64);
            (sum + weight * value, weights + weight)
        });
        sum / weights
    };
    (0..values.len()).map(at).collect()
}
