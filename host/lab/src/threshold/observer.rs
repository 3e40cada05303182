//! A simulated person who answers like people do.

use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng, SeedableRng};

use super::staircase::psychometric;

/// An observer with a known threshold.
#[derive(Clone, Debug)]
pub struct Observer {
    threshold_db: f64,
    random: Pcg64,
}

impl Observer {
    /// An observer who finds the stimulus in three trials of four at this level.
    pub fn new(threshold_db: f64, seed: u64) -> Self {
        Self { threshold_db, random: Pcg64::seed_from_u64(seed) }
    }

    /// Whether the observer finds the stimulus of this level, in a trial of two alternatives.
    pub fn answers_rightly(&mut self, level_db: f64) -> bool {
        let uniform = (self.random.next_u64() >> 11) as f64 / (1_u64 << 53) as f64;
        uniform < psychometric(level_db, self.threshold_db)
    }
}
