//! Fidelity goal of a texture on human strokes, and the mean of several strokes to compare with it.

use super::Fidelity;

/// The required fidelity of a texture, including start and end of a touch. The simulator's tests enforce it, and
/// `docs/design/touch.md` lists touch sources, speeds and textures that reach it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Goal {
    /// Largest [`FidelityMean::error`].
    pub error_max: f64,
    /// Least [`FidelityMean::correlation`].
    pub correlation_min: f64,
    /// Largest [`FidelityMean::spurious_over_noise_db`], dB.
    pub spurious_over_noise_max_db: f64,
}

impl Goal {
    /// For a median speed of 50 or 100 mm/s.
    pub const SLOW: Self = Self { error_max: 0.25, correlation_min: 0.9, spurious_over_noise_max_db: 6.0 };
    /// For a median speed of 200 mm/s.
    pub const FAST: Self = Self { error_max: 0.35, ..Self::SLOW };

    /// Whether the strokes meet the goal.
    pub fn is_met_by(&self, mean: &FidelityMean) -> bool {
        mean.error <= self.error_max
            && mean.correlation >= self.correlation_min
            && mean.spurious_over_noise_db <= self.spurious_over_noise_max_db
    }
}

/// Fidelity on several strokes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FidelityMean {
    /// Root mean square of [`Fidelity::error`].
    pub error: f64,
    /// Mean of [`Fidelity::correlation`].
    pub correlation: f64,
    /// Root mean square of [`Fidelity::spurious_40_to_400_hz_n`], N.
    pub spurious_40_to_400_hz_n: f64,
    /// Mean power of [`Fidelity::spurious_over_noise_db`], dB; a stroke without a gain adds none.
    pub spurious_over_noise_db: f64,
}

impl FidelityMean {
    /// The mean of these strokes; `None` without strokes, or if the reference of a stroke has no perceptible changes.
    pub fn of(strokes: &[Fidelity]) -> Option<Self> {
        if strokes.is_empty() {
            return None;
        }
        let mean = |value: fn(&Fidelity) -> Option<f64>| {
            let sum = strokes.iter().map(value).sum::<Option<f64>>()?;
            Some(sum / strokes.len() as f64)
        };
        let power = |stroke: &Fidelity| stroke.spurious_over_noise_db.map_or(0.0, |db| libm::pow(10.0, 0.1 * db));
        Some(Self {
            error: mean(|stroke| stroke.error.map(|error| error * error))?.sqrt(),
            correlation: mean(|stroke| stroke.correlation)?,
            spurious_40_to_400_hz_n: mean(|stroke| Some(stroke.spurious_40_to_400_hz_n.powi(2)))?.sqrt(),
            spurious_over_noise_db: super::decibels(strokes.iter().map(power).sum::<f64>() / strokes.len() as f64),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stroke(error: f64, correlation: f64, spurious_over_noise_db: Option<f64>) -> Fidelity {
        let (error, correlation) = (Some(error), Some(correlation));
        Fidelity { error, correlation, spurious_40_to_400_hz_n: 1e-3, spurious_over_noise_db, ..Fidelity::default() }
    }

    #[test]
    fn a_mean_is_held_against_the_goal() {
        let mean = FidelityMean::of(&[stroke(0.3, 0.96, Some(3.0)), stroke(0.1, 0.9, None)]).unwrap();
        assert!((mean.error - 0.05_f64.sqrt()).abs() < 1e-12 && (mean.correlation - 0.93).abs() < 1e-12, "{mean:?}");
        assert!((mean.spurious_40_to_400_hz_n - 1e-3).abs() < 1e-12, "{mean:?}");
        // Half the power of 3 dB.
        assert!((mean.spurious_over_noise_db + 0.0103).abs() < 1e-4, "{mean:?}");
        assert!(Goal::SLOW.is_met_by(&mean));
        let worse = [
            FidelityMean { error: 0.26, ..mean },
            FidelityMean { correlation: 0.89, ..mean },
            FidelityMean { spurious_over_noise_db: 6.1, ..mean },
        ];
        assert!(worse.iter().all(|mean| !Goal::SLOW.is_met_by(mean)));
        assert!(Goal::FAST.is_met_by(&worse[0]));
    }

    #[test]
    fn what_cannot_be_scored_has_no_mean() {
        assert_eq!(FidelityMean::of(&[]), None);
        assert_eq!(FidelityMean::of(&[stroke(0.1, 0.9, None), Fidelity::default()]), None);
    }
}
