//! The staircase: an adaptive choice of levels, by what all answers so far say about the threshold.

use core::ops::RangeInclusive;

use super::curve::Curve;

/// Curves that are considered beside the threshold: how steep (3.5 is the usual value, Watson and Pelli 1983,
/// doi:10.3758/BF03202828), and how often an answer is given without attention. Nobody knows either of a person, so
/// that the interval allows for all.
const STEEPNESS: [f64; 3] = [2.3, 3.5, 5.3];
const LAPSES: [f64; 2] = [0.01, 0.03];
/// Levels that are considered, in decibels below the largest that the board can play.
const LEVELS_DB: RangeInclusive<i32> = -60..=0;
/// Steps of a decibel.
const STEPS_PER_DB: i32 = 2;
/// Where thresholds are expected before the first answer, in decibels: mean and standard deviation (assumed, and wide:
/// a tenth of the largest amplitude, by a factor of three either way).
const EXPECTED_DB: (f64, f64) = (-20.0, 10.0);
/// A trial is this far above the expected threshold, in decibels, where an answer of two alternatives says most.
const ABOVE_DB: f64 = 1.5;
/// Numbers of trials that a threshold can rest on.
const TRIALS: RangeInclusive<usize> = 12..=40;
/// How many times likelier the answers are by feeling than by guessing before they give a threshold. A guesser gets
/// that far with a probability of at most its inverse (Ville's inequality), whatever levels are chosen.
const FELT_RATIO: f64 = 1e4;
/// The same ratio at which checks end, because the person guesses.
const GUESSED_RATIO: f64 = 1e-3;
/// Of people whose thresholds are within 3 dB of the largest level, a third are told from guessers, and their intervals
/// contain the threshold in 7 of 10 cases. Their thresholds are found above this level.
const NEAR_LARGEST_DB: f64 = -8.0;
/// The most trials at the largest level after the others, which tell feeling from guessing.
const CHECKS_MAX: usize = 30;

/// A detection threshold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Threshold {
    /// Level at the threshold, in decibels relative to the largest that the board can play.
    pub level_db: f64,
    /// Lower and upper end of its 95 % interval.
    pub interval_db: (f64, f64),
}

impl Threshold {
    /// Whether it is so close to the largest level that only lucky answers give a threshold there, which make it too
    /// low.
    pub fn is_near_largest(&self) -> bool {
        self.level_db > NEAR_LARGEST_DB
    }
}

/// Answers that somebody who feels nothing could have given as well, so that they give no threshold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Guessed {
    /// Number of right answers.
    pub right: usize,
    /// Number of answers.
    pub trials: usize,
}

/// A staircase in progress: the probability of each threshold, given all answers (QUEST, Watson and Pelli 1983,
/// doi:10.3758/BF03202828).
///
/// After its trials follow checks, at the largest level: as many as it takes to tell feeling from guessing.
#[derive(Clone, Debug)]
pub struct Staircase {
    /// Curves with the probability of the answers so far, relative to that by guessing.
    curves: Vec<(Curve, f64)>,
    trials: usize,
    trials_max: usize,
    right: usize,
}

impl Staircase {
    /// A staircase of 12 to 40 trials and the checks; `None` for another number.
    pub fn new(trials: usize) -> Option<Self> {
        if !TRIALS.contains(&trials) {
            return None;
        }
        let steps = STEPS_PER_DB * LEVELS_DB.start()..=STEPS_PER_DB * LEVELS_DB.end();
        let expected = |threshold_db: f64| {
            let distance = (threshold_db - EXPECTED_DB.0) / EXPECTED_DB.1;
            libm::exp(-0.5 * distance * distance)
        };
        let mut curves = Vec::new();
        for threshold_db in steps.map(|step| f64::from(step) / f64::from(STEPS_PER_DB)) {
            for steepness in STEEPNESS {
                for lapse in LAPSES {
                    curves.push((Curve { threshold_db, steepness, lapse }, expected(threshold_db)));
                }
            }
        }
        let sum: f64 = curves.iter().map(|(_, ratio)| ratio).sum();
        for (_, ratio) in &mut curves {
            *ratio /= sum;
        }
        Some(Self { curves, trials: 0, trials_max: trials, right: 0 })
    }

    /// The level of the next trial or check, in decibels relative to the largest; `None` when all are done.
    pub fn next_level_db(&self) -> Option<f64> {
        let largest_db = f64::from(*LEVELS_DB.end());
        if self.trials < self.trials_max {
            return Some((self.mean_db() + ABOVE_DB).min(largest_db));
        }
        let is_decided = !(GUESSED_RATIO..FELT_RATIO).contains(&self.felt_ratio());
        (!is_decided && self.trials < self.trials_max + CHECKS_MAX).then_some(largest_db)
    }

    /// Number of the next trial, from one, and of all trials. A check has a number above that of all trials.
    pub fn progress(&self) -> (usize, usize) {
        (self.trials + 1, self.trials_max)
    }

    /// Takes in whether the answer at a level was right.
    pub fn answer(&mut self, level_db: f64, is_right: bool) {
        for (curve, ratio) in &mut self.curves {
            *ratio *= curve.probability(level_db, is_right) / 0.5;
        }
        self.trials += 1;
        self.right += usize::from(is_right);
    }

    /// The threshold, by all answers so far; none if they could have been guessed.
    pub fn threshold(&self) -> Result<Threshold, Guessed> {
        if self.felt_ratio() < FELT_RATIO {
            return Err(Guessed { right: self.right, trials: self.trials });
        }
        Ok(Threshold { level_db: self.mean_db(), interval_db: (self.quantile_db(0.025), self.quantile_db(0.975)) })
    }

    /// Probability of the answers by feeling, relative to that by guessing.
    fn felt_ratio(&self) -> f64 {
        self.curves.iter().map(|(_, ratio)| ratio).sum()
    }

    fn mean_db(&self) -> f64 {
        let sum: f64 = self.curves.iter().map(|(curve, ratio)| curve.threshold_db * ratio).sum();
        sum / self.felt_ratio()
    }

    fn quantile_db(&self, part: f64) -> f64 {
        let end = part * self.felt_ratio();
        let mut sum = 0.0;
        for (curve, ratio) in &self.curves {
            sum += ratio;
            if sum >= end {
                return curve.threshold_db;
            }
        }
        f64::from(*LEVELS_DB.end())
    }
}

#[cfg(test)]
mod tests {
    use super::super::Observer;
    use super::{CHECKS_MAX, Guessed, Staircase, Threshold};

    fn run(mut observer: Observer, trials: usize) -> (Result<Threshold, Guessed>, usize) {
        let mut staircase = Staircase::new(trials).unwrap();
        while let Some(level_db) = staircase.next_level_db() {
            staircase.answer(level_db, observer.answers_rightly(level_db));
        }
        (staircase.threshold(), staircase.trials - trials)
    }

    /// What became of the thresholds of many observers.
    struct Tally {
        observers: u64,
        found: usize,
        covered: usize,
        /// Root-mean-square error, as a factor in amplitude.
        factor: f64,
        half_width_db: f64,
        checks: f64,
        guessers_with_threshold: usize,
    }

    impl Tally {
        fn of(observers: u64, trials: usize) -> Self {
            let (mut found, mut covered, mut square, mut width_db, mut checks) = (0, 0, 0.0, 0.0, 0);
            for seed in 0..observers {
                let observer = Observer::drawn(seed);
                let truth_db = observer.threshold_db().unwrap();
                let (threshold, checked) = run(observer, trials);
                checks += checked;
                let Ok(Threshold { level_db, interval_db: (low_db, high_db) }) = threshold else { continue };
                found += 1;
                covered += usize::from((low_db..=high_db).contains(&truth_db));
                square += (level_db - truth_db).powi(2);
                width_db += (high_db - low_db) / 2.0;
            }
            let guessers = (0..observers).map(|seed| run(Observer::guessing(seed), trials).0);
            Self {
                observers,
                found,
                covered,
                factor: libm::pow(10.0, (square / found as f64).sqrt() / 20.0),
                half_width_db: width_db / found as f64,
                checks: checks as f64 / observers as f64,
                guessers_with_threshold: guessers.flatten().count(),
            }
        }

        fn coverage(&self) -> f64 {
            self.covered as f64 / self.found as f64
        }

        fn print(&self, trials: usize) {
            let Self { observers, found, covered, factor, half_width_db, checks, guessers_with_threshold } = self;
            println!(
                "{trials} trials and {checks:.1} checks: of {observers} observers {found} have a threshold, to a factor \
                 of {factor:.2} in amplitude; {covered} of the 95 % intervals contain it ({:.1} %), half-width \
                 {half_width_db:.1} dB; of {observers} guessers {guessers_with_threshold} have one",
                100.0 * self.coverage(),
            );
        }

        fn check(&self, factor: f64) {
            assert!(self.factor < factor, "{}", self.factor);
            assert!(self.found as f64 >= 0.98 * self.observers as f64, "{}", self.found);
            assert_eq!(self.guessers_with_threshold, 0);
        }
    }

    #[test]
    fn twelve_trials_find_a_threshold_to_a_factor_and_forty_to_a_fifth() {
        for (trials, factor) in [(12, 1.7), (24, 1.4), (40, 1.25)] {
            let tally = Tally::of(200, trials);
            tally.print(trials);
            tally.check(factor);
            // Three standard deviations of a count of 200 about 95 %.
            assert!((0.90..=0.995).contains(&tally.coverage()), "{}", tally.coverage());
        }
    }

    #[test]
    #[ignore = "half a minute: cargo xtask soak thresholds"]
    fn ninety_three_to_ninety_seven_percent_of_intervals_contain_the_threshold() {
        for (trials, factor) in [(12, 1.7), (24, 1.4), (40, 1.25)] {
            let tally = Tally::of(1_000, trials);
            tally.print(trials);
            tally.check(factor);
            assert!((0.93..=0.97).contains(&tally.coverage()), "{}", tally.coverage());
        }
    }

    /// A person who hardly feels the largest level has a threshold only after lucky answers, which make it too low.
    #[test]
    fn a_threshold_near_the_largest_level_is_told() {
        let (mut found, mut covered, mut told) = (0, 0, 0);
        for seed in 0..200_u32 {
            let truth_db = -3.0 * f64::from(seed) / 200.0;
            let (threshold, _) = run(Observer::with_threshold(seed.into(), truth_db), 24);
            let Ok(threshold) = threshold else { continue };
            let (low_db, high_db) = threshold.interval_db;
            let is_covered = (low_db..=high_db).contains(&truth_db);
            found += 1;
            covered += usize::from(is_covered);
            told += usize::from(is_covered || threshold.is_near_largest());
        }
        println!(
            "of 200 observers within 3 dB of the largest level {found} have a threshold; {covered} intervals contain it"
        );
        assert!((40..=110).contains(&found) && 10 * told >= 9 * found, "{told} of {found}");
        let near = (0..200).filter_map(|seed| run(Observer::drawn(seed), 24).0.ok()).filter(Threshold::is_near_largest);
        assert!(near.count() <= 30, "thresholds of observers are from 36 to 6 dB below the largest level");
    }

    #[test]
    fn only_twelve_to_forty_trials() {
        assert!(Staircase::new(11).is_none() && Staircase::new(41).is_none());
        let mut staircase = Staircase::new(12).unwrap();
        for trial in 1..=12 {
            assert_eq!(staircase.progress(), (trial, 12));
            staircase.answer(staircase.next_level_db().unwrap(), true);
        }
        // Twelve right answers are felt, and are not enough to exclude luck.
        assert_eq!(staircase.threshold(), Err(Guessed { right: 12, trials: 12 }));
        assert_eq!(staircase.next_level_db(), Some(0.0));
        while let Some(level_db) = staircase.next_level_db() {
            staircase.answer(level_db, true);
        }
        assert!(staircase.trials < 12 + CHECKS_MAX && staircase.threshold().is_ok());
    }
}
