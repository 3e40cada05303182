//! Sine of an angle in turns: the same bits everywhere, without `libm`, whose `sinf` costs about 1,480 instructions on
//! a Cortex-M4F.

use core::f32::consts::TAU;

/// The fraction of a turn, from 0 up to and including 1 after rounding, for magnitudes below 2^31.
#[cfg(feature = "grating")]
#[inline]
pub(crate) fn fraction(turns: f32) -> f32 {
    let fraction = turns - (turns as i32) as f32;
    if fraction < 0.0 { fraction + 1.0 } else { fraction }
}

// Odd polynomial for sin(2 pi x) on [-1/4, 1/4], after its first coefficient 2 pi: least-squares fit in the Chebyshev
// nodes, exact within 2e-8 before rounding.
const C3: f32 = -41.341_656;
const C5: f32 = 81.601;
const C7: f32 = -76.549_66;
const C9: f32 = 39.535_812;

/// `sin(2 pi turns)` for turns from 0 to 1, within 3e-7.
#[inline]
pub(crate) fn sine(turns: f32) -> f32 {
    // Folded to a quarter turn either side of zero, where an odd polynomial holds.
    let centred = turns - 0.5;
    let folded = if centred > 0.25 {
        0.5 - centred
    } else if centred < -0.25 {
        -0.5 - centred
    } else {
        centred
    };
    let square = folded * folded;
    -(folded * (TAU + square * (C3 + square * (C5 + square * (C7 + square * C9)))))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sine_is_within_its_bound() {
        let worst = (0..=1_000_000)
            .map(|i| {
                let turns = i as f32 / 1e6;
                (f64::from(sine(turns)) - libm::sin(core::f64::consts::TAU * f64::from(turns))).abs()
            })
            .fold(0.0, f64::max);
        assert!(worst < 3e-7, "{worst:e}");
    }

    #[cfg(feature = "grating")]
    #[test]
    fn fraction_wraps_both_ways() {
        for (turns, expected) in [(0.25, 0.25), (3.75, 0.75), (-0.25, 0.75), (-2.0, 0.0)] {
            assert!((fraction(turns) - expected).abs() < 1e-6, "{turns}");
        }
    }
}
