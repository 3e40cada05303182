//! Table evaluation in f32, and the layout of the rows.

use core::num::NonZeroU32;
use core::ops::Range;

use super::bound::TOP_MARGIN;
use super::interpolation::{Curve, Point, polynomial};
use super::{TableBuilder, TableError};
use crate::{Real, divide_wide};

/// Largest friction of a table, in newtons. Far above, the coefficients `V/x^n` of a row underflow, and the row exceeds
/// the largest voltage.
pub(crate) const FRICTION_MAX_N: f32 = 1e12;

/// Maps bit patterns of the friction to rows, and holds the values outside the rows.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub(crate) struct RowGrid {
    first_bits: u32,
    /// Number of rows per 2^32 bit patterns; zero in an empty grid.
    density: u32,
    friction_max_n: f32,
    voltage_max_v_rms: f32,
}

impl RowGrid {
    /// A grid without rows, all of whose bits are zero.
    pub(crate) const EMPTY: Self = Self { first_bits: 0, density: 0, friction_max_n: 0.0, voltage_max_v_rms: 0.0 };

    /// A grid of `rows` rows of about `2^32/density` patterns each, the last one up to and including `friction_max_n`.
    pub(crate) fn new(
        rows: usize,
        density: NonZeroU32,
        friction_max_n: f32,
        voltage_max_v_rms: f32,
    ) -> Result<Self, TableError> {
        let end_bits = u64::from(friction_max_n.to_bits()) + 1;
        let density = density.get();
        let first_bits = end_bits.checked_sub(offset(rows, density)).ok_or(TableError::Unrepresentable)?;
        Ok(Self { first_bits: first_bits as u32, density, friction_max_n, voltage_max_v_rms })
    }

    #[inline]
    pub(super) fn is_empty(&self) -> bool {
        self.density == 0
    }

    /// Start of a row; the end of the last row is the start of the row after it.
    pub(crate) fn start_n(&self, row: usize) -> f32 {
        f32::from_bits((u64::from(self.first_bits) + offset(row, self.density)) as u32)
    }

    /// The row of a friction, or a number past the last row if the friction is outside; zero in an empty grid.
    #[inline]
    pub(crate) fn row(&self, friction_n: f32) -> usize {
        // Below the range, the subtraction wraps to a large number; the bits of negative numbers and NaN are large
        // themselves.
        let patterns = friction_n.to_bits().wrapping_sub(self.first_bits);
        ((u64::from(patterns) * u64::from(self.density)) >> 32) as usize
    }

    /// The row after the one that contains `up_to_n`, or `least_n` if that is larger; `rows` if `up_to_n` is
    /// not below the largest friction, or NaN.
    pub(super) fn end_row(&self, rows: usize, up_to_n: f32, least_n: f32) -> usize {
        if up_to_n < self.friction_max_n { self.row(up_to_n.max(least_n)) + 1 } else { rows }
    }

    pub(super) fn friction_max_n(&self) -> f32 {
        self.friction_max_n
    }

    pub(super) fn voltage_max_v_rms(&self) -> f32 {
        self.voltage_max_v_rms
    }

    /// The voltage for a friction, from its row. Outside the rows: zero below and for NaN, the largest voltage above.
    #[inline]
    pub(super) fn evaluate<const C: usize>(&self, rows: &[[f32; C]], friction_n: f32) -> f32 {
        match rows.get(self.row(friction_n)) {
            Some(row) => horner(row, friction_n),
            None if friction_n > self.friction_max_n => self.voltage_max_v_rms,
            None => 0.0,
        }
    }

    /// Truncates the table before row `end` and returns the voltage there; `None` if no row is truncated.
    pub(super) fn cut_at<T: Real>(&mut self, end: usize, curve: &impl Curve<T>) -> Option<f32> {
        let end_n = self.start_n(end);
        let friction_max_n = end_n.next_down();
        if friction_max_n >= self.friction_max_n {
            return None;
        }
        self.friction_max_n = friction_max_n;
        self.voltage_max_v_rms = round_down(curve.voltage_v_rms(T::from(end_n)));
        Some(self.voltage_max_v_rms)
    }

    /// The point of a curve at the start of a row.
    pub(super) fn start<T: Real>(&self, row: usize, curve: &impl Curve<T>) -> Point<T> {
        let friction_n = T::from(self.start_n(row));
        (friction_n, curve.voltage_v_rms(friction_n))
    }

    /// Fills the rows `needed` of the table's `rows` with a curve, from the point at the start of the first one.
    /// Returns the point at the start of the next one.
    pub(super) fn fill<T: Real, const C: usize>(
        &self,
        curve: &impl Curve<T>,
        rows: &mut [[f32; C]],
        needed: Range<usize>,
        mut start: Point<T>,
    ) -> Result<Point<T>, TableError> {
        let last = rows.len().saturating_sub(1);
        for (index, row) in rows.iter_mut().enumerate().take(needed.end).skip(needed.start) {
            let mut end = self.start(index + 1, curve);
            if index == last {
                end.1 = end.1 * T::from(1.0 - TOP_MARGIN);
            }
            *row = polynomial::<T, C>(curve, start, end, power_of_two(self.start_n(index)));
            if row.iter().any(|coefficient| !coefficient.is_finite()) {
                return Err(TableError::Unrepresentable);
            }
            start = end;
        }
        Ok(start)
    }
}

/// Number of patterns from the start of the first row to that of row `row`: the smallest whose product with `density`
/// reaches it; zero without a density.
fn offset(row: usize, density: u32) -> u64 {
    let Some(density) = NonZeroU32::new(density) else { return 0 };
    let (patterns, remainder) = divide_wide(row as u32, 0, density);
    patterns + u64::from(remainder > 0)
}

#[inline]
fn horner<const C: usize>(row: &[f32; C], x: f32) -> f32 {
    let Some((highest, lower)) = row.split_last() else { return 0.0 };
    lower.iter().rev().fold(*highest, |sum, coefficient| sum * x + coefficient)
}

/// The largest power of two up to a positive number; the smallest normal number for a smaller or negative one.
fn power_of_two(value: f32) -> f32 {
    f32::from_bits(value.max(f32::MIN_POSITIVE).to_bits() & f32::INFINITY.to_bits())
}

/// The largest `f32` up to `value`.
pub(crate) fn round_down<T: Real>(value: T) -> f32 {
    let nearest = value.to_f32();
    if T::from(nearest) > value { nearest.next_down() } else { nearest }
}

/// A table in f32 over borrowed rows, with `C` coefficients per row; created by [`TableBuilder::build_f32`].
#[derive(Clone, Debug, PartialEq)]
pub struct SizedTable<'rows, const C: usize> {
    grid: RowGrid,
    rows: &'rows [[f32; C]],
}

impl<'rows, const C: usize> SizedTable<'rows, C> {
    pub(super) fn fill(builder: &TableBuilder<'_>, storage: &'rows mut [[f32; C]]) -> Result<Self, TableError> {
        let layout = builder.float_layout(C)?;
        let rows = storage.get_mut(..layout.rows).ok_or(TableError::TooManySegments)?;
        let friction_max_n = round_down(builder.friction_max_n);
        let voltage_max_v_rms = round_down(builder.contact.voltage_v_rms(builder.friction_max_n));
        let grid = RowGrid::new(layout.rows, layout.density, friction_max_n, voltage_max_v_rms)?;
        grid.fill(builder.contact, rows, 0..layout.rows, grid.start(0, builder.contact))?;
        Ok(Self { grid, rows })
    }

    /// The rms voltage for an electric friction in newtons. It is zero for a negative friction, for NaN and below the
    /// range; above the range it is the largest voltage, which it never exceeds.
    #[inline]
    pub fn voltage_v_rms(&self, electric_friction_n: f32) -> f32 {
        self.grid.evaluate(self.rows, electric_friction_n)
    }

    /// The largest electric friction in the table, in newtons, rounded down.
    pub fn electric_friction_max_n(&self) -> f32 {
        self.grid.friction_max_n()
    }

    /// The largest voltage, in volts rms.
    pub fn voltage_max_v_rms(&self) -> f32 {
        self.grid.voltage_max_v_rms()
    }
}
