//! Reads a recording from CSV text.

use std::io::Read;

use super::error::FitError;
use crate::table::{Column, Reading, Table, Unit};

/// Highest voltage that is read, in volts rms: above what any amplifier for touchscreens has.
const VOLTAGE_MAX_V_RMS: f64 = 1000.0;

const VOLTAGE: Column = Column::new("voltage_v_rms", "volts rms").converted(Unit::Volts);
const LOAD: Column = Column::new("normal_force_n", "newtons").converted(Unit::Newtons);
const FRICTION: Column = Column::new("friction_n", "newtons").converted(Unit::Newtons);
const TIME: Column = Column::new("time_s", "seconds").converted(Unit::Seconds);
const STROKE: Column = Column::new("stroke", "");
const SPEED: Column = Column::new("speed_mm_s", "mm/s").converted(Unit::MillimetresPerSecond);

/// A row of a recording.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// Number of the row in its file; the header is row 1.
    pub number: u64,
    /// Drive, in volts rms.
    pub voltage_v_rms: f64,
    /// Normal force, in newtons.
    pub normal_force_n: f64,
    /// Friction in newtons; its sign may say the direction.
    pub friction_n: f64,
    /// Time, in seconds.
    pub time_s: Option<f64>,
    /// Name of the stroke.
    pub stroke: Option<String>,
    /// Speed in mm/s; its sign may say the direction.
    pub speed_mm_s: Option<f64>,
}

/// Reads rows from CSV with a header. `voltage_v_rms`, `normal_force_n` and `friction_n` are needed; `time_s`, `stroke`
/// and `speed_mm_s` are read if there are such columns; others are ignored. Columns stand in any order, and may state
/// another unit ([`table`](crate::table)).
pub fn rows(input: impl Read) -> Result<Reading<Vec<Row>>, FitError> {
    let mut table = Table::new(input)?;
    let (voltage, load, friction) = (table.need(VOLTAGE)?, table.need(LOAD)?, table.need(FRICTION)?);
    let (time, stroke, speed) = (table.find(TIME)?, table.find(STROKE)?, table.find(SPEED)?);
    let mut rows = Vec::new();
    while let Some(row) = table.next_row()? {
        row.check_length()?;
        let number = row.number();
        let voltage_v_rms = row.real(voltage)?;
        if voltage_v_rms < 0.0 {
            return Err(FitError::NegativeVoltage { row: number, found: voltage_v_rms });
        }
        if voltage_v_rms > VOLTAGE_MAX_V_RMS {
            return Err(FitError::VoltageTooHigh { row: number, found: voltage_v_rms });
        }
        rows.push(Row {
            number,
            voltage_v_rms,
            normal_force_n: row.real(load)?,
            friction_n: row.real(friction)?,
            time_s: time.map(|time| row.real(time)).transpose()?,
            stroke: stroke.map(|stroke| row.text(stroke).into_owned()),
            speed_mm_s: speed.map(|speed| row.real(speed)).transpose()?,
        });
    }
    Ok(Reading { value: rows, understood: table.understood() })
}
