//! Strokes as CSV text, from a person's finger or a program.

use std::io::Read;

use frixel_hil_sim::{Point, Stroke, StrokeError, StrokeRow};
use thiserror::Error;

use crate::fit::FORCE_MAX_N;
use crate::recording::is_play_column;
use crate::simulate::{STROKE_MAX_S, StrokeOptionsError};
use crate::table::{Column, Place, Row, Table, TableError, Unit};

const TIME: Column = Column::new("t_s", "seconds").converted(Unit::SECONDS);
const X: Column = Column::new("x_mm", "mm from the left edge of the screen").converted(Unit::MILLIMETRES);
const Y: Column = Column::new("y_mm", "mm from the top edge of the screen").converted(Unit::MILLIMETRES);
/// The normal load, which may be left out.
pub(crate) const LOAD: Column = Column::new("force_n", "newtons").converted(Unit::NEWTONS);
/// The columns that a stroke needs.
pub(crate) const COLUMNS: [Column; 3] = [TIME, X, Y];
/// Largest first time that is on the stroke's own clock, s. Larger ones are uptime or Unix time.
const START_MAX_S: f64 = 10.0;
const MM_PER_M: f64 = 1e3;

/// Why a file is not a stroke.
#[derive(Debug, Error)]
pub enum StrokeFileError {
    /// A needed column is missing, or a cell is not a number.
    #[error(transparent)]
    Table(#[from] TableError),
    /// A number is not one of a stroke.
    #[error("row {row}, column {column}: {reason}{}", .if_in_file)]
    Number {
        /// Number of its row; the header is row 1.
        row: u64,
        /// The name of its column.
        column: &'static str,
        /// The value that was found, and the expected one.
        reason: String,
        /// Further advice, for numbers of a file.
        if_in_file: &'static str,
    },
    /// The rows do not describe a stroke of a finger.
    #[error("{0}")]
    Refused(String),
    /// The finger cannot follow these places.
    #[error(transparent)]
    Stroke(#[from] StrokeError),
}

/// A stroke that was read from a file.
#[derive(Clone, Debug)]
pub struct StrokeFile {
    /// The stroke.
    pub stroke: Stroke,
    /// Names of columns that are neither part of a stroke nor written by a play.
    pub ignored_columns: Vec<String>,
    /// Description of the detected format, as from [`Table::understood`].
    pub understood: Option<String>,
}

impl StrokeFile {
    /// Reads a stroke from CSV with the columns `t_s,x_mm,y_mm`, in any order, and `force_n` if the normal load is
    /// known, in N and above 0; an empty cell is an unknown load. The finger is off the screen in a row whose cells
    /// `x_mm` and `y_mm` are empty, as in `felt.csv`, or `nan`.
    ///
    /// Time is from the start of the stroke and rises from row to row. Times that begin above 10 s are on another
    /// clock, and are counted from the first row. The finger touches down at the first row and lifts after the last.
    /// Between rows it moves straight at constant speed (linear interpolation), so the rows should be as close as the
    /// motion needs: every 10 ms or less for a hand.
    pub fn read(input: impl Read) -> Result<Self, StrokeFileError> {
        let mut table = Table::new(input)?;
        let places = [table.need(TIME)?, table.need(X)?, table.need(Y)?];
        let load = table.find(LOAD)?;
        let mut ignored_columns = table.ignored();
        ignored_columns.retain(|name| !is_play_column(name));
        let mut understood = table.understood();
        let mut rows: Vec<StrokeRow> = Vec::new();
        while let Some(row) = table.next_row()? {
            let read = stroke_row(&row, places, load)?;
            let (row, found_s) = (row.number(), read.t_s);
            if found_s < 0.0 {
                let reason = format!("{found_s} is below 0: give time from the start of the stroke");
                return Err(refused(row, TIME, reason));
            }
            if let Some(previous_s) = rows.last().map(|row| row.t_s).filter(|previous_s| *previous_s >= found_s) {
                let reason = format!("{found_s} comes after {previous_s}: give times that rise from row to row");
                return Err(refused(row, TIME, reason));
            }
            rows.push(read);
        }
        if let Some(start_s) = rows.first().map(|row| row.t_s).filter(|start_s| *start_s > START_MAX_S) {
            for row in &mut rows {
                row.t_s -= start_s;
            }
            let note = format!("times count from the first row, {start_s} s");
            understood = Some(understood.map_or(note.clone(), |words| format!("{words}; {note}")));
        }
        if rows.len() < 2 {
            let found = if rows.is_empty() { "no rows" } else { "one row only" };
            return Err(StrokeFileError::Refused(format!(
                "the stroke has {found}: give at least two, so that the finger moves in time"
            )));
        }
        let stroke = Stroke::through_rows(&rows)?;
        let seconds = stroke.duration_s();
        if seconds > STROKE_MAX_S {
            let too_long = StrokeOptionsError::TooLong { seconds };
            return Err(StrokeFileError::Refused(format!("{too_long}; its times are in seconds")));
        }
        Ok(Self { stroke, ignored_columns, understood })
    }
}

/// Formats rows as CSV that [`StrokeFile::read`] reads back exactly: time in s, position in mm, and normal load in N.
/// Unknown values are not-a-number.
pub fn to_csv(rows: impl IntoIterator<Item = [f64; 4]>) -> String {
    let mut text = String::from("t_s,x_mm,y_mm,force_n\n");
    for row in rows {
        let cells = row.map(|number| if number.is_nan() { String::new() } else { number.to_string() });
        text += &cells.join(",");
        text.push('\n');
    }
    text
}

fn stroke_row(row: &Row, [t, x, y]: [Place; 3], load: Option<Place>) -> Result<StrokeRow, StrokeFileError> {
    row.check_length()?;
    let t_s = row.real(t)?;
    let (x_mm, y_mm) = match (row.real_if_known(x)?, row.real_if_known(y)?) {
        (Some(x_mm), Some(y_mm)) => (x_mm, y_mm),
        (None, None) => return Ok(StrokeRow { t_s, place: None, normal_load_n: None }),
        (x_mm, _) => {
            let (unknown, known) = if x_mm.is_none() { (X, Y) } else { (Y, X) };
            let reason = format!(
                "unknown, where {} is known: give both, or neither while the finger is off the screen",
                known.name
            );
            return Err(refused(row.number(), unknown, reason));
        }
    };
    let place = Point { x_m: x_mm / MM_PER_M, y_m: y_mm / MM_PER_M };
    let normal_load_n = load.map(|load| row.real_if_known(load)).transpose()?.flatten();
    match normal_load_n.filter(|load_n| !(*load_n > 0.0 && *load_n <= FORCE_MAX_N)) {
        Some(found_n) => Err(StrokeFileError::Number {
            row: row.number(),
            column: LOAD.name,
            reason: format!("{found_n} is not a valid load of a finger: give newtons, above 0 and at most 50"),
            if_in_file: ", or name the column force_mn if it is in millinewtons",
        }),
        None => Ok(StrokeRow { t_s, place: Some(place), normal_load_n }),
    }
}

fn refused(row: u64, column: Column, reason: String) -> StrokeFileError {
    StrokeFileError::Number { row, column: column.name, reason, if_in_file: "" }
}

#[cfg(test)]
mod tests {
    use frixel_hil_sim::{Point, Stroke, StrokeRow};

    use super::{StrokeFile, to_csv};

    #[test]
    fn rows_are_written_and_read_to_the_bit() {
        let rows = [
            [0.0, 10.0 / 3.0, 1e-17, 0.7],
            [0.1 + 0.2, 12_345.678_9, -1.5, f64::NAN],
            [0.5, f64::NAN, f64::NAN, f64::NAN],
            [7e4 + 0.1, 7.0, 8.0, 0.1],
            [8.64e4, 7.0, 8.0, 0.3],
        ];
        let text = to_csv(rows);
        assert_eq!(text.lines().nth(3), Some("0.5,,,"));
        let read = StrokeFile::read(text.as_bytes()).unwrap();
        assert_eq!((read.ignored_columns.len(), read.understood), (0, None));
        let place = |row: [f64; 4]| (!row[1].is_nan()).then(|| Point { x_m: row[1] / 1e3, y_m: row[2] / 1e3 });
        let load = |row: [f64; 4]| (!row[3].is_nan()).then_some(row[3]);
        let of_rows = rows.map(|row| StrokeRow { t_s: row[0], place: place(row), normal_load_n: load(row) });
        let stroke = Stroke::through_rows(&of_rows).unwrap();
        for t_s in [0.0, 0.1, 0.3, 0.4, 8e4] {
            assert_eq!(read.stroke.at(t_s), stroke.at(t_s), "{t_s} s");
            assert_eq!(read.stroke.normal_load_n(t_s), stroke.normal_load_n(t_s), "{t_s} s");
        }
        assert!(stroke.at(0.1).is_some() && stroke.normal_load_n(8e4).is_some());
    }

    #[test]
    fn a_stroke_on_another_clock_begins_at_its_first_row() {
        for start in ["36355", "1610457271.0"] {
            let end: f64 = start.parse::<f64>().unwrap() + 1.0;
            let text = format!("t_s,x_mm,y_mm\n{start},20,40\n{end},80,40\n");
            let read = StrokeFile::read(text.as_bytes()).unwrap();
            assert!((read.stroke.at(0.5).unwrap().x_m - 0.05).abs() < 1e-12);
            assert!(read.stroke.at(1.1).is_none(), "it lasts a second");
            assert!(read.understood.unwrap().starts_with("times count from the first row, "));
        }
        let waits = StrokeFile::read("t_s,x_mm,y_mm\n9,20,40\n10,80,40\n".as_bytes()).unwrap();
        assert!(waits.understood.is_none() && waits.stroke.at(0.5).is_none() && waits.stroke.at(9.5).is_some());
    }

    #[test]
    fn not_a_number_is_a_lifted_finger() {
        let text = "t_s,x_mm,y_mm\n0,nan,NaN\n1,10,30\n1.5,60,30\n2,nan,nan\n";
        let stroke = StrokeFile::read(text.as_bytes()).unwrap().stroke;
        assert!(stroke.at(0.5).is_none() && stroke.at(1.25).is_some() && stroke.at(1.75).is_none());
        assert!(StrokeFile::read("t_s,x_mm,y_mm\n0,nan,1\n1,1,1\n".as_bytes()).is_err());
    }
}
