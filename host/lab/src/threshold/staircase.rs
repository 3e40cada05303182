//! The staircase: an adaptive choice of levels, by what all answers so far say about the threshold.

use core::ops::RangeInclusive;

/// Probability of a wrong answer without any attention, which moves both ends of the curve.
const LAPSE: f64 = 0.02;
/// Steepness of Weibull's curve in a logarithmic level: 3.5, the usual value (Watson and Pelli 1983,
/// doi:10.3758/BF03202828), for levels of amplitude.
const STEEPNESS: f64 = 3.5;
/// Levels that are considered, in decibels below the largest that the board can play.
const LEVELS_DB: RangeInclusive<i32> = -60..=0;
/// Steps of a decibel.
const STEPS_PER_DB: i32 = 4;
/// Where thresholds are expected before the first answer, in decibels: mean and standard deviation (assumed, and wide:
/// a tenth of the largest amplitude, by a factor of three either way).
const EXPECTED_DB: (f64, f64) = (-20.0, 10.0);
/// A trial is this far above the expected threshold, in decibels, where an answer of two alternatives says most.
const ABOVE_DB: f64 = 1.5;
/// Numbers of trials that a threshold can rest on.
const TRIALS: RangeInclusive<usize> = 12..=40;

/// Probability of a right answer at a level, for a person with this threshold: one half by guessing, and three
/// quarters at the threshold, less the lapses.
pub(super) fn psychometric(level_db: f64, threshold_db: f64) -> f64 {
    // Weibull's curve at the threshold is ln 2, so that half of what is not guessed is found.
    let ratio = libm::pow(10.0, STEEPNESS * (level_db - threshold_db) / 20.0);
    let found = -libm::expm1(-core::f64::consts::LN_2 * ratio);
    0.5 + (0.5 - LAPSE) * found
}

/// A detection threshold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Threshold {
    /// Level at the threshold, in decibels relative to the largest that the board can play.
    pub level_db: f64,
    /// Lower and upper end of its 95 % interval.
    pub interval_db: (f64, f64),
}

/// A staircase in progress: the probability of each threshold, given all answers (QUEST, Watson and Pelli 1983,
/// doi:10.3758/BF03202828).
#[derive(Clone, Debug)]
pub struct Staircase {
    /// Threshold and its probability, whose sum is one.
    thresholds: Vec<(f64, f64)>,
    trials: usize,
    trials_max: usize,
}

impl Staircase {
    /// A staircase of 12 to 40 trials; `None` for another number.
    pub fn new(trials: usize) -> Option<Self> {
        if !TRIALS.contains(&trials) {
            return None;
        }
        let steps = STEPS_PER_DB * LEVELS_DB.start()..=STEPS_PER_DB * LEVELS_DB.end();
        let expected = |threshold_db: f64| {
            let distance = (threshold_db - EXPECTED_DB.0) / EXPECTED_DB.1;
            libm::exp(-0.5 * distance * distance)
        };
        let levels = steps.map(|step| f64::from(step) / f64::from(STEPS_PER_DB));
        let thresholds = levels.map(|level_db| (level_db, expected(level_db))).collect();
        let mut staircase = Self { thresholds, trials: 0, trials_max: trials };
        staircase.normalise();
        Some(staircase)
    }

    /// The level of the next trial, in decibels relative to the largest; `None` when all trials are done.
    pub fn next_level_db(&self) -> Option<f64> {
        match self.trials {
            trials if trials >= self.trials_max => None,
            _ => Some((self.mean_db() + ABOVE_DB).min(f64::from(*LEVELS_DB.end()))),
        }
    }

    /// Number of the next trial, from one, and of all trials.
    pub fn progress(&self) -> (usize, usize) {
        (self.trials + 1, self.trials_max)
    }

    /// Takes in whether the answer at a level was right.
    pub fn answer(&mut self, level_db: f64, is_right: bool) {
        let likelihood = |threshold_db| {
            let right = psychometric(level_db, threshold_db);
            if is_right { right } else { 1.0 - right }
        };
        for (threshold_db, probability) in &mut self.thresholds {
            *probability *= likelihood(*threshold_db);
        }
        self.normalise();
        self.trials += 1;
    }

    fn normalise(&mut self) {
        let sum: f64 = self.thresholds.iter().map(|(_, probability)| probability).sum();
        for (_, probability) in &mut self.thresholds {
            *probability /= sum;
        }
    }

    /// The threshold, by all answers so far.
    pub fn threshold(&self) -> Threshold {
        Threshold { level_db: self.mean_db(), interval_db: (self.quantile_db(0.025), self.quantile_db(0.975)) }
    }

    fn mean_db(&self) -> f64 {
        self.thresholds.iter().map(|(threshold_db, probability)| threshold_db * probability).sum()
    }

    fn quantile_db(&self, part: f64) -> f64 {
        let mut sum = 0.0;
        for (threshold_db, probability) in &self.thresholds {
            sum += probability;
            if sum >= part {
                return *threshold_db;
            }
        }
        f64::from(*LEVELS_DB.end())
    }
}

#[cfg(test)]
mod tests {
    use super::super::Observer;
    use super::{Staircase, Threshold, psychometric};

    const OBSERVERS: u64 = 400;

    fn run(threshold_db: f64, trials: usize, seed: u64) -> Threshold {
        let (mut staircase, mut observer) = (Staircase::new(trials).unwrap(), Observer::new(threshold_db, seed));
        while let Some(level_db) = staircase.next_level_db() {
            let is_right = observer.answers_rightly(level_db);
            staircase.answer(level_db, is_right);
        }
        staircase.threshold()
    }

    /// Root-mean-square error as a factor in force, and the share of intervals that contain the threshold, over
    /// observers
    /// with thresholds of -36 to -8 dB.
    fn errors(trials: usize) -> (f64, f64) {
        let (mut square, mut inside) = (0.0, 0);
        for seed in 0..OBSERVERS {
            let threshold_db = -36.0 + 28.0 * seed as f64 / OBSERVERS as f64;
            let found = run(threshold_db, trials, seed);
            square += (found.level_db - threshold_db).powi(2);
            inside += usize::from((found.interval_db.0..=found.interval_db.1).contains(&threshold_db));
        }
        let rms_db = (square / OBSERVERS as f64).sqrt();
        (libm::pow(10.0, rms_db / 20.0), inside as f64 / OBSERVERS as f64)
    }

    #[test]
    fn twelve_trials_find_a_threshold_to_a_factor_and_forty_to_a_fifth() {
        let (few, few_inside) = errors(12);
        let (many, many_inside) = errors(40);
        println!("12 trials: a factor of {few:.2}, {few_inside:.3} inside; 40: {many:.2}, {many_inside:.3} inside");
        assert!(few < 1.7, "{few}");
        assert!(many < 1.25, "{many}");
        assert!((0.90..=0.99).contains(&few_inside), "{few_inside}");
        assert!((0.90..=0.99).contains(&many_inside), "{many_inside}");
    }

    #[test]
    fn an_observer_guesses_half_of_what_is_not_felt() {
        assert!((psychometric(-80.0, -20.0) - 0.5).abs() < 1e-3);
        assert!((psychometric(-20.0, -20.0) - 0.74).abs() < 1e-9);
        assert!((psychometric(0.0, -20.0) - 0.98).abs() < 1e-3);
    }

    #[test]
    fn only_twelve_to_forty_trials() {
        assert!(Staircase::new(11).is_none() && Staircase::new(41).is_none());
        let mut staircase = Staircase::new(12).unwrap();
        for trial in 1..=12 {
            assert_eq!(staircase.progress(), (trial, 12));
            staircase.answer(staircase.next_level_db().unwrap(), true);
        }
        assert_eq!(staircase.next_level_db(), None);
    }
}
