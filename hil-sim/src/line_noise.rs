//! Random damage to the bytes on a line: inverted bits, lost bytes and doubled bytes.

use crate::error::{OutOfRange, zero_to_one};
use crate::random::{Purpose, Random};

/// Damage on a bad line. The default line is perfect.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NoiseConfig {
    /// Fraction of inverted bits, from 0 to 1.
    pub bit_error_rate: f64,
    /// Fraction of lost bytes, from 0 to 1.
    pub lost_share: f64,
    /// Fraction of bytes that arrive twice, from 0 to 1.
    pub doubled_share: f64,
}

/// One direction of a bad line. Damage is independent for each bit and each byte.
///
/// ```
/// use frixel_hil_sim::{LineNoise, NoiseConfig};
///
/// let mut noise = LineNoise::new(1);
/// noise.set(NoiseConfig { doubled_share: 1.0, ..NoiseConfig::default() })?;
/// let mut arrived = Vec::new();
/// noise.pass(b"ab", &mut arrived);
/// assert_eq!(arrived, b"aabb");
/// # Ok::<(), frixel_hil_sim::OutOfRange>(())
/// ```
#[derive(Clone, Debug)]
pub struct LineNoise {
    config: NoiseConfig,
    random: Random,
    /// Number of intact bits before the next inverted one.
    bits_left: u64,
}

impl LineNoise {
    /// A line without damage until [`Self::set`].
    #[must_use]
    pub fn new(seed: u64) -> Self {
        Self { config: NoiseConfig::default(), random: Random::new(seed, Purpose::LineNoise), bits_left: u64::MAX }
    }

    /// Sets the damage from now on.
    ///
    /// # Errors
    ///
    /// [`OutOfRange`] names a fraction outside 0 to 1; the line stays unchanged.
    pub fn set(&mut self, config: NoiseConfig) -> Result<(), OutOfRange> {
        zero_to_one("line bit_error_rate", config.bit_error_rate)?;
        zero_to_one("line lost_share", config.lost_share)?;
        zero_to_one("line doubled_share", config.doubled_share)?;
        self.config = config;
        self.bits_left = self.draw_gap();
        Ok(())
    }

    /// Passes `bytes` over the line, and appends the result to `arrived`.
    pub fn pass(&mut self, bytes: &[u8], arrived: &mut Vec<u8>) {
        let NoiseConfig { lost_share, doubled_share, .. } = self.config;
        for byte in bytes {
            let byte = byte ^ self.draw_flips();
            if lost_share > 0.0 && self.random.uniform() < lost_share {
                continue;
            }
            arrived.push(byte);
            if doubled_share > 0.0 && self.random.uniform() < doubled_share {
                arrived.push(byte);
            }
        }
    }

    /// The inverted bits of the next byte.
    fn draw_flips(&mut self) -> u8 {
        let mut flips = 0;
        let mut bit = 0;
        while self.bits_left < 8 - bit {
            bit += self.bits_left;
            flips |= 1 << bit;
            bit += 1;
            self.bits_left = self.draw_gap();
        }
        self.bits_left -= 8 - bit;
        flips
    }

    /// Number of bits before the next inverted one: geometrically distributed.
    fn draw_gap(&mut self) -> u64 {
        let rate = self.config.bit_error_rate;
        if rate <= 0.0 {
            return u64::MAX;
        }
        // From above 0 to 1.
        let draw = 1.0 - self.random.uniform();
        (libm::log(draw) / libm::log1p(-rate)) as u64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn arrived(config: NoiseConfig, bytes: &[u8]) -> Vec<u8> {
        let mut noise = LineNoise::new(7);
        noise.set(config).unwrap();
        let mut arrived = Vec::new();
        noise.pass(bytes, &mut arrived);
        arrived
    }

    #[test]
    fn as_many_bits_are_inverted_as_the_rate_says() {
        const BYTES: usize = 1_000_000;
        for bit_error_rate in [1e-4, 1e-3, 0.1] {
            let arrived = arrived(NoiseConfig { bit_error_rate, ..NoiseConfig::default() }, &vec![0; BYTES]);
            let found = arrived.iter().map(|byte| byte.count_ones()).sum::<u32>();
            let expected = bit_error_rate * 8.0 * BYTES as f64;
            assert!((f64::from(found) - expected).abs() < 5.0 * expected.sqrt(), "{bit_error_rate}: {found}");
            let bits: Vec<usize> =
                (0..8).map(|bit| arrived.iter().filter(|byte| *byte >> bit & 1 == 1).count()).collect();
            let of_each = expected / 8.0;
            assert!(bits.iter().all(|count| (*count as f64 - of_each).abs() < 5.0 * of_each.sqrt()), "{bits:?}");
        }
        assert_eq!(arrived(NoiseConfig { bit_error_rate: 1.0, ..NoiseConfig::default() }, &[0; 4]), [0xff; 4]);
    }

    #[test]
    fn bytes_are_lost_and_doubled_as_often_as_the_shares_say() {
        let bytes = vec![0; 100_000];
        let lost = arrived(NoiseConfig { lost_share: 0.1, ..NoiseConfig::default() }, &bytes).len();
        let doubled = arrived(NoiseConfig { doubled_share: 0.1, ..NoiseConfig::default() }, &bytes).len();
        assert!(lost.abs_diff(90_000) < 500 && doubled.abs_diff(110_000) < 500, "{lost} {doubled}");
        assert_eq!(arrived(NoiseConfig::default(), &bytes), bytes);
    }

    #[test]
    fn a_share_that_is_none_is_refused_by_name() {
        let error = LineNoise::new(1).set(NoiseConfig { lost_share: 1.5, ..NoiseConfig::default() }).unwrap_err();
        assert_eq!(error.to_string(), "line lost_share must be from 0 to 1, found 1.5");
    }
}
