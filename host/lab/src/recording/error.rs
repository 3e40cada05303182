//! Why a recording cannot be read or written.

use parquet::errors::ParquetError;
use thiserror::Error;

use crate::input::InputError;

/// Why a recording cannot be read or written.
#[derive(Debug, Error)]
pub enum RecordingError {
    /// Parquet data that are damaged or unsupported.
    #[error("its Parquet data cannot be read ({0}): take another copy, or record again")]
    Damaged(ParquetError),
    /// The file states a size above the limit.
    #[error("{0}: give a recording that `frixel play --record` has written")]
    TooMuch(#[from] InputError),
    /// Metadata that cannot be read.
    #[error("its metadata `{key}` cannot be read ({source}): take another copy, or record again")]
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
    /// It is not a recording, was changed, or is too long to be read back.
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
            "it has nested columns, and a recording's are flat: give one that `frixel play --record` has written",
        )
    }

    /// A column that the metadata does not describe.
    pub(super) fn other_columns() -> Self {
        Self::refused("its columns differ from those in its metadata: take another copy, or record again")
    }
}
