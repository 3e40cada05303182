//! Table evaluation in integers, for processor cores without an FPU.

use fixed::types::{U0F32, U1F31};

use super::bound::TOP_MARGIN;
use super::interpolation::local_polynomial;
use super::{TableBuilder, TableError};

/// One, in the Q31 of row coordinates and voltages.
const ONE: f64 = (1_u32 << 31) as f64;
/// Number of [`U0F32`] steps up to the largest friction.
const FRICTION_STEPS: f64 = (1_u64 << 32) as f64;

/// A table in integers over borrowed rows, with `C` coefficients per row; created by [`TableBuilder::build_fixed`].
///
/// The input is a fraction of the largest friction, [`U0F32`]; the output is a fraction of the largest voltage,
/// [`U1F31`], which can represent 1. The number of leading zeros and the bits after the leading one select the row,
/// which is evaluated in Q31: one 64-bit product for the index and one for each coefficient but the last.
///
/// ```
/// use frixel_model::{Contact, Finger, TableBuilder, U0F32, U1F31};
/// let contact = Contact::new(&Finger::<f64>::EXAMPLE, 10e-6)?.under_load(0.5)?;
/// let builder = TableBuilder::new(&contact, 1e-6, 28e-3, 1e-3)?;
/// let mut rows = [[0; 4]; 64];
/// let table = builder.build_fixed(&mut rows)?;
/// let voltage = table.voltage(table.friction(0.01));
/// let friction_n = contact.electric_friction_n(voltage.to_num::<f64>() * table.voltage_max_v_rms());
/// assert!((friction_n / 0.01 - 1.0).abs() < 1e-3);
/// assert_eq!(table.voltage(U0F32::ZERO), U1F31::ZERO);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct FixedTable<'rows, const C: usize> {
    rows: &'rows [[i32; C]],
    rows_per_octave: u32,
    first_octave: u32,
    friction_max_n: f64,
    voltage_max_v_rms: f64,
}

impl<'rows, const C: usize> FixedTable<'rows, C> {
    pub(super) fn fill(builder: &TableBuilder<'_>, storage: &'rows mut [[i32; C]]) -> Result<Self, TableError> {
        let layout = builder.fixed_layout(C)?;
        let rows = storage.get_mut(..layout.rows).ok_or(TableError::TooManySegments)?;
        let contact = builder.contact;
        let friction_max_n = builder.friction_max_n;
        let friction_step_n = friction_max_n / FRICTION_STEPS;
        let voltage_max_v_rms = contact.voltage_v_rms(friction_max_n);
        let voltage_step_v_rms = voltage_max_v_rms / ONE;
        let point = |friction_n: f64| (friction_n, contact.voltage_v_rms(friction_n));
        let last = rows.len().saturating_sub(1);
        for (index, row) in rows.iter_mut().enumerate() {
            let (octave, part) = (index as u32 / layout.per_octave, index as u32 % layout.per_octave);
            let octave_n = friction_step_n * libm::scalbn(1.0, (layout.first_octave + octave) as i32);
            let step_n = octave_n / f64::from(layout.per_octave.get());
            let mut end = point(octave_n + step_n * f64::from(part + 1));
            if index == last {
                end.1 *= 1.0 - f64::from(TOP_MARGIN);
            }
            let start = point(octave_n + step_n * f64::from(part));
            // Each Q31 product with the position keeps only the upper word, which halves it; the coefficients
            // compensate for that.
            let mut unit = voltage_step_v_rms;
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
            friction_max_n,
            voltage_max_v_rms,
        })
    }

    /// The voltage, as a fraction of the largest, for an electric friction, as a fraction of the largest; zero below
    /// the range.
    #[inline]
    pub fn voltage(&self, friction: U0F32) -> U1F31 {
        U1F31::from_bits(self.voltage_bits(friction.to_bits()))
    }

    #[inline]
    fn voltage_bits(&self, friction: u32) -> u32 {
        let zeros = friction.leading_zeros();
        let Some(octave) = 31_u32.checked_sub(zeros + self.first_octave) else { return 0 };
        // The bits after the leading one, as a fraction of 2^32, times the rows per octave: the row, and the position
        // in it.
        let product = u64::from((friction << zeros) << 1) * u64::from(self.rows_per_octave);
        let index = octave * self.rows_per_octave + (product >> 32) as u32;
        let place = i64::from(product as u32 >> 1);
        let Some((highest, lower)) = self.rows.get(index as usize).and_then(|row| row.split_last()) else { return 0 };
        let step = |sum: i32, coefficient: &i32| coefficient.wrapping_add(((i64::from(sum) * place) >> 32) as i32);
        lower.iter().rev().fold(*highest, step) as u32
    }

    /// The largest electric friction, in newtons, which corresponds to a fraction of 1.
    pub fn friction_max_n(&self) -> f64 {
        self.friction_max_n
    }

    /// The largest voltage, in volts rms, which corresponds to a fraction of 1.
    pub fn voltage_max_v_rms(&self) -> f64 {
        self.voltage_max_v_rms
    }

    /// An electric friction in newtons as a fraction of the largest, rounded; zero below zero and for NaN, and the
    /// largest fraction from the largest friction on.
    pub fn friction(&self, electric_friction_n: f64) -> U0F32 {
        U0F32::from_bits(libm::rint(electric_friction_n / self.friction_max_n * FRICTION_STEPS) as u32)
    }

    /// The rows.
    pub fn rows(&self) -> &[[i32; C]] {
        self.rows
    }
}
