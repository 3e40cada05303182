//! Why a CSV file, or a row of it, is rejected.

use std::io;

use frixel_model::{InverseError, ParameterError, StateError};
use thiserror::Error;

use super::columns::{COATING, NORMAL_FORCE, PERMITTIVITY, VOLTAGE};

/// Why a CSV file is rejected as a whole.
#[derive(Debug, Error)]
pub enum CsvError {
    /// The header lacks a column that every row needs.
    #[error(
        "row 1: expected a column `{column}` in the header, found none{}",
        .nearest.as_ref().map(|name| format!("; is `{name}` meant?")).unwrap_or_default()
    )]
    ColumnMissing {
        /// The missing column, or the alternatives of which one is needed.
        column: String,
        /// A column with a similar name.
        nearest: Option<String>,
    },
    /// The header has the same column twice.
    #[error("row 1: column `{column}` stands in places {first} and {second}; leave one of them out")]
    ColumnTwice {
        /// Name of the column.
        column: &'static str,
        /// Position of its first occurrence, from one.
        first: usize,
        /// Position of its second occurrence, from one.
        second: usize,
    },
    /// Reading the input failed.
    #[error("the input cannot be read: {0}")]
    Read(io::Error),
    /// Writing the output failed.
    #[error("the output cannot be written: {0}")]
    Write(io::Error),
}

impl CsvError {
    pub(super) fn read(error: csv::Error) -> Self {
        Self::Read(system_error(error))
    }

    pub(super) fn write(error: csv::Error) -> Self {
        Self::Write(system_error(error))
    }
}

/// Converts the error and keeps its kind, which the conversion of the `csv` crate discards.
fn system_error(error: csv::Error) -> io::Error {
    match error.into_kind() {
        csv::ErrorKind::Io(error) => error,
        other => io::Error::other(format!("{other:?}")),
    }
}

/// Why a row is invalid.
#[derive(Clone, Debug, Error, PartialEq)]
pub(super) enum Refusal {
    #[error("row {row}, column {column}: the header has no such column, and {variant} needs it")]
    ColumnMissing { row: u64, column: &'static str, variant: String },
    #[error("row {row}, column {column}: expected a number, found an empty cell")]
    CellEmpty { row: u64, column: &'static str },
    #[error("row {row}, column {column}: expected a number, found {found:?}")]
    NotANumber { row: u64, column: &'static str, found: String },
    #[error("row {row}, column {column}: {found} is out of the range of f32; use --precision f64")]
    OutOfF32 { row: u64, column: &'static str, found: String },
    #[error("row {row}: expected {expected} cells as in the header, found {found}")]
    Length { row: u64, expected: usize, found: usize },
    #[error("row {row}, column variant: expected {expected}, found {found:?}")]
    Variant { row: u64, expected: String, found: String },
    #[error("row {row}: friction_n and electric_friction_n are both filled in; leave one empty")]
    BothFrictions { row: u64 },
    #[error("row {row}, column friction_n: neither it nor electric_friction_n is filled in")]
    NoFriction { row: u64 },
    #[error("the answer is too large or too small for this precision")]
    OutOfRange,
    #[error("{0}")]
    Parameter(ParameterError),
    #[error("{0}")]
    State(StateError),
    #[error("{0}")]
    Inverse(InverseError),
}

impl From<ParameterError> for Refusal {
    /// Replaces the parameter's name by that of its column.
    fn from(error: ParameterError) -> Self {
        let parameter = match error.parameter {
            "thickness_m" => COATING,
            "relative_permittivity" => PERMITTIVITY,
            "gap_m" => "coating_m/permittivity",
            "normal_load_n" | "pull_n" => NORMAL_FORCE,
            "voltage_v_rms" => VOLTAGE,
            other => other,
        };
        // A pull is a negative load.
        let found = if error.parameter == "pull_n" { -error.found } else { error.found };
        Self::Parameter(ParameterError { parameter, found, ..error })
    }
}

impl From<StateError> for Refusal {
    fn from(error: StateError) -> Self {
        if let StateError::Parameter(error) = error { error.into() } else { Self::State(error) }
    }
}

impl From<InverseError> for Refusal {
    fn from(error: InverseError) -> Self {
        if let InverseError::Parameter(error) = error { error.into() } else { Self::Inverse(error) }
    }
}
