//! Intervals of numbers: bounds of layers.

use core::ops::{Add, Mul};

/// `f32` or `f64`.
pub trait Number: Copy + PartialOrd + Add<Output = Self> + Mul<Output = Self> {
    /// Positive infinity.
    const INFINITY: Self;
    /// Negative infinity.
    const NEG_INFINITY: Self;
}

impl Number for f32 {
    const INFINITY: Self = Self::INFINITY;
    const NEG_INFINITY: Self = Self::NEG_INFINITY;
}

impl Number for f64 {
    const INFINITY: Self = Self::INFINITY;
    const NEG_INFINITY: Self = Self::NEG_INFINITY;
}

/// Least and largest electric friction, N; or dimensionless factors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interval<T> {
    /// Least value.
    pub low: T,
    /// Largest value.
    pub high: T,
}

impl<T: Number> Interval<T> {
    /// The smallest interval that contains all given values.
    pub fn of(values: impl IntoIterator<Item = T>) -> Self {
        let empty = Self { low: T::INFINITY, high: T::NEG_INFINITY };
        values.into_iter().fold(empty, |interval, value| interval.hull(Self { low: value, high: value }))
    }

    /// The smallest interval that contains both intervals.
    #[must_use]
    pub fn hull(self, other: Self) -> Self {
        Self { low: lesser(self.low, other.low), high: larger(self.high, other.high) }
    }

    /// The interval of sums.
    #[must_use]
    pub fn plus(self, other: Self) -> Self {
        Self { low: self.low + other.low, high: self.high + other.high }
    }

    /// The interval of products.
    #[must_use]
    pub fn times(self, other: Self) -> Self {
        Self::of([self.low * other.low, self.low * other.high, self.high * other.low, self.high * other.high])
    }

    /// The interval of the larger of two values.
    #[must_use]
    pub fn max(self, other: Self) -> Self {
        Self { low: larger(self.low, other.low), high: larger(self.high, other.high) }
    }
}

/// Returns NaN if an argument is NaN, unlike `f32::min`, since a bound must not lose it.
fn lesser<T: PartialOrd + Copy>(one: T, other: T) -> T {
    if one < other || is_nan(one) { one } else { other }
}

pub(crate) fn larger<T: PartialOrd + Copy>(one: T, other: T) -> T {
    if one > other || is_nan(one) { one } else { other }
}

#[allow(clippy::eq_op, reason = "only NaN differs from itself")]
fn is_nan<T: PartialOrd + Copy>(value: T) -> bool {
    value != value
}

#[cfg(test)]
mod tests {
    use super::*;

    const ZERO: Interval<f32> = Interval { low: 0.0, high: 0.0 };

    #[test]
    fn nan_is_no_bound() {
        let endless = Interval { low: f32::NEG_INFINITY, high: f32::INFINITY };
        assert!(endless.times(ZERO).high.is_nan());
        assert!(ZERO.hull(endless.times(ZERO)).high.is_nan());
        assert!(endless.times(ZERO).hull(ZERO).high.is_nan());
        assert!(larger(larger(0.0, f32::NAN), 1.0).is_nan());
    }
}
