//! Inverse table: electric friction to voltage without root, division or logarithm.
//!
//! The bits of an `f32` are a piecewise linear logarithm of its value. A row covers 2^21 successive bit patterns, a
//! quarter of an octave, and holds a cubic in the friction itself; the rows end exactly at the friction of the largest
//! voltage.
//!
//! # The error bound
//!
//! Each cubic interpolates `V(x)` at four points, the two ends of its row among them. With `s = d ln x / d ln V` and the
//! row's half width `h <= 1/9` of its middle, the relative error in friction is at most
//! `s |x^4 V''''| / (24 V) * h^4 * (3 - 2 sqrt 2)`. The first factor depends on the dimensionless friction and load only;
//! its supremum over all frictions and all loads of zero or more is below 0.19, so the interpolation costs at most
//! 5.0e-6 for every contact. Rounding of the coefficients and of the evaluation adds at most 7 half-units, 4.2e-7 in
//! voltage and four times that in friction.

use crate::LoadedContact;

/// Why a table cannot be built.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TableError {
    /// The largest voltage is not finite or not above zero.
    Voltage,
    /// The range needs more segments than the table has room for: friction at the largest voltage is more than 2^31
    /// times that at the lowest.
    TooManySegments,
    /// A friction in the range, or a coefficient, is too large or too small for an `f32`.
    Unrepresentable,
}

/// Rows in a table: 31.5 octaves, enough for 200 V down to 1 V where friction grows as the fourth power of the voltage.
const ROWS: usize = 126;
/// Bits of the `f32` pattern below a row's index: four rows an octave.
const ROW_BITS: u32 = 21;
/// Width of a row in bit patterns.
const ROW_WIDTH: u32 = 1 << ROW_BITS;
/// The table reaches at least down to this voltage.
const KNEE_V_RMS: f64 = 1.0;
/// Or to this part of the largest voltage, when that is lower.
const KNEE_PART: f64 = 1.0 / 200.0;
/// `sqrt 2 - 1`: with the inner points there, the four points with both ends among them have the least largest error.
const INNER_POINT: f64 = core::f64::consts::SQRT_2 - 1.0;
/// The last point is put this far below the curve, eight half-units of `f32`, so that rounding stays below the largest
/// voltage.
const TOP_MARGIN: f64 = 1.0 / (1 << 21) as f64;

/// Piecewise cubic from electric friction to rms voltage for one contact under one load; 2,028 bytes.
#[derive(Clone, Debug, PartialEq)]
pub struct InverseTable {
    rows: [[f32; 4]; ROWS],
    first_bits: u32,
    electric_friction_max_n: f32,
    voltage_max_v_rms: f32,
}

impl InverseTable {
    /// Largest relative error, in electric friction, from the friction at 1 V (or at 1/200 of the largest voltage, when
    /// that is lower) to that at the largest.
    pub const RELATIVE_ERROR: f32 = 1e-5;

    /// A table for `contact`, up to `voltage_max_v_rms`: some 250 evaluations of the closed form.
    pub fn build(contact: &LoadedContact<f64>, voltage_max_v_rms: f64) -> Result<Self, TableError> {
        let largest = round_down(voltage_max_v_rms);
        if !(voltage_max_v_rms.is_finite() && largest > 0.0) {
            return Err(TableError::Voltage);
        }
        let knee_v_rms = KNEE_V_RMS.min(voltage_max_v_rms * KNEE_PART);
        let knee_n = round_down(contact.electric_friction_n(knee_v_rms));
        let electric_friction_max_n = round_down(contact.electric_friction_n(f64::from(largest)));
        if !(knee_n >= f32::MIN_POSITIVE && electric_friction_max_n < f32::MAX) {
            return Err(TableError::Unrepresentable);
        }
        let end_bits = electric_friction_max_n.to_bits() + 1;
        let first_bits = end_bits.checked_sub(ROWS as u32 * ROW_WIDTH).ok_or(TableError::Unrepresentable)?;
        let knee_row = knee_n.to_bits().checked_sub(first_bits).ok_or(TableError::TooManySegments)? >> ROW_BITS;

        let start_n = |row: u32| f64::from(f32::from_bits(first_bits + row * ROW_WIDTH));
        let knee_start_n = start_n(knee_row);
        let mut start = (knee_start_n, contact.voltage_v_rms(knee_start_n));
        let line = [0.0, (start.1 / start.0) as f32, 0.0, 0.0];
        let mut rows = [line; ROWS];
        for (index, row) in (0..).zip(&mut rows).skip(knee_row as usize) {
            let end_n = start_n(index + 1);
            let mut end = (end_n, contact.voltage_v_rms(end_n));
            if index + 1 == ROWS as u32 {
                end.1 *= 1.0 - TOP_MARGIN;
            }
            *row = cubic(contact, start, end);
            start = end;
        }
        if rows.as_flattened().iter().any(|coefficient| !coefficient.is_finite()) {
            return Err(TableError::Unrepresentable);
        }
        Ok(Self { rows, first_bits, electric_friction_max_n, voltage_max_v_rms: largest })
    }

    /// The rms voltage for an electric friction in newtons.
    ///
    /// Within [`Self::RELATIVE_ERROR`] of the friction asked for; zero for a negative friction and for not-a-number; the
    /// largest voltage, and never more, above the largest friction. Below the range it falls on a straight line towards
    /// zero.
    #[inline]
    pub fn voltage_v_rms(&self, electric_friction_n: f32) -> f32 {
        let x = electric_friction_n;
        // Whatever is outside the range, and every negative and not-a-number, wraps to an index past the last row.
        let index = x.to_bits().wrapping_sub(self.first_bits) >> ROW_BITS;
        match self.rows.get(index as usize) {
            Some([c0, c1, c2, c3]) => ((c3 * x + c2) * x + c1) * x + c0,
            None if x > self.electric_friction_max_n => self.voltage_max_v_rms,
            None => 0.0,
        }
    }

    /// The electric friction at the largest voltage, in newtons, rounded down.
    pub fn electric_friction_max_n(&self) -> f32 {
        self.electric_friction_max_n
    }

    /// The largest voltage, in volts rms.
    pub fn voltage_max_v_rms(&self) -> f32 {
        self.voltage_max_v_rms
    }
}

/// The largest `f32` that is not above `value`.
fn round_down(value: f64) -> f32 {
    let nearest = value as f32;
    if f64::from(nearest) > value { nearest.next_down() } else { nearest }
}

/// Coefficients, constant first, of the cubic through `start`, `end` and two points of the curve between them.
fn cubic(contact: &LoadedContact<f64>, start: (f64, f64), end: (f64, f64)) -> [f32; 4] {
    let middle = 0.5 * (start.0 + end.0);
    let inner = INNER_POINT * 0.5 * (end.0 - start.0);
    let point = |x_n: f64| (x_n, contact.voltage_v_rms(x_n));
    let (x0, v0) = start;
    let (x1, v1) = point(middle - inner);
    let (x2, v2) = point(middle + inner);
    let (x3, v3) = end;
    // Newton's divided differences, then the same polynomial in powers of the friction.
    let (d01, d12, d23) = ((v1 - v0) / (x1 - x0), (v2 - v1) / (x2 - x1), (v3 - v2) / (x3 - x2));
    let (d012, d123) = ((d12 - d01) / (x2 - x0), (d23 - d12) / (x3 - x1));
    let d0123 = (d123 - d012) / (x3 - x0);
    let c2 = d012 - d0123 * (x0 + x1 + x2);
    let c1 = d01 - d012 * (x0 + x1) + d0123 * (x0 * x1 + x2 * (x0 + x1));
    let c0 = v0 - x0 * (d01 - x1 * (d012 - x2 * d0123));
    [c0 as f32, c1 as f32, c2 as f32, d0123 as f32]
}
