//! Strokes as CSV text.

use csv::{ReaderBuilder, StringRecord, Trim};

use super::rows::{Row, Rows};
use super::{Point, StrokeError};

const COLUMNS: [&str; 3] = ["t_s", "x_mm", "y_mm"];
/// Column of the normal load, which may be left out.
const FORCE_COLUMN: &str = "force_n";
/// A load above it is one in another unit.
const LOAD_MAX_N: f64 = 50.0;
const MM_PER_M: f64 = 1e3;

/// Parses CSV text into a motion.
pub(super) fn rows(text: &str) -> Result<Rows, StrokeError> {
    let mut reader = ReaderBuilder::new().flexible(true).trim(Trim::All).from_reader(text.as_bytes());
    let malformed = |error: csv::Error| StrokeError::Malformed { reason: error.to_string() };
    let header = reader.headers().map_err(malformed)?.clone();
    if header.is_empty() {
        return Err(StrokeError::Empty);
    }
    let columns = find_columns(&header, line_of(&header, text))?;
    let force_column = header.iter().position(|name| name == FORCE_COLUMN);
    let mut rows: Vec<Row> = Vec::new();
    let mut lines = Vec::new();
    for record in reader.records() {
        let record = record.map_err(malformed)?;
        let line = line_of(&record, text);
        let mut row = row(&record, line, columns)?;
        if row.place.is_some() {
            row.load_n = load_n(&record, line, force_column)?;
        }
        if row.t_s < 0.0 {
            return Err(StrokeError::BeforeStart { line, found_s: row.t_s });
        }
        if let Some(previous) = rows.last().filter(|previous| previous.t_s >= row.t_s) {
            return Err(StrokeError::NotRising { line, found_s: row.t_s, previous_s: previous.t_s });
        }
        rows.push(row);
        lines.push(line);
    }
    match lines.as_slice() {
        [] => Err(StrokeError::Empty),
        [line] => Err(StrokeError::OneRow { line: *line }),
        lines => Rows::new(&rows)
            .map_err(|number| StrokeError::Jump { line: lines.get(number).copied().unwrap_or_default() }),
    }
}

/// Returns the index of each of [`COLUMNS`] in the header.
fn find_columns(header: &StringRecord, line: u64) -> Result<[usize; 3], StrokeError> {
    let mut places = [0; 3];
    for (place, column) in places.iter_mut().zip(COLUMNS) {
        *place = header.iter().position(|name| name == column).ok_or_else(|| StrokeError::MissingColumn {
            line,
            column,
            found: header.iter().collect::<Vec<_>>().join(","),
        })?;
    }
    Ok(places)
}

fn row(record: &StringRecord, line: u64, places: [usize; 3]) -> Result<Row, StrokeError> {
    let cells = places.map(|place| record.get(place).unwrap_or_default());
    let [t_cell, x_cell, y_cell] = cells;
    let is_lifted = x_cell.is_empty() && y_cell.is_empty() && places.iter().all(|place| *place < record.len());
    if is_lifted {
        return Ok(Row { t_s: number(t_cell, line, COLUMNS[0])?, place: None, load_n: f64::NAN });
    }
    let mut values = [0.0; 3];
    for ((value, cell), column) in values.iter_mut().zip(cells).zip(COLUMNS) {
        *value = number(cell, line, column)?;
    }
    let [t_s, x_mm, y_mm] = values;
    Ok(Row { t_s, place: Some(Point { x_m: x_mm / MM_PER_M, y_m: y_mm / MM_PER_M }), load_n: f64::NAN })
}

/// The normal load of a row, in N; not a number without a column for it.
fn load_n(record: &StringRecord, line: u64, column: Option<usize>) -> Result<f64, StrokeError> {
    let Some(column) = column else { return Ok(f64::NAN) };
    let found_n = number(record.get(column).unwrap_or_default(), line, FORCE_COLUMN)?;
    if found_n > 0.0 && found_n <= LOAD_MAX_N { Ok(found_n) } else { Err(StrokeError::NoLoad { line, found_n }) }
}

fn number(cell: &str, line: u64, column: &'static str) -> Result<f64, StrokeError> {
    if cell.is_empty() {
        return Err(StrokeError::MissingValue { line, column });
    }
    let found = || cell.to_owned();
    let value: f64 = cell.parse().map_err(|_| StrokeError::NotANumber { line, column, found: found() })?;
    if value.is_finite() { Ok(value) } else { Err(StrokeError::NotFinite { line, column, found: found() }) }
}

/// Returns the line number of a record in `text`. The reader itself reports the first of the empty lines that it
/// skipped.
fn line_of(record: &StringRecord, text: &str) -> u64 {
    let Some(position) = record.position() else { return 1 };
    let skipped = text.bytes().skip(position.byte() as usize).take_while(|byte| matches!(byte, b'\r' | b'\n'));
    position.line() + skipped.filter(|&byte| byte == b'\n').count() as u64
}
