//! Reads a recording from CSV text.

use std::io::{self, Read};

use csv::ByteRecord;

use super::error::FitError;

/// Similarity from which one name is suggested for another, as a part of their length.
const LIKENESS: f64 = 0.6;
/// Highest voltage that is read, in volts rms: above what any amplifier for touchscreens has.
const VOLTAGE_MAX_V_RMS: f64 = 1000.0;
/// Number of characters of a cell that a message quotes.
const QUOTED_CHARS: usize = 40;

/// What stands between columns where the decimal sign is a comma, with its name.
const OTHER_SEPARATORS: [(char, &str); 2] = [(';', "semicolons"), ('\t', "tabs")];

const VOLTAGE: &str = "voltage_v_rms";
const LOAD: &str = "normal_force_n";
const FRICTION: &str = "friction_n";
const TIME: &str = "time_s";
const STROKE: &str = "stroke";
const SPEED: &str = "speed_mm_s";

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

/// Positions of the columns.
struct Columns {
    voltage: usize,
    load: usize,
    friction: usize,
    time: Option<usize>,
    stroke: Option<usize>,
    speed: Option<usize>,
}

/// Reads rows from CSV with a header. `voltage_v_rms`, `normal_force_n` and `friction_n` are needed; `time_s`, `stroke`
/// and `speed_mm_s` are read if there are such columns; others are ignored. Columns stand in any order.
pub fn rows(input: impl Read) -> Result<Vec<Row>, FitError> {
    let mut reader =
        csv::ReaderBuilder::new().flexible(true).trim(csv::Trim::All).comment(Some(b'#')).from_reader(input);
    let columns = Columns::new(reader.byte_headers().map_err(unreadable)?)?;
    let mut rows = Vec::new();
    for record in reader.byte_records() {
        let record = record.map_err(unreadable)?;
        let number = record.position().map_or(0, csv::Position::line);
        rows.push(columns.row(number, &record)?);
    }
    Ok(rows)
}

fn unreadable(error: csv::Error) -> FitError {
    FitError::Read(match error.into_kind() {
        csv::ErrorKind::Io(error) => error,
        other => io::Error::other(format!("{other:?}")),
    })
}

impl Columns {
    fn new(header: &ByteRecord) -> Result<Self, FitError> {
        let names: Vec<_> = header
            .iter()
            .map(|cell| String::from_utf8_lossy(cell).trim().trim_start_matches('\u{feff}').to_owned())
            .collect();
        if let [only] = &names[..]
            && let Some((_, found)) = OTHER_SEPARATORS.into_iter().find(|(separator, _)| only.contains(*separator))
        {
            return Err(FitError::Separator { found });
        }
        let find = |column: &'static str| {
            let mut places = names.iter().enumerate().filter(|(_, name)| *name == column).map(|(place, _)| place);
            let place = places.next();
            if places.next().is_some() { Err(FitError::ColumnTwice { column }) } else { Ok(place) }
        };
        let need = |column, unit| {
            find(column)?.ok_or_else(|| FitError::ColumnMissing { column, unit, nearest: nearest(column, &names) })
        };
        Ok(Self {
            voltage: need(VOLTAGE, "volts rms")?,
            load: need(LOAD, "newtons")?,
            friction: need(FRICTION, "newtons")?,
            time: find(TIME)?,
            stroke: find(STROKE)?,
            speed: find(SPEED)?,
        })
    }

    fn row(&self, number: u64, record: &ByteRecord) -> Result<Row, FitError> {
        let text = |place: usize| String::from_utf8_lossy(record.get(place).unwrap_or_default()).into_owned();
        let real = |column, place| {
            let text = text(place);
            match text.parse::<f64>() {
                Ok(value) if value.is_finite() => Ok(value),
                _ => {
                    Err(FitError::NotANumber { row: number, column, found: text.chars().take(QUOTED_CHARS).collect() })
                }
            }
        };
        let optional = |column, place: Option<usize>| place.map(|place| real(column, place)).transpose();
        let voltage_v_rms = real(VOLTAGE, self.voltage)?;
        if voltage_v_rms < 0.0 {
            return Err(FitError::NegativeVoltage { row: number, found: voltage_v_rms });
        }
        if voltage_v_rms > VOLTAGE_MAX_V_RMS {
            return Err(FitError::VoltageTooHigh { row: number, found: voltage_v_rms });
        }
        Ok(Row {
            number,
            voltage_v_rms,
            normal_force_n: real(LOAD, self.load)?,
            friction_n: real(FRICTION, self.friction)?,
            time_s: optional(TIME, self.time)?,
            stroke: self.stroke.map(text),
            speed_mm_s: optional(SPEED, self.speed)?,
        })
    }
}

fn nearest(column: &str, names: &[String]) -> Option<String> {
    names
        .iter()
        .map(|name| (strsim::normalized_damerau_levenshtein(column, name), name))
        .filter(|(likeness, _)| *likeness >= LIKENESS)
        .max_by(|one, other| one.0.total_cmp(&other.0))
        .map(|(_, name)| name.clone())
}
