//! What the judge takes of a play.

use super::rows::{Frictions, RowMaker};
use super::{FeltRow, Observation};
use crate::fidelity::{FidelitySample, SAMPLE_HZ};

/// The longest stretch of a play that is judged, s: its samples take 17 MB.
pub const JUDGED_MAX_S: f64 = 60.0;

/// The samples of a play, [`SAMPLE_HZ`] a second, up to [`JUDGED_MAX_S`].
#[derive(Debug)]
pub(super) struct JudgedSamples {
    row_maker: RowMaker,
    /// The last row in which the board reported its flags: it may report them less often.
    reported: FeltRow,
    samples: Vec<FidelitySample>,
}

impl JudgedSamples {
    pub(super) fn new(tick_hz: u32) -> Self {
        let ticks_per_row = (f64::from(tick_hz) / SAMPLE_HZ).round().max(1.0) as u32;
        Self { row_maker: RowMaker::new(tick_hz, ticks_per_row), reported: FeltRow::default(), samples: Vec::new() }
    }

    /// Adds an observation `ticks` ticks after time zero, which is `start_s` after the power-on of the board.
    pub(super) fn add(&mut self, observation: &Observation, ticks: u64, frictions: &Frictions, start_s: f64) {
        if self.samples.len() as f64 >= JUDGED_MAX_S * SAMPLE_HZ {
            return;
        }
        let Some(row) = self.row_maker.add(observation, ticks, frictions) else { return };
        if row.flags.is_some() {
            self.reported = row;
        }
        self.samples.push(FidelitySample::of_row(&FeltRow { flags: self.reported.flags, ..row }, start_s));
    }

    pub(super) fn into_samples(self) -> Vec<FidelitySample> {
        self.samples
    }
}
