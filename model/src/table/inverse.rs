//! The inverse table of a microcontroller with an FPU: of fixed size, and built on the microcontroller itself.

use core::num::NonZeroU32;
use core::ops::Range;

use super::TableError;
use super::float::{FRICTION_MAX_N, RowGrid, round_down};
use super::interpolation::{Curve, Point};
use crate::double_single::DoubleSingle;
use crate::{CarriedContact, EmpiricalLaw, Finger, LawError, LawPoint, LoadedContact, Real, Ripple};

/// Number of rows in a table: 31.5 octaves, enough for 200 V down to 1 V if friction grows as the fourth power of the
/// voltage.
const ROWS: usize = 126;
/// Four rows per octave of 2^23 bit patterns. The `unwrap` is evaluated by the compiler.
const DENSITY: NonZeroU32 = NonZeroU32::new(4 << 9).unwrap();
/// Rows in a table of an empirical law: 15.75 octaves.
pub(crate) const LAW_ROWS: usize = ROWS;
/// Eight rows per octave for an empirical law, which may be steeper than a contact.
pub(crate) const LAW_DENSITY: NonZeroU32 = NonZeroU32::new(8 << 9).unwrap();
/// The table reaches down to at least this voltage.
const KNEE_V_RMS: f32 = 1.0;
/// Or down to this fraction of the largest voltage, if that is lower.
const KNEE_PART: f32 = 1.0 / 200.0;

/// Piecewise cubic from electric friction to rms voltage for one contact under one load; 2,032 bytes.
///
/// Rows below the range hold a straight line from zero to the voltage at the start of the range. A scene whose targets
/// stay below the largest reachable friction needs fewer rows: see [`InverseTable::build_up_to`].
///
/// ```
/// use frixel_model::{Contact, Finger, InverseTable};
/// let contact = Contact::new(&Finger::<f64>::EXAMPLE, 10e-6)?.under_load(0.5)?;
/// let table = InverseTable::build(&contact, 150.0)?;
/// let voltage_v_rms = table.voltage_v_rms(0.01);
/// let friction_n = contact.electric_friction_n(f64::from(voltage_v_rms));
/// assert!((friction_n / 0.01 - 1.0).abs() < 1e-5);
/// assert_eq!(table.voltage_v_rms(f32::NAN), 0.0);
/// assert_eq!(table.voltage_v_rms(1.0), 150.0);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
#[repr(C)]
pub struct InverseTable {
    grid: RowGrid,
    rows: [[f32; 4]; ROWS],
}

impl InverseTable {
    /// Bound on the relative error in electric friction, proven for every finger, coating and load of zero or more
    /// (9.9e-6, from `reference/table_constants.py`). Under a ripple it is not proven, but holds for every carrier,
    /// finger and load of `tests/carried.rs`.
    ///
    /// It holds from the friction at 1 V, or at 1/200 of the largest voltage if that is lower, to the friction at the
    /// largest voltage. For the example finger between 1 V and 200 V, the largest error over every `f32` is 3.6e-6
    /// without load and 1.8e-6 under 0.5 N: `cargo test --release -p frixel-model -- --ignored --nocapture`.
    pub const RELATIVE_ERROR: f32 = 1e-5;

    /// An empty table: zero volts for every finite friction. All its bits are zero, so that a static of it takes no
    /// flash.
    pub const EMPTY: Self = Self { grid: RowGrid::EMPTY, rows: [[0.0; 4]; ROWS] };

    /// Bytes of a row.
    pub const ROW_BYTES: usize = size_of::<[f32; 4]>();

    /// Builds the table for `contact`, up to `voltage_max_v_rms`. This takes about 250 evaluations of the closed form
    /// for the example finger, and at most 380, in double-single arithmetic (pairs of `f32`), as on a board. Its 13
    /// digits are far more precise than the rounding of the rows, as long as the scales of the contact are above 1e-24.
    pub fn build(contact: &LoadedContact<f64>, voltage_max_v_rms: f64) -> Result<Self, TableError> {
        Self::build_up_to(contact, voltage_max_v_rms, f32::INFINITY)
    }

    /// Builds the same table, truncated to the rows for electric frictions up to `up_to_n`; up to there, it returns
    /// the same bits. A truncated row needs no evaluation of the closed form; it holds the voltage at the end of the
    /// table. No row is truncated if `up_to_n` is NaN, or not below the largest friction.
    pub fn build_up_to(contact: &LoadedContact<f64>, voltage_max_v_rms: f64, up_to_n: f32) -> Result<Self, TableError> {
        if !(voltage_max_v_rms.is_finite() && round_down(voltage_max_v_rms) > 0.0) {
            return Err(TableError::Voltage);
        }
        let voltage_max_v_rms = DoubleSingle::from_f64(voltage_max_v_rms);
        let contact = contact.in_double_single().under_carrier(Ripple::NONE);
        let mut table = Self::EMPTY;
        table.begin_in_double_single(contact, voltage_max_v_rms, up_to_n)?.fill(&mut table, ROWS)?;
        Ok(table)
    }

    /// Builds the table of mean friction under a carrier from the parameters sent to a board: finger, effective gap of
    /// the coating in metres, normal load in newtons, the carrier's ripple, largest voltage in volts rms, and the
    /// truncation as in [`Self::build_up_to`]. Does not use `f64`.
    pub fn of_finger(
        finger: &Finger<f32>,
        gap_m: f32,
        normal_load_n: f32,
        ripple: &Ripple,
        voltage_max_v_rms: f32,
        up_to_n: f32,
    ) -> Result<Self, TableError> {
        let mut table = Self::EMPTY;
        table.begin(finger, gap_m, normal_load_n, ripple, voltage_max_v_rms, up_to_n)?.fill(&mut table, ROWS)?;
        Ok(table)
    }

    /// Starts building the table of [`Self::of_finger`] in place and in steps, so that a board can do other work in
    /// between. The table is only valid once [`InverseTableFilling::fill`] has finished.
    #[inline(never)]
    pub fn begin(
        &mut self,
        finger: &Finger<f32>,
        gap_m: f32,
        normal_load_n: f32,
        ripple: &Ripple,
        voltage_max_v_rms: f32,
        up_to_n: f32,
    ) -> Result<InverseTableFilling, TableError> {
        if !(voltage_max_v_rms.is_finite() && voltage_max_v_rms > 0.0) {
            return Err(TableError::Voltage);
        }
        let contact = LoadedContact::of_finger(finger, gap_m, normal_load_n).ok_or(TableError::Contact)?;
        self.begin_in_double_single(contact.under_carrier(*ripple), DoubleSingle::from(voltage_max_v_rms), up_to_n)
    }

    /// Builds the table of an empirical law, from the numbers sent to a board; see [`EmpiricalLaw::new`]. The
    /// truncation is as in [`Self::build_up_to`].
    ///
    /// [`Self::RELATIVE_ERROR`] holds for frictions above 2^-15 of that at the largest voltage. Below the range, the
    /// voltage is zero.
    ///
    /// ```
    /// use frixel_model::{EmpiricalLaw, InverseTable, LawPoint};
    /// let points = [(50.0, 0.01), (100.0, 0.06), (150.0, 0.09)]
    ///     .map(|(voltage_v_rms, electric_friction_n)| LawPoint { voltage_v_rms, electric_friction_n });
    /// let law = EmpiricalLaw::new(2.0, &points, 150.0)?;
    /// let table = InverseTable::of_law(2.0, &points, 150.0, f32::INFINITY)?;
    /// let voltage_v_rms = table.voltage_v_rms(0.05);
    /// assert!((law.electric_friction_n(f64::from(voltage_v_rms)) / f64::from(0.05_f32) - 1.0).abs() < 1e-5);
    /// # Ok::<(), Box<dyn core::error::Error>>(())
    /// ```
    pub fn of_law(exponent: f32, points: &[LawPoint], voltage_max_v_rms: f32, up_to_n: f32) -> Result<Self, LawError> {
        let mut table = Self::EMPTY;
        table.begin_law(exponent, points, voltage_max_v_rms, up_to_n)?.fill(&mut table, ROWS)?;
        Ok(table)
    }

    /// Starts building the table of [`Self::of_law`] in place and in steps, as [`Self::begin`] does for a finger.
    #[inline(never)]
    pub fn begin_law(
        &mut self,
        exponent: f32,
        points: &[LawPoint],
        voltage_max_v_rms: f32,
        up_to_n: f32,
    ) -> Result<EmpiricalTableFilling, LawError> {
        let curve = EmpiricalLaw::new(exponent, points, voltage_max_v_rms)?;
        let grid = curve.grid();
        let end = grid.end_row(ROWS, up_to_n, grid.start_n(0));
        let start = grid.start(0, &curve);
        self.grid = grid;
        self.rows.fill([0.0; 4]);
        Ok(EmpiricalTableFilling(Filling { curve, rows: 0..end, start }))
    }

    fn begin_in_double_single(
        &mut self,
        contact: CarriedContact<DoubleSingle>,
        voltage_max_v_rms: DoubleSingle,
        up_to_n: f32,
    ) -> Result<InverseTableFilling, TableError> {
        let largest = round_down(voltage_max_v_rms);
        let knee_v_rms = KNEE_V_RMS.min(largest * KNEE_PART);
        let knee_n = round_down(contact.electric_friction_n(DoubleSingle::from(knee_v_rms)));
        let friction_max_n = round_down(contact.electric_friction_n(DoubleSingle::from(largest)));
        if !(knee_n >= f32::MIN_POSITIVE && friction_max_n < f32::MAX) {
            return Err(TableError::Unrepresentable);
        }
        let grid = RowGrid::new(ROWS, DENSITY, friction_max_n, largest)?;
        let knee_row = grid.row(knee_n);
        if knee_row >= ROWS {
            return Err(TableError::TooManySegments);
        }
        if friction_max_n > FRICTION_MAX_N {
            return Err(TableError::Unrepresentable);
        }
        let end = grid.end_row(ROWS, up_to_n, knee_n);
        let start = grid.start(knee_row, &contact);
        let (knee_start_n, knee_start_v_rms) = start;
        let line = [0.0, (knee_start_v_rms / knee_start_n).to_f32(), 0.0, 0.0];
        self.grid = grid;
        self.rows.fill(line);
        Ok(InverseTableFilling(Filling { curve: contact, rows: knee_row..end, start }))
    }

    /// Empties the table, in a few instructions: later rows keep their numbers, and are not read.
    pub fn clear(&mut self) {
        self.grid = RowGrid::EMPTY;
        // An empty grid leads to the first row for every friction.
        if let Some(first) = self.rows.first_mut() {
            *first = [0.0; 4];
        }
    }

    /// Whether the table is empty, as [`Self::EMPTY`] and after [`Self::clear`].
    #[inline]
    pub fn is_empty(&self) -> bool {
        self.grid.is_empty()
    }

    /// Number of rows that hold a piece of the curve; only these are computed from the closed form.
    pub fn rows_filled(&self) -> usize {
        // The line towards zero and the constant in truncated rows have no curvature; the curve has it everywhere.
        self.rows.iter().filter(|[_, _, curvature, _]| curvature.abs() > 0.0).count()
    }

    /// The rms voltage for an electric friction in newtons.
    ///
    /// The friction at the returned voltage is within [`Self::RELATIVE_ERROR`] of the target. The voltage is zero for a
    /// negative friction and for NaN. Above the largest friction it is the largest voltage, which it never exceeds.
    /// Below the range it falls along a straight line to zero; for an empirical law, it is zero there.
    #[inline]
    pub fn voltage_v_rms(&self, electric_friction_n: f32) -> f32 {
        self.grid.evaluate(&self.rows, electric_friction_n)
    }

    /// The electric friction at the largest voltage, in newtons, rounded down; for a truncated table, at its end.
    pub fn electric_friction_max_n(&self) -> f32 {
        self.grid.friction_max_n()
    }

    /// The largest voltage, in volts rms, rounded down; for a truncated table, at its end.
    pub fn voltage_max_v_rms(&self) -> f32 {
        self.grid.voltage_max_v_rms()
    }
}

/// The remaining computation of an [`InverseTable`]; created by [`InverseTable::begin`].
#[derive(Clone, Debug)]
pub struct InverseTableFilling(Filling<CarriedContact<DoubleSingle>>);

impl InverseTableFilling {
    /// Number of rows that are still to be computed.
    pub fn rows(&self) -> usize {
        self.0.rows.len()
    }

    /// Computes the next `rows_max` rows, with three evaluations of the closed form each, and under a
    /// ripple up to four steps over eight levels for each of them. `table` must be the table
    /// that was begun. Returns whether it is finished.
    pub fn fill(&mut self, table: &mut InverseTable, rows_max: usize) -> Result<bool, TableError> {
        self.0.fill(table, rows_max)
    }
}

/// The remaining computation of the [`InverseTable`] of an empirical law; created by [`InverseTable::begin_law`].
#[derive(Clone, Debug)]
pub struct EmpiricalTableFilling(Filling<EmpiricalLaw>);

impl EmpiricalTableFilling {
    /// Number of rows that are still to be computed.
    pub fn rows(&self) -> usize {
        self.0.rows.len()
    }

    /// Computes the next `rows_max` rows, with three powers each. `table` must be the table that was begun. Returns
    /// whether it is finished.
    pub fn fill(&mut self, table: &mut InverseTable, rows_max: usize) -> Result<bool, LawError> {
        let found = table.electric_friction_max_n();
        self.0.fill(table, rows_max).map_err(|_: TableError| LawError::Friction { found })
    }
}

/// The rows of a table that are still to be computed, and their curve.
#[derive(Clone, Debug)]
struct Filling<C> {
    curve: C,
    rows: Range<usize>,
    /// The point of the curve at the start of the first of `rows`.
    start: Point<DoubleSingle>,
}

impl<C: Curve<DoubleSingle>> Filling<C> {
    fn fill(&mut self, table: &mut InverseTable, rows_max: usize) -> Result<bool, TableError> {
        let Range { start, end } = self.rows;
        let next = end.min(start.saturating_add(rows_max));
        self.start = table.grid.fill(&self.curve, &mut table.rows, start..next, self.start)?;
        self.rows.start = next;
        if next < end {
            return Ok(false);
        }
        if let Some((cut, end_v_rms)) = table.rows.get_mut(end..).zip(table.grid.cut_at(end, &self.curve)) {
            cut.fill([end_v_rms, 0.0, 0.0, 0.0]);
        }
        Ok(true)
    }
}
