//! Normal load of a finger, which varies although the person tries to hold it constant.

use crate::random::{Purpose, Random};

/// Update interval of the load, in s: short compared with the variation, and long compared with a tick.
const STEP_S: f64 = 1e-3;
/// Time constant of both stages that shape the variation, in s (assumed). Nearly all of it lies below 10 Hz, where the
/// friction noise begins, so that nothing is counted twice.
const WANDER_S: f64 = 0.1;
/// Smallest load as a fraction of the mean load, since a finger on the screen always presses.
const LEAST: f64 = 0.1;

/// A random variation about zero with a given standard deviation: Gaussian noise after two equal first-order
/// low-passes.
#[derive(Clone, Debug)]
pub(super) struct LoadWander {
    random: Random,
    sd_n: f64,
    step_ticks: u32,
    ticks_left: u32,
    /// Fraction of a stage's value that remains after a step.
    remainder: f64,
    /// The first stage, of unit variance.
    first: f64,
    second: f64,
    second_to_n: f64,
}

impl LoadWander {
    /// The variation of `seed`, with a standard deviation of `sd_n`.
    pub(super) fn new(sd_n: f64, tick_hz: u32, seed: u64) -> Self {
        let step_ticks = (STEP_S * f64::from(tick_hz)).max(1.0) as u32;
        let remainder = libm::exp(-f64::from(step_ticks) / (WANDER_S * f64::from(tick_hz)));
        // The second stage's variance is (1 + a^2) / (1 + a)^2 of the first one's, for the remainder a.
        let second_to_n = sd_n * (1.0 + remainder) / (1.0 + remainder * remainder).sqrt();
        let mut random = Random::new(seed, Purpose::Load);
        let first = random.gaussian();
        // Start in the steady state: the second stage is correlated with the first by 1 / (1 + a).
        let (sd, correlated) = ((1.0 + remainder * remainder).sqrt() / (1.0 + remainder), 1.0 / (1.0 + remainder));
        let second = correlated * first + (sd * sd - correlated * correlated).max(0.0).sqrt() * random.gaussian();
        Self { random, sd_n, step_ticks, ticks_left: step_ticks, remainder, first, second, second_to_n }
    }

    /// Advances one tick. Returns whether a new value of the load is due.
    pub(super) fn tick(&mut self) -> bool {
        self.ticks_left -= 1;
        let is_due = self.ticks_left == 0;
        if is_due {
            self.ticks_left = self.step_ticks;
            if self.sd_n > 0.0 {
                self.step();
            }
        }
        is_due
    }

    /// The load at this tick, varying about `mean_n`.
    pub(super) fn load_n(&self, mean_n: f64) -> f64 {
        if self.sd_n > 0.0 { (mean_n + self.second * self.second_to_n).max(LEAST * mean_n) } else { mean_n }
    }

    fn step(&mut self) {
        let a = self.remainder;
        self.first = a * self.first + (1.0 - a * a).sqrt() * self.random.gaussian();
        self.second = a * self.second + (1.0 - a) * self.first;
    }
}

#[cfg(test)]
mod tests {
    use super::LoadWander;

    /// Loads at a kilohertz.
    fn loads_n(sd_n: f64, seed: u64, seconds: usize) -> Vec<f64> {
        let mut wander = LoadWander::new(sd_n, 40_000, seed);
        (0..seconds * 1000)
            .map(|_| {
                while !wander.tick() {}
                wander.load_n(0.53)
            })
            .collect()
    }

    #[test]
    fn the_load_wanders_by_22_mn_below_10_hz() {
        let loads_n = loads_n(22e-3, 3, 600);
        let mean_n = loads_n.iter().sum::<f64>() / loads_n.len() as f64;
        let variance = |of: &[f64]| of.iter().map(|value| value * value).sum::<f64>() / of.len() as f64;
        let about: Vec<f64> = loads_n.iter().map(|load_n| load_n - mean_n).collect();
        let sd_n = variance(&about).sqrt();
        assert!((mean_n - 0.53).abs() < 2e-3, "{mean_n}");
        // 600 s hold about 2,000 independent values: a standard error of 2 %.
        assert!((sd_n / 22e-3 - 1.0).abs() < 0.08, "{sd_n}");
        // What a mean over 50 ms leaves, which has its half-power point at 9 Hz.
        let fast: Vec<f64> = about.windows(51).map(|window| window[25] - window.iter().sum::<f64>() / 51.0).collect();
        assert!(variance(&fast).sqrt() < 0.1 * sd_n, "{}", variance(&fast).sqrt());
    }

    #[test]
    fn a_wander_of_zero_leaves_the_load_and_no_load_is_below_a_tenth() {
        assert!(loads_n(0.0, 3, 1).iter().all(|load_n| load_n.to_bits() == 0.53_f64.to_bits()));
        assert!(loads_n(10.0, 3, 60).iter().all(|load_n| *load_n >= 0.053));
    }
}
