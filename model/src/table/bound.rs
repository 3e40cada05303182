//! The proven bound on a table's relative error in friction.

/// Supremum of `s |x^C V^(C)|/(C! V)` for `C` = 2, 3, 4 coefficients, rounded up: from `reference/table_constants.py`.
const CURVATURE: [f64; 3] = [0.425, 0.264, 0.189];

/// Largest product of the distances to the interpolation points in a row from -1 to 1, for 2, 3 and 4 points.
const DISTANCES: [f64; 3] = [1.0, 0.384_900_179_459_750_5, 0.171_572_875_253_809_9];

/// Contribution of f32 rounding: coefficients and Horner's steps weigh the four terms with 2, 4, 6, 7 half-units. In
/// rows of a quarter octave this is less than 25 half-units of friction for every power law between `V = x^(1/4)` and
/// `x^(1/2)`. In rows of an octave it is 30; their interpolation error is a thousand times larger.
pub(super) const ROUNDING: f64 = 25.0 / (1 << 24) as f64;

/// Relative distance of the last point below the curve: eight half-units, more than the rounding at the end of a row
/// (7.3), so that no voltage exceeds the largest.
pub(super) const TOP_MARGIN: f32 = 1.0 / (1 << 21) as f32;

/// Contribution of the top margin: its polynomial is at most 0.5 where the interpolation error is largest, and friction
/// grows at most with the fourth power of the voltage.
pub(super) const TOP_SHARE: f64 = 0.5 * 4.0 * TOP_MARGIN as f64;

/// Bound on the interpolation error, for rows whose half width is at most `half_width` times their start.
pub(super) fn interpolation_error(coefficients: usize, half_width: f64) -> Option<f64> {
    let order = coefficients.checked_sub(2)?;
    Some(CURVATURE.get(order)? * DISTANCES.get(order)? * libm::pow(half_width, coefficients as f64))
}

/// Largest half width relative to a row's start, for an interpolation error of at most `error`.
pub(super) fn half_width(coefficients: usize, error: f64) -> Option<f64> {
    let order = coefficients.checked_sub(2)?;
    Some(libm::pow(error / (CURVATURE.get(order)? * DISTANCES.get(order)?), 1.0 / coefficients as f64))
}
