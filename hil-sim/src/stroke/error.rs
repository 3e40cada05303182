//! Errors in the description of a stroke.

use thiserror::Error;

use crate::error::OutOfRange;

/// Why a stroke cannot be played.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum StrokeError {
    /// A number is out of range.
    #[error("stroke: {0}")]
    OutOfRange(#[from] OutOfRange),
    /// The text has no rows.
    #[error("the stroke is empty: expected a header `t_s,x_mm,y_mm` and at least two rows below it")]
    Empty,
    /// The text has only one row.
    #[error("line {line}: the stroke has one row only: expected at least two, so that the finger moves in time")]
    OneRow {
        /// Line of the row.
        line: u64,
    },
    /// The header lacks a column.
    #[error("line {line}: no column `{column}` in the header `{found}`: expected `t_s,x_mm,y_mm`")]
    MissingColumn {
        /// Line of the header.
        line: u64,
        /// The column that is missing.
        column: &'static str,
        /// The header that was found.
        found: String,
    },
    /// A row is too short or has an empty cell.
    #[error("line {line}, column `{column}`: empty: expected a number")]
    MissingValue {
        /// Line of the row.
        line: u64,
        /// Column of the cell.
        column: &'static str,
    },
    /// A cell is not a number.
    #[error("line {line}, column `{column}`: `{found}` is no number: expected one such as `12.5`")]
    NotANumber {
        /// Line of the row.
        line: u64,
        /// Column of the cell.
        column: &'static str,
        /// The content of the cell.
        found: String,
    },
    /// A number is infinite or not a number.
    #[error("line {line}, column `{column}`: `{found}` is not finite: expected a number such as `12.5`")]
    NotFinite {
        /// Line of the row.
        line: u64,
        /// Column of the cell.
        column: &'static str,
        /// The content of the cell.
        found: String,
    },
    /// A normal load that no finger has.
    #[error(
        "line {line}, column `force_n`: {found_n} is no load of a finger: expected newtons, above 0 and at most 50"
    )]
    NoLoad {
        /// Line of the row.
        line: u64,
        /// The load that was found, N.
        found_n: f64,
    },
    /// A row has a negative time.
    #[error("line {line}, column `t_s`: {found_s} is below 0: expected time from the start of the stroke")]
    BeforeStart {
        /// Line of the row.
        line: u64,
        /// Time of the row, s.
        found_s: f64,
    },
    /// The time of a row is not later than that of the previous row.
    #[error("line {line}, column `t_s`: {found_s} comes after {previous_s}: expected time to rise from row to row")]
    NotRising {
        /// Line of the row.
        line: u64,
        /// Time of the row, s.
        found_s: f64,
        /// Time of the previous row, s.
        previous_s: f64,
    },
    /// Two rows are so far apart, in so little time, that the speed between them is not finite.
    #[error("line {line}: the finger would jump here in no time: expected a finite speed from the row before")]
    Jump {
        /// Line of the second row.
        line: u64,
    },
    /// The text cannot be read as comma-separated values.
    #[error("the stroke is no CSV text: {reason}")]
    Malformed {
        /// The message of the CSV reader.
        reason: String,
    },
}
