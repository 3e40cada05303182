//! Errors in the description of a stroke.

use thiserror::Error;

use crate::error::OutOfRange;

/// Why a stroke cannot be played.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum StrokeError {
    /// A number is out of range.
    #[error("stroke: {0}")]
    OutOfRange(#[from] OutOfRange),
}
