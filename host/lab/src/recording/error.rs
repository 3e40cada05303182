//! Why a recording cannot be read or written.

use parquet::errors::ParquetError;
use thiserror::Error;

use crate::input::InputError;

/// Why a recording cannot be read or written.
#[derive(Debug, Error)]
pub enum RecordingError {
    /// Parquet that is damaged, or of a kind that is not read.
    #[error("its Parquet cannot be read ({0}): take another copy, or record anew")]
    Damaged(ParquetError),
    /// More than is read, by what the file says of itself.
    #[error("{0}: give a recording that `frixel play --record` has written")]
    TooMuch(#[from] InputError),
    /// Metadata that cannot be read.
    #[error("its metadata `{key}` cannot be read ({source}): take another copy, or record anew")]
    Metadata {
        /// The key.
        key: &'static str,
        /// The error of the JSON parser.
        source: serde_json::Error,
    },
    /// A table that cannot be read.
    #[error("its table cannot be read ({0}): correct or delete the row")]
    Table(csv::Error),
    /// It cannot be written.
    #[error("it cannot be written ({0})")]
    Write(ParquetError),
    /// [`GoesOn`](frixel_play::GoesOn) broke before the result was complete.
    #[error("interrupted")]
    Interrupted,
    /// It is something else than a recording, or not as it was written, or too long to be read back.
    #[error("{0}")]
    Refused(String),
}

impl RecordingError {
    pub(super) fn refused(sentence: impl Into<String>) -> Self {
        Self::Refused(sentence.into())
    }

    /// Columns in columns, or structs in structs of the metadata.
    pub(super) fn nested() -> Self {
        Self::refused(
            "its columns have columns in them, and those of a recording are flat: give one that `frixel play --record` has \
             written",
        )
    }

    /// A column that the metadata does not describe.
    pub(super) fn other_columns() -> Self {
        Self::refused("its columns are not those that its metadata names: take another copy, or record anew")
    }
}
