//! Spatial resolution of a fingertip: averages changes along a way.

use std::ops::Range;

use super::moment::{Moment, ways_m};
use super::thresholds::FINGERTIP_M;

/// Longest averaging time, in moments on either side: 50 ms, half a period at 10 Hz.
const SIDE_MAX: usize = 100;

/// For each moment of a run, the moments within half the fingertip's resolution.
pub(super) struct Fingertip {
    windows: Vec<Range<usize>>,
}

impl Fingertip {
    pub(super) fn of(run: &[Moment]) -> Self {
        let ways_m: Vec<f64> = ways_m(run.iter()).collect();
        let (mut start, mut end) = (0, 0);
        let window = |(number, way_m): (usize, &f64)| {
            while ways_m.get(start).is_some_and(|other_m| way_m - other_m > 0.5 * FINGERTIP_M) {
                start += 1;
            }
            while ways_m.get(end).is_some_and(|other_m| other_m - way_m <= 0.5 * FINGERTIP_M) {
                end += 1;
            }
            start.max(number.saturating_sub(SIDE_MAX))..end.min(number + SIDE_MAX + 1)
        };
        Self { windows: ways_m.iter().enumerate().map(window).collect() }
    }

    /// Averages the values of a range over the fingertip's resolution, within the range.
    pub(super) fn smoothed(&self, values: &[f64], range: Range<usize>) -> Vec<f64> {
        let sums = running_sums(values);
        let mean = |window: &Range<usize>| {
            let (from, to) = (window.start.max(range.start), window.end.min(range.end));
            let [from_sum, to_sum] = [from, to].map(|number| sums.get(number).copied().unwrap_or_default());
            (to_sum - from_sum) / to.saturating_sub(from).max(1) as f64
        };
        self.windows.get(range.clone()).unwrap_or_default().iter().map(mean).collect()
    }
}

/// The sums of the first values, from none to all.
pub(super) fn running_sums(values: &[f64]) -> Vec<f64> {
    let sums = values.iter().scan(0.0, |sum, value| {
        *sum += value;
        Some(*sum)
    });
    std::iter::once(0.0).chain(sums).collect()
}
