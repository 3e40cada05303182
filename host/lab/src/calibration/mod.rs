//! Records the data that [`fit`](crate::fit) needs: a board switches its drive on and off while a finger slides, and a
//! force sensor records.
//!
//! [`Protocol`] is the drive over time, [`align`] puts the sensor's clock on the board's, and [`write_csv`] writes the
//! recording. [`ForceSensor`] is the sensor under a simulated screen.

mod align;
mod force_sensor;
mod protocol;
mod simulated_finger;

use std::fmt::Write as _;
use std::io::{self, Read, Write};

use frixel_scene::Origin;
use serde::Serialize;
use thiserror::Error;

pub use align::{BoardRow, align};
pub use force_sensor::ForceSensor;
pub use protocol::{Protocol, REACH, VOLTAGE_MAX_V_RMS};
pub use simulated_finger::{simulated_finger, simulation_seed};

use crate::fit::{FORCE_MAX_N, Row};
use crate::table::{Column, Reading, Table, TableError, Unit, whole_rows};

/// A sample of a force sensor, on the sensor's own clock.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ForceRow {
    /// Time, in seconds.
    pub time_s: f64,
    /// Normal force, in newtons.
    pub normal_force_n: f64,
    /// Friction, in newtons.
    pub friction_n: f64,
}

/// Why a recording was not made.
#[derive(Debug, Error)]
pub enum CalibrationError {
    /// The forces cannot be read.
    #[error(transparent)]
    Forces(#[from] TableError),
    /// The file of the board's telemetry cannot be read.
    #[error("the board's telemetry cannot be read ({}): its file was changed", .0.found())]
    Board(TableError),
    /// The forces are not from this run, or cannot be joined with it.
    #[error("{0}")]
    Refused(String),
    /// The recording cannot be written.
    #[error("the recording cannot be written ({0}): check the folder and its free space")]
    Write(csv::Error),
}

const TIME: Column = Column::new("time_s", "seconds").converted(Unit::SECONDS);
const LOAD: Column = Column::new("normal_force_n", "newtons").converted(Unit::NEWTONS);
const FRICTION: Column = Column::new("friction_n", "newtons").converted(Unit::NEWTONS);
const VOLTAGE: Column = Column::new("voltage_v_rms", "volts rms");
const SPEED: Column = Column::new("speed_mm_s", "mm/s");

/// Reads the forces of a sensor from CSV with the columns `time_s,normal_force_n,friction_n`, in any order.
///
/// A last line without a line feed is left out: the sensor is still writing it.
/// Columns may state another unit ([`table`](crate::table)).
pub fn read_forces(mut input: impl Read) -> Result<Reading<Vec<ForceRow>>, CalibrationError> {
    let mut bytes = Vec::new();
    input.read_to_end(&mut bytes).map_err(TableError::from)?;
    let mut table = Table::new(whole_rows(&bytes))?;
    let (time, load, friction) = (table.need(TIME)?, table.need(LOAD)?, table.need(FRICTION)?);
    let mut rows: Vec<ForceRow> = Vec::new();
    while let Some(row) = table.next_row()? {
        row.check_length()?;
        let time_s = row.real(time)?;
        if rows.last().is_some_and(|last| time_s < last.time_s) {
            return Err(CalibrationError::Refused(format!(
                "row {} of the forces goes back in time: sort the rows by time",
                row.number()
            )));
        }
        let (normal_force_n, friction_n) = (row.real(load)?, row.real(friction)?);
        if let Some((place, found_n)) = [(load, normal_force_n), (friction, friction_n)]
            .into_iter()
            .find(|(_, force_n)| force_n.abs() > FORCE_MAX_N)
        {
            return Err(CalibrationError::Refused(format!(
                "row {}, column {}: {found_n} N is not a valid force of a finger: give newtons, at most 50, or name \
                 the column normal_force_mn or friction_mn if it is in millinewtons",
                row.number(),
                row.column(place)
            )));
        }
        rows.push(ForceRow { time_s, normal_force_n, friction_n });
    }
    Ok(Reading { value: rows, understood: table.understood() })
}

/// A row of the file that `frixel finger fit` reads.
#[derive(Serialize)]
struct Written<'r> {
    time_s: f64,
    stroke: &'r str,
    voltage_v_rms: f64,
    normal_force_n: f64,
    friction_n: f64,
    speed_mm_s: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    finger_origin: Option<&'static str>,
}

/// Writes the board's reports as CSV, which [`read_board`] reads: the column names, or rows to append.
pub fn write_board(mut output: impl Write, rows: Option<&[BoardRow]>) -> io::Result<()> {
    let mut text = String::new();
    if rows.is_none() {
        text.push_str("time_s,voltage_v_rms,speed_mm_s\n");
    }
    for BoardRow { time_s, voltage_v_rms, speed_mm_s } in rows.into_iter().flatten() {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{time_s:.6},{voltage_v_rms:.4},{speed_mm_s:.3}");
    }
    output.write_all(text.as_bytes()).and_then(|()| output.flush())
}

/// Reads what [`write_board`] wrote.
pub fn read_board(input: impl Read) -> Result<Vec<BoardRow>, CalibrationError> {
    board_rows(input).map_err(CalibrationError::Board)
}

fn board_rows(input: impl Read) -> Result<Vec<BoardRow>, TableError> {
    let mut table = Table::new(input)?;
    let (time, voltage, speed) = (table.need(TIME)?, table.need(VOLTAGE)?, table.need(SPEED)?);
    let mut rows = Vec::new();
    while let Some(row) = table.next_row()? {
        row.check_length()?;
        rows.push(BoardRow {
            time_s: row.real(time)?,
            voltage_v_rms: row.real(voltage)?,
            speed_mm_s: row.real(speed)?,
        });
    }
    Ok(rows)
}

/// Writes a recording as CSV, with a column that marks a simulated finger.
pub fn write_csv(output: impl Write, rows: &[Row]) -> Result<(), CalibrationError> {
    let mut writer = csv::Writer::from_writer(output);
    for row in rows {
        let written = Written {
            time_s: rounded(row.time_s.unwrap_or_default(), 1e-6),
            stroke: row.stroke.as_deref().unwrap_or_default(),
            voltage_v_rms: rounded(row.voltage_v_rms, 1e-3),
            normal_force_n: rounded(row.normal_force_n, 1e-6),
            friction_n: rounded(row.friction_n, 1e-6),
            speed_mm_s: rounded(row.speed_mm_s.unwrap_or_default(), 1e-3),
            finger_origin: row.is_simulated.then(|| Origin::Assumed.word()),
        };
        writer.serialize(written).map_err(CalibrationError::Write)?;
    }
    writer.flush().map_err(|error| CalibrationError::Write(error.into()))
}

fn rounded(value: f64, step: f64) -> f64 {
    (value / step).round() / (1.0 / step).round()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_cannot_be_read_is_said_in_words_of_its_own() {
        for (text, found) in [
            ("t,v,s\n1,2,3\n", "the header has no column time_s"),
            (
                "time_s,voltage_v_rms,speed_mm_s\n1,2,three\n",
                "row 2, column speed_mm_s: expected a number, found \"three\"",
            ),
            ("time_s,voltage_v_rms,speed_mm_s\n1,2\n", "row 2: expected 3 cells as in the header, found 2"),
        ] {
            let said = read_board(text.as_bytes()).err().map(|error| error.to_string()).unwrap_or_default();
            assert!(said.contains(found) && said.ends_with("its file was changed"), "{said}");
        }
    }
}
