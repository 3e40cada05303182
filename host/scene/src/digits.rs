//! Numbers in messages: four significant digits.

/// Four significant digits, rounded by `to_whole`.
pub(super) fn digits(value: f64, to_whole: fn(f64) -> f64) -> f64 {
    if !(value.abs() > 0.0) {
        return 0.0;
    }
    let digits = 3 - value.abs().log10().floor() as i32;
    // A power of ten with a non-negative integer exponent is exact, so the result prints with few digits.
    let scale = 10f64.powi(digits.abs());
    if digits >= 0 { to_whole(value * scale) / scale } else { to_whole(value / scale) * scale }
}

/// Rounds up to a whole number, ignoring an excess from rounding to `f32`.
pub(super) fn up(value: f64) -> f64 {
    (value - 0.002).ceil()
}

/// Rounds down to a whole number, ignoring a deficit from rounding to `f32`.
pub(super) fn down(value: f64) -> f64 {
    (value + 0.002).floor()
}
