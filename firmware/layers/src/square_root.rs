//! A fast square root in 20 instructions on a Cortex-M4F; `libm::sqrtf` takes about 150.

/// Half of the exponent and a first guess at the rest of `1/sqrt(x)`, within 3.5 % (C. Lomont, "Fast inverse square
/// root", Purdue University, 2003).
const GUESS: u32 = 0x5f37_59df;
/// Numbers below this have the root 0: (1e-15)^2.
const LEAST: f32 = 1e-30;

/// Square root, with a relative error within 3e-7 from 1e-30 to 1e30; 0 for smaller numbers and for NaN.
#[inline]
pub fn square_root(x: f32) -> f32 {
    if !(x > LEAST) {
        return 0.0;
    }
    let half = 0.5 * x;
    let mut inverse = f32::from_bits(GUESS.wrapping_sub(x.to_bits() >> 1));
    // Newton's steps for 1/sqrt(x) need no division; three reduce an error of 3.5 % to below the rounding error.
    inverse *= 1.5 - half * inverse * inverse;
    inverse *= 1.5 - half * inverse * inverse;
    inverse *= 1.5 - half * inverse * inverse;
    x * inverse
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_root_is_within_its_bound() {
        let worst = (0..2_000_000)
            .map(|i| {
                let x = f32::from_bits(LEAST.to_bits() + 1 + 837 * i);
                (f64::from(square_root(x)) / libm::sqrt(f64::from(x)) - 1.0).abs()
            })
            .fold(0.0, f64::max);
        assert!(worst < 3e-7, "{worst:e}");
        assert!(f32::from_bits(LEAST.to_bits() + 1 + 837 * 1_999_999) > 1e30);
    }

    #[test]
    fn the_root_of_tiny_and_negative_numbers_and_nan_is_zero() {
        for x in [0.0, -0.0, -1.0, f32::NAN, f32::NEG_INFINITY, 1e-31, f32::MIN_POSITIVE] {
            assert_eq!(square_root(x).to_bits(), 0, "{x}");
        }
    }
}
