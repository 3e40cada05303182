//! Reads a recording from CSV text.

use std::borrow::Cow;
use std::io::Read;

use frixel_scene::Origin;

use super::error::{FitError, plain};
use super::means::{self, MeanRow};
use crate::table::{Column, Place, Reading, Row as TableRow, Table, Unit, not_a_number};

/// Highest voltage that is read, in volts rms: above what any amplifier for touchscreens has.
const VOLTAGE_MAX_V_RMS: f64 = 1000.0;

pub(super) const VOLTAGE: Column = Column::new("voltage_v_rms", "volts rms").converted(Unit::VOLTS);
pub(super) const LOAD: Column = Column::new("normal_force_n", "newtons").converted(Unit::NEWTONS);
pub(super) const FRICTION: Column = Column::new("friction_n", "newtons").converted(Unit::NEWTONS);
pub(super) const TIME: Column = Column::new("time_s", "seconds").converted(Unit::SECONDS);
pub(super) const STROKE: Column = Column::new("stroke", "");
/// The kind of evidence, as in a profile's `origin`.
pub(crate) const ORIGIN: Column = Column::new("finger_origin", "");
pub(super) const SPEED: Column = Column::new("speed_mm_s", "mm/s").converted(Unit::MILLIMETRES_PER_SECOND);

/// The columns that a recording needs.
pub(crate) const COLUMNS: [Column; 3] = [VOLTAGE, LOAD, FRICTION];

/// A row of a recording. Unknown values are `None`.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Number of the row in its file; the header is row 1.
    pub number: u64,
    /// Drive, in volts rms.
    pub voltage_v_rms: f64,
    /// Normal force, in newtons.
    pub normal_force_n: f64,
    /// Friction in newtons; its sign may state the direction.
    pub friction_n: f64,
    /// Time, in seconds.
    pub time_s: Option<f64>,
    /// Name of the stroke.
    pub stroke: Option<String>,
    /// Speed in mm/s; its sign may state the direction.
    pub speed_mm_s: Option<f64>,
    /// Whether the finger is simulated: `finger_origin` is `assumed`.
    pub is_simulated: bool,
}

/// The contents of a table for a fit.
#[derive(Clone, Debug, PartialEq)]
pub enum Data {
    /// Samples of a force sensor.
    Recording(Vec<Row>),
    /// Means with their errors.
    Means(Vec<MeanRow>),
}

/// Reads the data of a fit. A table with a column `friction_se_n` (standard errors) or `friction_sd_n` (standard
/// deviations, with `n`) has means in `friction_n`; others are recordings, as [`rows`] reads them.
pub fn data(input: impl Read) -> Result<Reading<Data>, FitError> {
    let mut table = Table::new(input)?;
    if let Some(errors) = means::Errors::find(&mut table)? {
        let Reading { value, understood } = means::read(table, &errors)?;
        return Ok(Reading { value: Data::Means(value), understood });
    }
    let Reading { value, understood } = recording(table)?;
    Ok(Reading { value: Data::Recording(value), understood })
}

/// Reads rows from CSV with a header. `voltage_v_rms`, `normal_force_n` and `friction_n` are needed. `time_s`,
/// `stroke`, `speed_mm_s` and `finger_origin` are optional, and their empty cells and `nan` are unknown; other columns
/// are ignored. Columns stand in any order, and may state another unit ([`table`](crate::table)).
pub fn rows(input: impl Read) -> Result<Reading<Vec<Row>>, FitError> {
    recording(Table::new(input)?)
}

/// Whether the column [`ORIGIN`] of a row marks a simulated finger.
pub(crate) fn is_simulated(row: &TableRow<'_>, origin: Option<Place>) -> bool {
    origin.and_then(|origin| row.known(origin)).is_some_and(|word| word == Origin::Assumed.word())
}

fn recording<R: Read>(mut table: Table<R>) -> Result<Reading<Vec<Row>>, FitError> {
    let (voltage, load, friction) = (table.need(VOLTAGE)?, table.need(LOAD)?, table.need(FRICTION)?);
    let (time, stroke, speed) = (table.find(TIME)?, table.find(STROKE)?, table.find(SPEED)?);
    let origin = table.find(ORIGIN)?;
    let mut rows = Vec::new();
    while let Some(row) = table.next_row()? {
        row.check_length()?;
        let real_if_known = |place: Option<Place>| place.map(|place| row.real_if_known(place)).transpose();
        rows.push(Row {
            number: row.number(),
            voltage_v_rms: row.real(voltage)?,
            normal_force_n: row.real(load)?,
            friction_n: row.real(friction)?,
            time_s: real_if_known(time)?.flatten(),
            stroke: stroke.and_then(|stroke| row.known(stroke)).map(Cow::into_owned),
            speed_mm_s: real_if_known(speed)?.flatten(),
            is_simulated: is_simulated(&row, origin),
        });
    }
    check_numbers(&rows)?;
    Ok(Reading { value: rows, understood: table.understood() })
}

/// Fails if a number of a row is not finite, or its voltage none of a driver.
pub(super) fn check_numbers(rows: &[Row]) -> Result<(), FitError> {
    for row in rows {
        let optional = [(TIME, row.time_s), (SPEED, row.speed_mm_s)];
        let optional = optional.into_iter().filter_map(|(column, value)| Some((column, value?)));
        let numbers = [(VOLTAGE, row.voltage_v_rms), (LOAD, row.normal_force_n), (FRICTION, row.friction_n)];
        if let Some((column, value)) = numbers.into_iter().chain(optional).find(|(_, value)| !value.is_finite()) {
            return Err(not_a_number(row.number, column.name, &value.to_string()).into());
        }
        check_voltage(row.number, row.voltage_v_rms)?;
    }
    Ok(())
}

/// Fails if no driver has this voltage.
pub(super) fn check_voltage(row: u64, found: f64) -> Result<(), FitError> {
    let fault = match found {
        found if found < 0.0 => "is below zero: give the root mean square of the drive, which has no sign",
        found if found > VOLTAGE_MAX_V_RMS => {
            "is above 1000 V: give volts rms, not DAC codes, or name the column voltage_mv_rms if it is in millivolts"
        }
        _ => return Ok(()),
    };
    Err(FitError::Refused(format!("row {row}, column voltage_v_rms: {} V {fault}", plain(found))))
}
