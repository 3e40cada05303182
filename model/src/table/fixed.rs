//! The evaluator in integers, for cores without an FPU.

use super::bound::TOP_MARGIN;
use super::interpolation::local_polynomial;
use super::{TableBuilder, TableError};

/// One, in the Q31 of row coordinates and voltages.
const ONE: f64 = (1_u32 << 31) as f64;
/// Friction codes to the largest friction.
const CODES: f64 = (1_u64 << 32) as f64;

/// A table in integers over rows that someone else owns, with `C` coefficients a row: from
/// [`TableBuilder::build_fixed`].
///
/// Friction goes in as a code of 32 bits, of which 2^32 are the largest friction; voltage comes out as a code of which
/// 2^31 are the largest voltage. A row is found by the leading zeros and the bits behind the leading one, and evaluated in
/// Q31: one 64-bit product for the index and one for each coefficient but the last. Plain integers do this with two shifts
/// and no dependency; a fixed-point crate would only name them.
#[derive(Clone, Debug, PartialEq)]
pub struct FixedTable<'rows, const C: usize> {
    rows: &'rows [[i32; C]],
    rows_per_octave: u32,
    first_octave: u32,
    friction_unit_n: f64,
    voltage_unit_v_rms: f64,
}

impl<'rows, const C: usize> FixedTable<'rows, C> {
    pub(super) fn fill(builder: &TableBuilder<'_>, storage: &'rows mut [[i32; C]]) -> Result<Self, TableError> {
        let layout = builder.fixed_layout(C)?;
        let rows = storage.get_mut(..layout.rows).ok_or(TableError::TooManySegments)?;
        let contact = builder.contact;
        let friction_unit_n = builder.friction_max_n / CODES;
        let voltage_unit_v_rms = contact.voltage_v_rms(builder.friction_max_n) / ONE;
        let point = |friction_n: f64| (friction_n, contact.voltage_v_rms(friction_n));
        let last = rows.len().saturating_sub(1);
        for (index, row) in rows.iter_mut().enumerate() {
            let (octave, part) = (index as u32 / layout.per_octave, index as u32 % layout.per_octave);
            let octave_n = friction_unit_n * libm::scalbn(1.0, (layout.first_octave + octave) as i32);
            let step_n = octave_n / f64::from(layout.per_octave.get());
            let mut end = point(octave_n + step_n * f64::from(part + 1));
            if index == last {
                end.1 *= 1.0 - f64::from(TOP_MARGIN);
            }
            let start = point(octave_n + step_n * f64::from(part));
            // Each product with the place, in Q31, keeps the upper word only and so halves: the coefficients make up for it.
            let mut unit = voltage_unit_v_rms;
            *row = local_polynomial::<C>(contact, start, end).map(|coefficient| {
                let code = libm::rint(coefficient / unit) as i32;
                unit *= 0.5;
                code
            });
        }
        Ok(Self {
            rows,
            rows_per_octave: layout.per_octave.get(),
            first_octave: layout.first_octave,
            friction_unit_n,
            voltage_unit_v_rms,
        })
    }

    /// The voltage code for a friction code; zero below the range.
    #[inline]
    pub fn voltage_code(&self, friction_code: u32) -> u32 {
        let zeros = friction_code.leading_zeros();
        let Some(octave) = 31_u32.checked_sub(zeros + self.first_octave) else { return 0 };
        // What stands behind the leading one, as a fraction of 2^32, times the rows of an octave: row and place in it.
        let product = u64::from((friction_code << zeros) << 1) * u64::from(self.rows_per_octave);
        let index = octave * self.rows_per_octave + (product >> 32) as u32;
        let place = i64::from(product as u32 >> 1);
        let Some((highest, lower)) = self.rows.get(index as usize).and_then(|row| row.split_last()) else { return 0 };
        let step = |sum: i32, coefficient: &i32| coefficient.wrapping_add(((i64::from(sum) * place) >> 32) as i32);
        lower.iter().rev().fold(*highest, step) as u32
    }

    /// Newtons to one friction code.
    pub fn friction_unit_n(&self) -> f64 {
        self.friction_unit_n
    }

    /// Volts rms to one voltage code.
    pub fn voltage_unit_v_rms(&self) -> f64 {
        self.voltage_unit_v_rms
    }

    /// The friction code of an electric friction in newtons: rounded, zero below zero and for not-a-number, and the largest
    /// code above the range.
    pub fn friction_code(&self, electric_friction_n: f64) -> u32 {
        libm::rint(electric_friction_n / self.friction_unit_n) as u32
    }
}
