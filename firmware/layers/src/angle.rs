//! A fast angle in turns with identical bits on all platforms, in at most 39 instructions on a Cortex-M4F;
//! `libm::atan2f` takes 90 (`m4f.angle` and `m4f.angle_libm` of `cargo xtask bench`).
#![allow(dead_code, reason = "whether it is used depends on the features that are on")]

/// Distance from the origin, m, below which the angle is 0.
const LEAST_M: f32 = 1e-12;

// Odd polynomial for atan(x) / (2 pi) on [0, 1] with the smallest maximum error, 2.7e-7 before rounding.
const C1: f32 = 0.159_151_32;
const C3: f32 = -0.052_938_566;
const C5: f32 = 0.030_802_907;
const C7: f32 = -0.018_529_85;
const C9: f32 = 0.008_379_086;
const C11: f32 = -0.001_865_158_3;

/// Angle of the direction to a place, in turns from x towards y, from -1/2 to 1/2: within 4e-7. It is 0 at the origin,
/// and jumps by a whole turn where x is negative and y changes its sign.
#[inline]
pub fn angle_turns(x_m: f32, y_m: f32) -> f32 {
    let (across_m, down_m) = (x_m.abs(), y_m.abs());
    let is_steep = down_m > across_m;
    let (shorter_m, longer_m) = if is_steep { (across_m, down_m) } else { (down_m, across_m) };
    if !(longer_m > LEAST_M) {
        return 0.0;
    }
    let slope = shorter_m / longer_m;
    let square = slope * slope;
    let eighth = slope * (C1 + square * (C3 + square * (C5 + square * (C7 + square * (C9 + square * C11)))));
    let quarter = if is_steep { 0.25 - eighth } else { eighth };
    let half = if x_m < 0.0 { 0.5 - quarter } else { quarter };
    if y_m < 0.0 { -half } else { half }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Over all octants, and near their borders.
    #[test]
    fn the_angle_is_within_its_bound() {
        let mut worst = 0.0_f64;
        for step in 0..800_000_u32 {
            let turns = f64::from(step) / 800_000.0;
            for radius_m in [1e-9, 3e-4, 0.07, 1.9] {
                let (y, x) = libm::sincos(core::f64::consts::TAU * turns);
                let (x_m, y_m) = ((radius_m * x) as f32, (radius_m * y) as f32);
                let exact = libm::atan2(f64::from(y_m), f64::from(x_m)) / core::f64::consts::TAU;
                let error = f64::from(angle_turns(x_m, y_m)) - exact;
                // Half a turn and minus half a turn are the same direction.
                worst = worst.max((error - libm::round(error)).abs());
            }
        }
        assert!(worst < 4e-7, "{worst:e}");
    }

    #[test]
    fn the_origin_and_nan_have_the_angle_zero() {
        for (x_m, y_m) in [(0.0, 0.0), (-0.0, -0.0), (1e-13, -1e-13), (f32::NAN, f32::NAN)] {
            assert_eq!(angle_turns(x_m, y_m).to_bits(), 0, "{x_m} {y_m}");
        }
    }
}
