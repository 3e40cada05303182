//! Steps of axes, and colours of friction.

use super::canvas::Colour;

/// The viridis colour scale of matplotlib (CC0) at nine places: even to the eye, and readable without colours.
const VIRIDIS: [Colour; 9] = [
    [68, 1, 84],
    [71, 44, 122],
    [59, 81, 139],
    [44, 113, 142],
    [33, 144, 141],
    [39, 173, 129],
    [92, 200, 99],
    [170, 220, 50],
    [253, 231, 37],
];
const UNKNOWN: Colour = [128; 3];

/// The colour of a part of the scale, from 0 to 1; beyond it, the colour of its end.
pub(crate) fn colour(part: f64) -> Colour {
    if part.is_nan() {
        return UNKNOWN;
    }
    let place = part.clamp(0.0, 1.0) * (VIRIDIS.len() - 1) as f64;
    let lower = (place as usize).min(VIRIDIS.len() - 2);
    [0, 1, 2].map(|channel| {
        let (one, other) = (f64::from(VIRIDIS[lower][channel]), f64::from(VIRIDIS[lower + 1][channel]));
        (one + (other - one) * (place - lower as f64)).round() as u8
    })
}

/// The least of 1, 2, 5, 10, ... that is not below `least`.
pub(crate) fn step(least: f64) -> f64 {
    let power = 10f64.powi(least.max(1e-300).log10().floor() as i32);
    let steps = [1.0, 2.0, 5.0, 10.0].map(|factor| factor * power);
    // A millionth below is rounding of the power.
    steps.into_iter().find(|step| *step >= least * (1.0 - 1e-6)).unwrap_or(10.0 * power)
}

/// Multiples of `step` from `start` to `end`.
pub(crate) fn ticks(start: f64, end: f64, step: f64) -> impl Iterator<Item = f64> {
    let first = (start / step - 1e-6).ceil() as i64;
    let last = (end / step + 1e-6).floor() as i64;
    (first..=last).map(move |number| number as f64 * step)
}

/// A number on an axis, without digits that say nothing.
pub(crate) fn label(value: f64) -> String {
    let rounded = (value * 1e6).round() / 1e6;
    format!("{}", if rounded.abs() > 0.0 { rounded } else { 0.0 })
}
