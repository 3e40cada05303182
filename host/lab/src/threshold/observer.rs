//! A simulated person who answers like people do.

use core::ops::Range;

use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng, SeedableRng};

use super::curve::Curve;

/// Thresholds of the simulated people, in decibels relative to the largest level (assumed).
const THRESHOLDS_DB: Range<f64> = -36.0..-6.0;
/// Binary logarithm of their curves' steepness: 2.3 to 5.3, around the usual 3.5 (assumed).
const STEEPNESS_LOG2: Range<f64> = 1.2..2.4;
/// How often they answer without attention (assumed).
const LAPSES: Range<f64> = 0.0..0.04;

/// An observer with a known threshold.
#[derive(Clone, Debug)]
pub struct Observer {
    /// No curve: somebody who feels nothing.
    curve: Option<Curve>,
    random: Pcg64,
}

impl Observer {
    /// The observer of a seed, whose threshold, steepness and attention differ from those of others.
    ///
    /// ```
    /// use frixel_lab::threshold::Observer;
    ///
    /// let mut observer = Observer::drawn(7);
    /// let threshold_db = observer.threshold_db().expect("a drawn observer feels");
    /// let found = (0..1_000).filter(|_| observer.answers_rightly(threshold_db)).count();
    /// assert!((690..=800).contains(&found), "three quarters, less the lapses: {found}");
    /// ```
    pub fn drawn(seed: u64) -> Self {
        let mut random = Pcg64::seed_from_u64(seed);
        let mut between = |range: Range<f64>| range.start + (range.end - range.start) * uniform(&mut random);
        let curve = Curve {
            threshold_db: between(THRESHOLDS_DB),
            steepness: libm::exp2(between(STEEPNESS_LOG2)),
            lapse: between(LAPSES),
        };
        Self { curve: Some(curve), random }
    }

    /// The observer of a seed with this threshold.
    #[cfg(test)]
    pub(super) fn with_threshold(seed: u64, threshold_db: f64) -> Self {
        let Self { curve, random } = Self::drawn(seed);
        Self { curve: curve.map(|curve| Curve { threshold_db, ..curve }), random }
    }

    /// An observer who feels nothing, and guesses.
    pub fn guessing(seed: u64) -> Self {
        Self { curve: None, random: Pcg64::seed_from_u64(seed) }
    }

    /// The level at which the observer finds half of the stimuli that are not found by guessing, in decibels relative
    /// to the largest; `None` for one who feels nothing.
    pub fn threshold_db(&self) -> Option<f64> {
        self.curve.map(|curve| curve.threshold_db)
    }

    /// Whether the observer finds the stimulus of this level, in a trial of two alternatives.
    pub fn answers_rightly(&mut self, level_db: f64) -> bool {
        let right = self.curve.map_or(0.5, |curve| curve.right(level_db));
        uniform(&mut self.random) < right
    }
}

/// A number from 0 to 1.
fn uniform(random: &mut Pcg64) -> f64 {
    (random.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
}
