//! Recordings as Parquet: named columns with units, and how they were made.
//!
//! A [`Recording`] is a value: [`Recording::of_rows`] makes one of the rows of a recorder, [`Recording::write_parquet`]
//! and [`Recording::read_parquet`] are its way to bytes and back. [`ParquetWriter`] writes one while it grows. The same
//! recording gives the same bytes: no time, path or name of a machine is in them. [`Recording::replay`] plays a
//! simulated one again.

mod arrow_schema;
mod claims;
mod error;
mod fields;
mod metadata;
mod of_person;
mod parquet_reader;
mod parquet_writer;
mod replay;
mod replayed_changes;
mod seal;

use std::fmt::{self, Display};

use frixel_felt::recorder::FeltRow;

pub use claims::check_length;
pub use error::RecordingError;
pub use fields::{Field, Kind, Values, calibration_fields, play_fields, play_values, stroke_fields};
pub use metadata::{BoardIdentity, GrowingFile, LaterScene, Metadata, SourceFile};
pub use of_person::is_of_person;
pub use parquet_reader::MAGIC;
pub use parquet_writer::{ParquetWriter, table_parquet};
pub use replay::ReplayError;

/// Rows of a recording that [`Recording::write_parquet`] puts into one row group.
pub const ROWS_PER_GROUP: usize = 65_536;

/// A recording: columns of equal length, and what is known of them.
#[derive(Clone, Debug, PartialEq)]
pub struct Recording {
    /// What made the recording, and what happened meanwhile.
    pub metadata: Metadata,
    /// The columns.
    pub columns: Vec<Column>,
    /// Whether the file ended in a part of a row group, which is left out: its writer was killed.
    pub is_cut_off: bool,
}

/// A column of a recording.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    /// Its name, unit and meaning.
    pub field: Field,
    /// Its values, one for each row.
    pub values: Values,
}

impl Recording {
    /// The recording of a play, with the columns of [`play_fields`].
    pub fn of_rows(metadata: Metadata, rows: &[FeltRow]) -> Self {
        let columns = play_fields().into_iter().zip(play_values(rows));
        let columns = columns.map(|(field, values)| Column { field, values }).collect();
        Self { metadata, columns, is_cut_off: false }
    }

    /// The recording of a table in CSV, with commas between columns and points in numbers, that has these columns.
    pub fn of_csv(metadata: Metadata, csv: &[u8], fields: Vec<Field>) -> Result<Self, RecordingError> {
        let mut reader = csv::Reader::from_reader(csv);
        let header = reader.headers().map_err(RecordingError::Table)?.clone();
        let place = |field: &Field| header.iter().position(|name| name == field.name);
        let places: Vec<usize> =
            fields.iter().map(|field| place(field).ok_or(RecordingError::OtherColumns)).collect::<Result<_, _>>()?;
        let column = |field: Field| Column { values: Values::none(field.kind), field };
        let mut columns: Vec<Column> = fields.into_iter().map(column).collect();
        for row in reader.records() {
            let row = row.map_err(RecordingError::Table)?;
            for (column, place) in columns.iter_mut().zip(&places) {
                if !column.values.push(row.get(*place).unwrap_or_default()) {
                    return Err(RecordingError::OtherColumns);
                }
            }
        }
        Ok(Self { metadata, columns, is_cut_off: false })
    }

    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.columns.first().map_or(0, |column| column.values.len())
    }

    /// The column of a name.
    pub fn column(&self, name: &str) -> Option<&Column> {
        self.columns.iter().find(|column| column.field.name == name)
    }

    /// The columns as CSV text with a header, every number with all of its digits; an unknown value is an empty cell.
    pub fn to_csv(&self) -> Vec<u8> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        // Writing into memory does not fail, and every row has as many cells as the header.
        let _ = writer.write_record(self.columns.iter().map(|column| column.field.name.as_str()));
        for row in 0..self.rows() {
            let _ = writer.write_record(self.columns.iter().map(|column| column.values.text(row)));
        }
        writer.into_inner().unwrap_or_default()
    }

    /// The first row in which another recording differs by a bit, and the first column there; `None` if there is none.
    pub fn first_difference(&self, other: &Self) -> Option<Difference> {
        let names = |recording: &Self| -> Vec<String> {
            recording.columns.iter().map(|column| column.field.name.clone()).collect()
        };
        if names(self) != names(other) {
            return Some(Difference::Columns { one: names(self), other: names(other) });
        }
        let pairs = || self.columns.iter().zip(&other.columns);
        let rows = self.rows().min(other.rows());
        let differs = |row: &usize| pairs().any(|(one, other)| one.values.bits(*row) != other.values.bits(*row));
        if let Some(row) = (0..rows).find(differs) {
            let (one, other) = pairs().find(|(one, other)| one.values.bits(row) != other.values.bits(row))?;
            let cells = (one.values.text(row), other.values.text(row));
            return Some(Difference::Cell { row, column: one.field.name.clone(), one: cells.0, other: cells.1 });
        }
        let counts = (self.rows(), other.rows());
        (counts.0 != counts.1).then_some(Difference::Rows { one: counts.0, other: counts.1 })
    }
}

/// Where two recordings differ.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Difference {
    /// The names of the columns.
    Columns {
        /// Names of the first recording.
        one: Vec<String>,
        /// Names of the other one.
        other: Vec<String>,
    },
    /// A value.
    Cell {
        /// Number of the row, from zero.
        row: usize,
        /// Name of the column.
        column: String,
        /// The value of the first recording; empty if it is unknown.
        one: String,
        /// That of the other one.
        other: String,
    },
    /// The number of rows; those that both have are the same.
    Rows {
        /// Rows of the first recording.
        one: usize,
        /// Rows of the other one.
        other: usize,
    },
}

impl Display for Difference {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let known = |text: &str| if text.is_empty() { "unknown".to_owned() } else { text.to_owned() };
        match self {
            Self::Columns { one, other } => {
                write!(formatter, "the columns are {}, and not {}", other.join(", "), one.join(", "))
            }
            Self::Cell { row, column, one, other } => {
                write!(
                    formatter,
                    "row {}, column {column}: {} in the file, {} played",
                    row + 1,
                    known(one),
                    known(other)
                )
            }
            Self::Rows { one, other } => write!(formatter, "{one} rows in the file, {other} played"),
        }
    }
}

#[cfg(test)]
mod tests;
