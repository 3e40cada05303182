//! A fast cosine of an angle in turns with identical bits on all platforms, without `libm`, whose `sinf` costs about
//! 1,480 instructions on a Cortex-M4F.
#![allow(dead_code, reason = "which of these is used depends on the features that are on")]

/// Adding and subtracting this number rounds to an integer: an `f32` from 2^23 to 2^24 has no fraction bits, and the
/// sum with a magnitude below 2^22 stays in this range.
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

// Polynomials for the sine and cosine of 2 pi x on [-1/8, 1/8], with maximum errors of 2e-8 and 3e-8 before rounding.
const SINE: [f32; 4] = [6.283_185_5, -41.341_663, 81.592_545, -75.401_84];
const COSINE: [f32; 4] = [1.0, -19.739_153, 64.921_24, -83.592_22];

/// The direction of an angle as a unit vector, within 2e-7; exact for quarter turns. For magnitudes below 2^20.
///
/// `libm::sincosf` would take 3.4 KB of a board's flash.
pub(crate) fn direction(angle_turns: f32) -> (f32, f32) {
    let quarters = 4.0 * centred(angle_turns);
    let whole_quarters = quarters - centred(quarters);
    let rest = 0.25 * (quarters - whole_quarters);
    let square = rest * rest;
    let series = |[c0, c1, c2, c3]: [f32; 4]| c0 + square * (c1 + square * (c2 + square * c3));
    let (x, y) = (series(COSINE), rest * series(SINE));
    match whole_quarters as i32 & 3 {
        0 => (x, y),
        1 => (-y, x),
        2 => (-x, -y),
        _ => (y, -x),
    }
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

    #[test]
    fn a_direction_is_within_its_bound_and_exact_for_quarter_turns() {
        for step in -1_000_000..=1_000_000 {
            let turns = step as f32 / 3e5;
            let (y, x) = libm::sincos(core::f64::consts::TAU * f64::from(turns));
            let (found_x, found_y) = direction(turns);
            let error = (f64::from(found_x) - x).abs().max((f64::from(found_y) - y).abs());
            assert!(error < 2e-7, "{turns}: {error:e}");
        }
        for (turns, expected) in [(0.0, (1.0, 0.0)), (0.25, (0.0, 1.0)), (-0.5, (-1.0, 0.0)), (7.75, (0.0, -1.0))] {
            assert_eq!(direction(turns), expected, "{turns}");
        }
    }

    #[cfg(feature = "grating")]
    #[test]
    fn an_angle_is_centred_both_ways() {
        for (turns, expected) in [(0.25, 0.25), (3.75, -0.25), (-0.25, -0.25), (-2.0, 0.0), (80_000.25, 0.25)] {
            assert!((centred(turns) - expected).abs() < 1e-6, "{turns}");
        }
    }
}
