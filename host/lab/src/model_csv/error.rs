//! Why a CSV file, or a row of it, is refused.

use std::io;

use frixel_model::{InverseError, ParameterError, StateError};
use thiserror::Error;

use super::columns::{COATING, NORMAL_FORCE, PERMITTIVITY, VOLTAGE};
use crate::table::TableError;

/// Why a CSV file is refused as a whole.
#[derive(Debug, Error)]
pub enum CsvError {
    /// The input is not a table, or its header lacks a column that every row needs.
    #[error(transparent)]
    Table(#[from] TableError),
    /// Writing the output failed.
    #[error("the output cannot be written: {0}")]
    Write(io::Error),
}

/// Why a row is invalid: the text after `invalid: ` in its status.
#[derive(Debug)]
pub(super) struct Refusal(pub(super) String);

impl From<TableError> for Refusal {
    fn from(error: TableError) -> Self {
        Self(error.found().to_owned())
    }
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
        Self(ParameterError { parameter, found, ..error }.to_string())
    }
}

impl From<StateError> for Refusal {
    fn from(error: StateError) -> Self {
        if let StateError::Parameter(error) = error { error.into() } else { Self(error.to_string()) }
    }
}

impl From<InverseError> for Refusal {
    fn from(error: InverseError) -> Self {
        if let InverseError::Parameter(error) = error { error.into() } else { Self(error.to_string()) }
    }
}
