//! The samples of a play, for the judge.

use frixel_wire::fault::Flags;

use super::rows::{Frictions, RowMaker};
use super::{FeltRow, Observation};
use crate::fidelity::{FidelitySample, SAMPLE_HZ, ticks_per_sample};

/// Longest judged part of a play, s: its samples take 17 MB.
pub const JUDGED_MAX_S: f64 = 60.0;

/// The samples of a play at [`SAMPLE_HZ`], up to [`JUDGED_MAX_S`].
#[derive(Debug)]
pub(super) struct JudgedSamples {
    row_maker: RowMaker,
    /// The last reported flags, which may be older than the sample.
    flags: Option<Flags>,
    samples: Vec<FidelitySample>,
}

impl JudgedSamples {
    pub(super) fn new(tick_hz: u32) -> Self {
        Self { row_maker: RowMaker::new(tick_hz, ticks_per_sample(tick_hz)), flags: None, samples: Vec::new() }
    }

    /// Adds an observation `ticks` ticks after time zero, which is `start_s` after the board's power-on.
    pub(super) fn add(&mut self, observation: &Observation, ticks: u64, frictions: &Frictions, start_s: f64) {
        if self.samples.len() as f64 >= JUDGED_MAX_S * SAMPLE_HZ {
            return;
        }
        let Some(row) = self.row_maker.add(observation, ticks, frictions) else { return };
        self.flags = row.flags.or(self.flags);
        self.samples.push(FidelitySample::of_row(&FeltRow { flags: self.flags, ..row }, start_s));
    }

    pub(super) fn into_samples(self) -> Vec<FidelitySample> {
        self.samples
    }
}
