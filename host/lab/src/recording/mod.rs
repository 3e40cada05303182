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
mod source;

use frixel_felt::recorder::FeltRow;

pub use claims::check_length;
pub use error::RecordingError;
pub(crate) use fields::is_play_column;
pub use fields::{Field, Kind, Values, calibration_fields, play_fields, play_values, stroke_fields};
pub use metadata::{BoardIdentity, GrowingFile, LaterScene, Metadata, SourceFile};
pub use of_person::is_of_person;
pub use parquet_reader::MAGIC;
pub use parquet_writer::ParquetWriter;
#[cfg(not(target_arch = "wasm32"))]
pub(crate) use parquet_writer::table_parquet;
pub use replay::ReplayError;
pub use source::PlaySource;

/// Rows of a recording that [`Recording::write_parquet`] puts into one row group.
pub const ROWS_PER_GROUP: usize = 65_536;

/// A recording: columns of equal length, with metadata.
#[derive(Clone, Debug, PartialEq)]
pub struct Recording {
    /// The inputs of the recording, and the events during it.
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

    /// Reads a recording with these columns from CSV with comma separators and decimal points.
    pub fn of_csv(metadata: Metadata, csv: &[u8], fields: Vec<Field>) -> Result<Self, RecordingError> {
        let mut reader = csv::Reader::from_reader(csv);
        let header = reader.headers().map_err(RecordingError::Table)?.clone();
        let place = |field: &Field| header.iter().position(|name| name == field.name);
        let places: Vec<usize> = fields
            .iter()
            .map(|field| place(field).ok_or_else(RecordingError::other_columns))
            .collect::<Result<_, _>>()?;
        let column = |field: Field| Column { values: Values::none(field.kind), field };
        let mut columns: Vec<Column> = fields.into_iter().map(column).collect();
        for row in reader.records() {
            let row = row.map_err(RecordingError::Table)?;
            for (column, place) in columns.iter_mut().zip(&places) {
                if !column.values.push(row.get(*place).unwrap_or_default()) {
                    return Err(RecordingError::other_columns());
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

    /// Where a recording that was played again first differs from this one by a bit: the names of its columns, a cell,
    /// or the number of rows. `None` if it does not differ.
    pub fn first_difference(&self, played: &Self) -> Option<String> {
        let names = |recording: &Self| {
            recording.columns.iter().map(|column| column.field.name.as_str()).collect::<Vec<_>>().join(", ")
        };
        let (own, others) = (names(self), names(played));
        if own != others {
            return Some(format!("the columns are {others}, and not {own}"));
        }
        let pairs = || self.columns.iter().zip(&played.columns);
        for row in 0..self.rows().min(played.rows()) {
            if let Some((one, other)) = pairs().find(|(one, other)| !one.values.is_same(&other.values, row)) {
                let [found, again] = [one, other].map(|column| column.values.text(row));
                let known = |text: String| if text.is_empty() { "unknown".to_owned() } else { text };
                let (row, column, found, again) = (row + 1, &one.field.name, known(found), known(again));
                return Some(format!("row {row}, column {column}: {found} in the file, {again} played"));
            }
        }
        let (found, again) = (self.rows(), played.rows());
        (found != again).then(|| format!("{found} rows in the file, {again} played"))
    }
}

#[cfg(test)]
mod tests;
