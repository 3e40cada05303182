//! Friction noise of a sliding finger.

use crate::random::{Purpose, Random};

/// Distance between two values of the finest part, in m. At 40 mm/s it covers frequencies below 1,000 Hz.
const FINEST_M: f64 = 20e-6;
/// Number of parts; each changes over twice the distance of the previous one, the coarsest over 20 mm.
const PARTS: usize = 11;
/// Standard deviation of a part over the rms of the sum from 10 to 1,000 Hz at 40 mm/s, after the relaxation length of
/// the friction. Measured by `the_noise_has_the_power_that_was_measured`.
const PART_OVER_BAND_RMS: f64 = 0.568;

/// Noise with a 1/f power spectrum over the slid distance, from cycles of 20 mm to 40 um.
///
/// 1/f over distance is 1/f over time at every speed, with the same power in every band, and a resting finger's noise
/// is constant. The noise is a sum of random values that change at octaves of distance (Voss and Clarke,
/// doi:10.1121/1.381721), each interpolated linearly. The sum is thus linear between two values of the finest part, and
/// a tick costs one multiplication.
#[derive(Clone, Debug)]
pub(super) struct FrictionNoise {
    random: Random,
    part_sd_n: f64,
    /// Slope of every part, in N per [`FINEST_M`].
    slopes: [f64; PARTS],
    /// Next value of every part.
    targets: [f64; PARTS],
    /// Number of values of the finest part so far.
    count: u32,
    /// Distance since the last of them, as a fraction of [`FINEST_M`].
    way: f64,
    start_n: f64,
    slope_n: f64,
}

impl FrictionNoise {
    /// The noise of `seed`, with an rms of `band_rms_n` from 10 to 1,000 Hz at 40 mm/s.
    pub(super) fn new(band_rms_n: f64, seed: u64) -> Self {
        let mut noise = Self {
            random: Random::new(seed, Purpose::FrictionNoise),
            part_sd_n: PART_OVER_BAND_RMS * band_rms_n,
            slopes: [0.0; PARTS],
            targets: [0.0; PARTS],
            count: 0,
            way: 0.0,
            start_n: 0.0,
            slope_n: 0.0,
        };
        for target in &mut noise.targets {
            *target = noise.random.gaussian() * noise.part_sd_n;
        }
        noise.start_n = noise.targets.iter().sum();
        noise.turn(0);
        noise
    }

    /// Returns the noise after the finger has slid for `distance_m` more.
    pub(super) fn slide(&mut self, distance_m: f64) -> f64 {
        self.way += distance_m * (1.0 / FINEST_M);
        if self.way >= 1.0 {
            // Omit what is finer than a tick.
            self.way = (self.way - 1.0).min(1.0);
            self.start_n += self.slope_n;
            self.count = self.count.wrapping_add(1);
            self.turn(self.count);
        }
        self.start_n + self.way * self.slope_n
    }

    /// Draws a new target for each part that reaches its value at `count`.
    fn turn(&mut self, count: u32) {
        let parts = self.slopes.iter_mut().zip(&mut self.targets).enumerate();
        for (part, (slope, target)) in parts.take_while(|(part, _)| count.trailing_zeros() as usize >= *part) {
            let next = self.random.gaussian() * self.part_sd_n;
            self.slope_n -= *slope;
            *slope = (next - *target) / f64::from(1_u32 << part);
            self.slope_n += *slope;
            *target = next;
        }
        if count.trailing_zeros() as usize >= PARTS {
            // All parts have reached their values: remove the rounding errors of the sums.
            self.slope_n = self.slopes.iter().sum();
        }
    }
}
