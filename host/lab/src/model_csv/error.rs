//! Why a CSV file, or a row of it, is rejected.

use std::io;

use frixel_model::{InverseError, ParameterError, StateError};
use thiserror::Error;

use super::columns::{COATING, NORMAL_FORCE, PERMITTIVITY, VOLTAGE};
use crate::table::TableError;

/// Why a CSV file is rejected as a whole.
#[derive(Debug, Error)]
pub enum CsvError {
    /// The input is no table, or its header lacks a column that every row needs.
    #[error(transparent)]
    Table(#[from] TableError),
    /// Writing the output failed.
    #[error("the output cannot be written: {0}")]
    Write(io::Error),
}

/// Why a row is invalid.
#[derive(Debug, Error)]
pub(super) enum Refusal {
    #[error("row {row}, column {column}: the header has no such column, and {variant} needs it")]
    ColumnMissing { row: u64, column: &'static str, variant: String },
    #[error("row {row}, column {column}: {found} is out of the range of f32; use --precision f64")]
    OutOfF32 { row: u64, column: &'static str, found: String },
    #[error("row {row}, column variant: expected {expected}, found {found:?}")]
    Variant { row: u64, expected: String, found: String },
    #[error("row {row}: friction_n and electric_friction_n are both filled in; leave one empty")]
    BothFrictions { row: u64 },
    #[error("row {row}, column friction_n: neither it nor electric_friction_n is filled in")]
    NoFriction { row: u64 },
    #[error("the answer is too large or too small for this precision")]
    OutOfRange,
    #[error("{}", .0.found())]
    Cell(#[from] TableError),
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
