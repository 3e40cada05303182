//! A fast cosine of an angle in turns with identical bits on all platforms, without `libm`, whose `sinf` costs about
//! 1,480 instructions on a Cortex-M4F.
#![allow(dead_code, reason = "which of these is used depends on the features that are on")]

/// Half of this is the magnitude above which an `f32` has no fraction bits. Adding and subtracting it rounds to an
/// integer.
const WHOLE: f32 = 1.5 * (1 << 23) as f32;

/// Difference of an angle from the nearest whole turn, from -1/2 to 1/2, for magnitudes below 2^22.
#[inline]
pub(crate) fn centred(turns: f32) -> f32 {
    turns - ((turns + WHOLE) - WHOLE)
}

// Odd polynomial for sin(2 pi x) on [-1/4, 1/4] with the smallest maximum error, 6e-7 before rounding, a thousandth of
// the DAC's resolution. A higher degree would slow down noise by a tenth.
const C1: f32 = 6.283_164;
const C3: f32 = -41.337_143;
const C5: f32 = 81.340_77;
const C7: f32 = -70.993_42;

/// `cos(2 pi turns)` for magnitudes below 2^22: within 1e-6 of the cosine of the rounded angle.
#[inline]
pub fn cosine(turns: f32) -> f32 {
    // The cosine is the sine of the distance to a quarter turn, where the odd polynomial is valid.
    let rest = 0.25 - centred(turns).abs();
    let square = rest * rest;
    rest * (C1 + square * (C3 + square * (C5 + square * C7)))
}

/// The direction of an angle as a unit vector. Not for the tick.
pub(crate) fn direction(angle_turns: f32) -> (f32, f32) {
    let (y, x) = libm::sincosf(core::f32::consts::TAU * angle_turns);
    (x, y)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cosine_is_within_its_bound() {
        let worst = (-1_000_000..=1_000_000)
            .map(|i| {
                let turns = i as f32 / 3e5;
                (f64::from(cosine(turns)) - libm::cos(core::f64::consts::TAU * f64::from(turns))).abs()
            })
            .fold(0.0, f64::max);
        assert!(worst < 1e-6, "{worst:e}");
    }

    #[cfg(feature = "grating")]
    #[test]
    fn an_angle_is_centred_both_ways() {
        for (turns, expected) in [(0.25, 0.25), (3.75, -0.25), (-0.25, -0.25), (-2.0, 0.0), (80_000.25, 0.25)] {
            assert!((centred(turns) - expected).abs() < 1e-6, "{turns}");
        }
    }
}
