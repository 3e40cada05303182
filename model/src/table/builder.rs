//! The smallest table that meets an error target.

use core::num::NonZeroU32;

use super::bound::{ROUNDING, TOP_SHARE, half_width, interpolation_error};
use super::{FixedTable, SizedTable, TableError};
use crate::LoadedContact;

/// The number format of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Precision {
    /// `f32`, for processor cores with an FPU.
    F32,
    /// 32-bit integers, for processor cores without an FPU.
    Fixed,
}

/// The requirements on a table: a contact, a range of electric friction, an error target.
///
/// The contact may be that of the universal curve, [`Contact::universal`](crate::Contact::universal). Such a table
/// maps `F/F*` to `V/V*`, with the electric friction `F`, and is valid for every finger and coating under the same
/// `n`.
///
/// ```
/// use frixel_model::{Contact, Finger, Precision, TableBuilder};
/// let contact = Contact::new(&Finger::<f64>::EXAMPLE, 10e-6)?.under_load(0.5)?;
/// let builder = TableBuilder::new(&contact, 1e-6, 28e-3, 1e-3)?;
/// let shape = builder.smallest(Precision::F32)?;
/// assert_eq!((shape.coefficients, shape.rows, shape.bytes()), (4, 18, 288));
/// let mut rows = [[0.0; 4]; 18];
/// let table = builder.build_f32(&mut rows)?;
/// let friction_n = contact.electric_friction_n(f64::from(table.voltage_v_rms(0.01)));
/// assert!((friction_n / 0.01 - 1.0).abs() < 1e-3);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct TableBuilder<'contact> {
    pub(super) contact: &'contact LoadedContact<f64>,
    pub(super) friction_min_n: f64,
    pub(super) friction_max_n: f64,
    relative_error: f64,
}

/// The size of a table, and the proven bound on its error over the whole range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TableShape {
    /// Number format of the rows.
    pub precision: Precision,
    /// Coefficients per row: 2, 3 or 4.
    pub coefficients: usize,
    /// Number of rows.
    pub rows: usize,
    /// The proven bound on the relative error in electric friction.
    pub relative_error: f64,
}

impl TableShape {
    /// Size of the rows in bytes.
    pub fn bytes(&self) -> usize {
        4 * self.coefficients * self.rows
    }
}

pub(super) struct FloatLayout {
    pub(super) rows: usize,
    pub(super) density: NonZeroU32,
    relative_error: f64,
}

pub(super) struct FixedLayout {
    pub(super) rows: usize,
    pub(super) per_octave: NonZeroU32,
    pub(super) first_octave: u32,
    relative_error: f64,
}

impl<'contact> TableBuilder<'contact> {
    /// Requires a table for electric frictions from `friction_min_n`, above zero, to `friction_max_n`, both in newtons,
    /// whose relative error in friction is at most `relative_error`.
    pub fn new(
        contact: &'contact LoadedContact<f64>,
        friction_min_n: f64,
        friction_max_n: f64,
        relative_error: f64,
    ) -> Result<Self, TableError> {
        if !(friction_min_n > 0.0 && friction_max_n > friction_min_n && friction_max_n.is_finite()) {
            return Err(TableError::Range);
        }
        if !(relative_error > 0.0) {
            return Err(TableError::Target);
        }
        Ok(Self { contact, friction_min_n, friction_max_n, relative_error })
    }

    /// The shape of the smallest table with this many coefficients per row: 2, 3 or 4.
    pub fn shape(&self, precision: Precision, coefficients: usize) -> Result<TableShape, TableError> {
        let (rows, relative_error) = match precision {
            Precision::F32 => self.float_layout(coefficients).map(|layout| (layout.rows, layout.relative_error))?,
            Precision::Fixed => self.fixed_layout(coefficients).map(|layout| (layout.rows, layout.relative_error))?,
        };
        Ok(TableShape { precision, coefficients, rows, relative_error })
    }

    /// The shape of the smallest table with 2, 3 or 4 coefficients per row.
    pub fn smallest(&self, precision: Precision) -> Result<TableShape, TableError> {
        let mut smallest = self.shape(precision, 4)?;
        for coefficients in [3, 2] {
            if let Ok(shape) = self.shape(precision, coefficients)
                && shape.bytes() <= smallest.bytes()
            {
                smallest = shape;
            }
        }
        Ok(smallest)
    }

    /// Builds the table in f32, in the first rows of `storage`; [`Self::shape`] returns how many rows it needs.
    pub fn build_f32<'rows, const C: usize>(
        &self,
        storage: &'rows mut [[f32; C]],
    ) -> Result<SizedTable<'rows, C>, TableError> {
        SizedTable::fill(self, storage)
    }

    /// Builds the table in integers, in the first rows of `storage`; [`Self::shape`] returns how many rows it needs.
    pub fn build_fixed<'rows, const C: usize>(
        &self,
        storage: &'rows mut [[i32; C]],
    ) -> Result<FixedTable<'rows, C>, TableError> {
        FixedTable::fill(self, storage)
    }

    pub(super) fn float_layout(&self, coefficients: usize) -> Result<FloatLayout, TableError> {
        let rest = ROUNDING + TOP_SHARE;
        let half = half_width(coefficients, self.budget(rest)?).ok_or(TableError::Range)?.min(0.5);
        let (low, high) = (self.friction_min_n as f32, self.friction_max_n as f32);
        if !(low >= f32::MIN_POSITIVE && high < f32::MAX) {
            return Err(TableError::Unrepresentable);
        }
        // A row is at most twice `half` of its start; an octave has 2^23 patterns.
        let density = libm::ceil(512.0 / (2.0 * half));
        if !(density <= f64::from(1 << 24)) {
            return Err(TableError::TooManySegments);
        }
        // From the bit pattern before the smallest friction to the one after the largest.
        let patterns = u64::from(high.to_bits() - low.to_bits()) + 2;
        let rows = ((patterns * density as u64) >> 32) + 1;
        let relative_error = rest + interpolation_error(coefficients, 256.0 / density).ok_or(TableError::Range)?;
        let density = NonZeroU32::new(density as u32).ok_or(TableError::Target)?;
        Ok(FloatLayout { rows: rows as usize, density, relative_error })
    }

    pub(super) fn fixed_layout(&self, coefficients: usize) -> Result<FixedLayout, TableError> {
        let voltage_ratio =
            self.contact.voltage_v_rms(self.friction_max_n) / self.contact.voltage_v_rms(self.friction_min_n);
        // Error in codes: half per coefficient, one per truncated step, and one for the position in the row. Friction
        // grows at most as the fourth power of the voltage.
        let codes = 1.5 * coefficients as f64;
        let rest = 4.0 * codes / f64::from(1_u32 << 31) * voltage_ratio + TOP_SHARE;
        let half = half_width(coefficients, self.budget(rest)?).ok_or(TableError::Range)?.min(0.5);
        let per_octave = libm::ceil(0.5 / half);
        let octaves = libm::ceil(libm::log2(self.friction_max_n / self.friction_min_n));
        if !(octaves <= 32.0) {
            return Err(TableError::Unrepresentable);
        }
        let rows = octaves * per_octave;
        if !(rows <= f64::from(1 << 20)) {
            return Err(TableError::TooManySegments);
        }
        let relative_error = rest + interpolation_error(coefficients, 0.5 / per_octave).ok_or(TableError::Range)?;
        Ok(FixedLayout {
            rows: rows as usize,
            per_octave: NonZeroU32::new(per_octave as u32).ok_or(TableError::Target)?,
            first_octave: 32 - octaves as u32,
            relative_error,
        })
    }

    /// The part of the error target that remains for interpolation.
    fn budget(&self, rest: f64) -> Result<f64, TableError> {
        let budget = self.relative_error - rest;
        if budget > 0.1 * rest { Ok(budget) } else { Err(TableError::Target) }
    }
}
