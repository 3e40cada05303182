//! Intervals of friction: bounds of the layers, and the largest target friction of a scene.
//!
//! The host's compiler uses this; a board does not. [`electric_friction_max_n`] works cell by cell of the scene's grid,
//! in the order and in the `f32` operations of the tick: rounding is monotone, so no sum or product of the tick leaves
//! the interval of the same operation. Only rounding within a layer needs a margin, [`ROUNDING`]. There is no lower
//! bound: every ramp takes the friction down to zero, and must be smooth there.

use core::ops::{Add, Mul};

use crate::grid::Grid;
use crate::header::{Header, upper_half_rounded_up};
use crate::point::Point;
use crate::record::Record;
use crate::region::Region;

/// How far a layer may exceed the numbers in its record, relative to the larger of them: a cosine may be a millionth
/// above 1, and a sum is rounded a few times.
const ROUNDING: f32 = 4e-6;

/// `f32` or `f64`.
pub trait Number: Copy + PartialOrd + Add<Output = Self> + Mul<Output = Self> {
    /// The largest number, above all others.
    const INFINITY: Self;
    /// The least number.
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

impl Interval<f32> {
    const ZERO: Self = Self { low: 0.0, high: 0.0 };

    fn rounded_outward(self) -> Self {
        let margin = ROUNDING * larger(self.low.abs(), self.high.abs());
        Self { low: self.low - margin, high: self.high + margin }
    }
}

/// Returns not-a-number if an argument is, unlike `f32::min`: it must not be lost in a bound.
fn lesser<T: PartialOrd + Copy>(one: T, other: T) -> T {
    if one < other || is_nan(one) { one } else { other }
}

fn larger<T: PartialOrd + Copy>(one: T, other: T) -> T {
    if one > other || is_nan(one) { one } else { other }
}

#[allow(clippy::eq_op, reason = "only not-a-number differs from itself")]
fn is_nan<T: PartialOrd + Copy>(value: T) -> bool {
    value != value
}

/// The largest electric friction of a scene at any place, time and speed, N, rounded up to the precision of the header
/// ([`Header::electric_friction_max_n`]); `None` if it has no finite bound. Only valid if the host does not change a
/// layer while the scene plays.
pub fn electric_friction_max_n(header: &Header, records: &[Record], points: &[Point]) -> Option<f32> {
    let mut grid = Grid::EMPTY;
    grid.reset(header.screen_width_m, header.screen_height_m);
    for (number, record) in (0..).zip(records) {
        grid.add(number, &record.region, points);
    }
    let of_cell = |layers: &dyn Fn(u8) -> bool| {
        let there = (0..).zip(records).filter(|(number, _)| layers(*number));
        there.fold(Interval::ZERO, |below, (_, record)| over(record, points, below)).high
    };
    let max_n = grid.cells().map(|cell| of_cell(&|number| cell.has(number))).fold(0.0, larger);
    let stored_n = f32::from_bits(u32::from(upper_half_rounded_up(max_n)) << u16::BITS);
    Some(stored_n).filter(|max_n| max_n.is_finite())
}

/// The interval after blending a layer over the interval below it. Includes the case that the layer does not act at the
/// place.
fn over(record: &Record, points: &[Point], below: Interval<f32>) -> Interval<f32> {
    let own = Interval::of([record.gain]).times(record.layer.bounds(points).rounded_outward());
    let blended = record.blend.of_intervals(below, own);
    if record.layer.is_streamed() {
        below.hull(blended).rounded_outward()
    } else if record.region == Region::Screen {
        blended
    } else {
        below.hull(blended)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn not_a_number_is_no_bound() {
        let endless = Interval { low: f32::NEG_INFINITY, high: f32::INFINITY };
        assert!(endless.times(Interval::ZERO).high.is_nan());
        assert!(Interval::ZERO.hull(endless.times(Interval::ZERO)).high.is_nan());
        assert!(endless.times(Interval::ZERO).hull(Interval::ZERO).high.is_nan());
        assert!(larger(larger(0.0, f32::NAN), 1.0).is_nan());
    }
}
