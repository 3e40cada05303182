//! Random numbers from a seed, one stream for each purpose.

use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng, SeedableRng};

/// The purpose of a stream of random numbers. Each purpose has its own stream, so that a new use does not change the
/// others.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Purpose {
    ReportPhase = 1,
    PlaceNoise = 2,
    ReportJitter = 3,
    Load = 5,
    FrictionNoise = 6,
    LostReports = 7,
    Person = 8,
    HumanStroke = 9,
    LineNoise = 10,
}

/// A stream of random numbers.
#[derive(Clone, Debug)]
pub(crate) struct Random {
    generator: Pcg64,
    /// The polar method produces two Gaussian numbers at a time; this is the second.
    spare: Option<f64>,
}

impl Random {
    /// The stream of `seed` for `purpose`.
    pub(crate) fn new(seed: u64, purpose: Purpose) -> Self {
        // The generator hashes its seed, so neighbouring numbers give unrelated streams. The odd factor (2^64 over the
        // golden ratio) keeps small seeds of one purpose away from those of another.
        let seed = seed ^ (purpose as u64).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        Self { generator: Pcg64::seed_from_u64(seed), spare: None }
    }

    /// Uniform over `0 <= u < 1`, in steps of 2^-53.
    pub(crate) fn uniform(&mut self) -> f64 {
        const STEP: f64 = 1.0 / (1_u64 << 53) as f64;
        (self.generator.next_u64() >> 11) as f64 * STEP
    }

    /// Gaussian with mean 0 and standard deviation 1 (Marsaglia's polar method, doi:10.1137/1006063).
    pub(crate) fn gaussian(&mut self) -> f64 {
        if let Some(spare) = self.spare.take() {
            return spare;
        }
        loop {
            let (u, v) = (2.0 * self.uniform() - 1.0, 2.0 * self.uniform() - 1.0);
            let square = u * u + v * v;
            if square > 0.0 && square < 1.0 {
                let scale = (-2.0 * libm::log(square) / square).sqrt();
                self.spare = Some(v * scale);
                return u * scale;
            }
        }
    }

    /// Gaussian as in [`gaussian`](Self::gaussian), redrawn while it is farther than `limit > 0` from 0.
    pub(crate) fn gaussian_within(&mut self, limit: f64) -> f64 {
        loop {
            let draw = self.gaussian();
            if draw.abs() <= limit {
                return draw;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{Purpose, Random};

    #[test]
    fn a_bounded_draw_stays_inside() {
        let mut random = Random::new(3, Purpose::ReportJitter);
        assert!((0..250_000).all(|_| random.gaussian_within(1.5).abs() <= 1.5));
    }

    #[test]
    fn a_stream_depends_on_seed_and_purpose_and_on_nothing_else() {
        let draw = |seed, purpose| Random::new(seed, purpose).gaussian().to_bits();
        assert_eq!(draw(1, Purpose::PlaceNoise), draw(1, Purpose::PlaceNoise));
        assert_ne!(draw(1, Purpose::PlaceNoise), draw(2, Purpose::PlaceNoise));
        assert_ne!(draw(1, Purpose::PlaceNoise), draw(1, Purpose::ReportJitter));
    }

    /// Fixed for ever: a run's bytes must not change with a version of the generator or with the platform.
    #[test]
    fn the_first_numbers_of_a_seed_are_the_ones_they_were() {
        let mut random = Random::new(1, Purpose::PlaceNoise);
        let bits = [random.gaussian().to_bits(), random.gaussian().to_bits(), random.uniform().to_bits()];
        assert_eq!(bits, [4_603_255_720_214_852_501, 13_826_080_355_530_979_039, 4_585_035_295_383_720_560]);
    }
}
