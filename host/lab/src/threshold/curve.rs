//! The psychometric curve: how often a person is right at a level.

/// Weibull's curve in a logarithmic level, for two alternatives (Watson and Pelli 1983, doi:10.3758/BF03202828).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Curve {
    /// The level at which half of what is not guessed is found, in decibels.
    pub(super) threshold_db: f64,
    /// Exponent of the amplitude. The usual value is 3.5.
    pub(super) steepness: f64,
    /// Probability of a wrong answer however strong the stimulus is.
    pub(super) lapse: f64,
}

impl Curve {
    /// Probability of a right answer at a level: one half by guessing, and three quarters at the threshold, less the
    /// lapses.
    pub(super) fn right(&self, level_db: f64) -> f64 {
        let Self { threshold_db, steepness, lapse } = *self;
        // Weibull's curve at the threshold is ln 2, so that half of what is not guessed is found.
        let ratio = libm::pow(10.0, steepness * (level_db - threshold_db) / 20.0);
        let found = -libm::expm1(-core::f64::consts::LN_2 * ratio);
        0.5 + (0.5 - lapse) * found
    }

    /// Probability of an answer at a level.
    pub(super) fn probability(&self, level_db: f64, is_right: bool) -> f64 {
        let right = self.right(level_db);
        if is_right { right } else { 1.0 - right }
    }
}

#[cfg(test)]
mod tests {
    use super::Curve;

    #[test]
    fn an_observer_guesses_half_of_what_is_not_felt() {
        let curve = Curve { threshold_db: -20.0, steepness: 3.5, lapse: 0.02 };
        assert!((curve.right(-80.0) - 0.5).abs() < 1e-3);
        assert!((curve.right(-20.0) - 0.74).abs() < 1e-9);
        assert!((curve.right(0.0) - 0.98).abs() < 1e-3);
        assert!((curve.probability(-20.0, false) - 0.26).abs() < 1e-9);
    }
}
