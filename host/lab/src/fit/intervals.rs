//! Intervals of the fitted values, from a bootstrap over strokes.

use super::contrast::StrokeMeans;
use super::error::FitError;
use super::least_squares::{Observation, Solution};
use super::search::{Replicate, Search};
use crate::bootstrap::{Draws, Estimate, Z_95};
use crate::statistics::{mean, mean_and_error, student_quantile};

/// Number of draws of the bootstrap.
pub(super) const DRAWS: usize = 499;
/// Least share of the draws that must converge.
const CONVERGED_SHARE: f64 = 0.98;
/// Parts of a recording whose natural friction is compared.
const SIXTHS: usize = 6;

/// The fit, and the fits to strokes drawn at random from the same recording.
pub(super) struct Fitted {
    pub(super) best: Replicate,
    pub(super) replicates: Vec<Replicate>,
    pub(super) draws: Draws,
}

impl Fitted {
    /// Fits the drawn strokes, starting from the best fit to all of them. Fails if too many draws do not converge.
    pub(super) fn new(
        best: Replicate,
        search: &Search<'_>,
        strokes: &[StrokeMeans],
        seed: u64,
    ) -> Result<Self, FitError> {
        let levels: Vec<_> = strokes.iter().map(|stroke| stroke.top_level).collect();
        let mut draws = Draws::new(&levels, seed);
        let fitted = (0..DRAWS).take_while(|_| (search.goes_on)().is_continue()).filter_map(|_| {
            let drawn = draws.draw().into_iter().filter_map(|index| strokes.get(index));
            let drawn: Vec<Observation> = drawn.flat_map(|stroke| &stroke.observations).copied().collect();
            search.run(&drawn, &best.contact)
        });
        let replicates: Vec<Replicate> = fitted.collect();
        Self::of_draws(best, replicates, draws)
    }

    /// The fits to [`DRAWS`] draws. Fails if too many of them did not converge.
    pub(super) fn of_draws(best: Replicate, replicates: Vec<Replicate>, draws: Draws) -> Result<Self, FitError> {
        if (replicates.len() as f64) < CONVERGED_SHARE * DRAWS as f64 {
            return Err(FitError::NotConverged);
        }
        Ok(Self { best, replicates, draws })
    }

    /// A value of the best fit, with its 95 % interval.
    pub(super) fn estimate(&self, of: impl Fn(&Replicate) -> Option<f64>) -> Result<Estimate, FitError> {
        let value = of(&self.best).ok_or(FitError::NotConverged)?;
        Ok(self.estimate_about(value, of))
    }

    /// A value, with the 95 % interval of a number of the fits.
    fn estimate_about(&self, value: f64, of: impl Fn(&Replicate) -> Option<f64>) -> Estimate {
        let mut values: Vec<f64> = self.replicates.iter().filter_map(of).collect();
        let (low, high) = self.draws.stretched_interval(&mut values, Z_95);
        Estimate { value, low: low.min(value), high: high.max(value) }
    }

    /// Electric friction at a voltage under a load, in newtons.
    ///
    /// The difference between the contact model and a law without it is a systematic error, which draws of strokes do
    /// not show. The interval covers both.
    pub(super) fn electric_friction_n(&self, voltage_v_rms: f64, normal_load_n: f64) -> Result<Estimate, FitError> {
        let of = |solution: &Solution| {
            let attraction_n = solution.attraction.attraction_n(voltage_v_rms, normal_load_n)?;
            Some(solution.friction_coefficient * attraction_n)
        };
        let by_model = self.estimate(|replicate| of(&replicate.contact))?;
        let by_power = self.estimate_about(by_model.value, |replicate| of(&replicate.power));
        Ok(Estimate { low: by_model.low.min(by_power.low), high: by_model.high.max(by_power.high), ..by_model })
    }
}

/// The interval of the friction coefficient, widened for its slow drift.
///
/// Natural friction wanders for minutes, with a power that rises towards low frequencies, so that strokes beside each
/// other are not independent. Sixths of the recording show how far it wanders: the interval is at least Student's for
/// their means.
pub(super) fn wandering(strokes: &[StrokeMeans], estimate: Estimate) -> Estimate {
    let coefficients: Vec<f64> = strokes.iter().filter_map(|stroke| stroke.natural_coefficient).collect();
    let parts: Vec<f64> =
        coefficients.chunks(coefficients.len().div_ceil(SIXTHS)).map(|part| mean(part.iter().copied())).collect();
    let (_, error) = mean_and_error(&parts);
    let room = student_quantile(Z_95, parts.len() as f64 - 1.0) * error;
    Estimate {
        low: estimate.low.min(estimate.value - room),
        high: estimate.high.max(estimate.value + room),
        ..estimate
    }
}
