//! Why data are refused. Each rule writes its own message; the variants are the cases that callers handle differently.

use thiserror::Error;

use super::defects::{DefectiveStroke, sentence};
use crate::table::TableError;

/// Why data cannot be fitted.
#[derive(Debug, Error)]
pub enum FitError {
    /// A needed column is missing, or a cell is not a number.
    #[error(transparent)]
    Table(#[from] TableError),
    /// Too few rows, strokes or means: in all, or at a voltage.
    #[error("{0}")]
    TooFew(String),
    /// Strokes that cannot be used: all that were found.
    #[error("{}", sentence(.0))]
    DefectiveStrokes(Vec<DefectiveStroke>),
    /// Friction had not settled in the rows that are compared: the force sensor is too slow, or friction was smoothed.
    #[error("{0}")]
    NotSettled(String),
    /// Electric friction follows no power of the voltage.
    #[error("{0}")]
    NoPowerLaw(String),
    /// The search for the best parameters did not converge.
    #[error(
        "no finger of the model comes close to these data: check that voltage, load and friction belong to the same \
         rows"
    )]
    NotConverged,
    /// The caller ended the fit.
    #[error("the fit was interrupted")]
    Interrupted,
    /// The data break another rule.
    #[error("{0}")]
    Refused(String),
}

/// A number without hundreds of zeros.
pub(super) fn plain(value: f64) -> String {
    if value != 0.0 && !(1e-6..1e7).contains(&value.abs()) { format!("{value:e}") } else { value.to_string() }
}
