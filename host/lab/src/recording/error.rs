//! Why a recording cannot be read or written.

use frixel_scene::brief;
use parquet::errors::ParquetError;
use thiserror::Error;

use crate::input::InputError;

/// Why a recording cannot be read or written.
#[derive(Debug, Error)]
pub enum RecordingError {
    /// The file has no bytes.
    #[error("it is empty: give a recording that `frixel play --record` has written")]
    Empty,
    /// The file is something else.
    #[error("it is no Parquet file: give a recording that `frixel play --record` has written")]
    NoParquet,
    /// The end is missing, and no whole row group comes before it.
    #[error(
        "its end is missing, which says what the rest is, so that nothing can be read: take a whole copy, or record anew"
    )]
    Truncated,
    /// Parquet that is damaged, or of a kind that is not read.
    #[error("its Parquet cannot be read ({0}): take another copy, or record anew")]
    Damaged(ParquetError),
    /// Content that is not what was written.
    #[error(
        "its content has another hash than it says: it is damaged, or another program has written it anew; take another copy, or record anew"
    )]
    Changed,
    /// More than is read, by what the file says of itself.
    #[error("{0}: give a recording that `frixel play --record` has written")]
    TooMuch(#[from] InputError),
    /// More rows than are read back.
    #[error(
        "it would have {rows} rows of {columns} columns, and at most {max} are read back: record for a shorter time, or \
         fewer rows a second"
    )]
    TooLong {
        /// Rows of the recording.
        rows: u64,
        /// Its columns.
        columns: usize,
        /// Most rows that are read.
        max: u64,
    },
    /// Columns in columns, or structs in structs of the metadata.
    #[error(
        "its columns have columns in them, and those of a recording are flat: give one that `frixel play --record` has written"
    )]
    Nested,
    /// Parquet of another program.
    #[error("it is a Parquet file without frixel's metadata: give one that `frixel play --record` has written")]
    Foreign,
    /// A format of the future.
    #[error("it has format {}, and this frixel reads format {known}: update frixel", brief(.found))]
    Newer {
        /// Its format.
        found: String,
        /// The format that is known.
        known: u32,
    },
    /// Metadata that cannot be read.
    #[error("its metadata `{key}` cannot be read ({source}): take another copy, or record anew")]
    Metadata {
        /// The key.
        key: &'static str,
        /// What is wrong.
        source: serde_json::Error,
    },
    /// A column that the metadata does not describe.
    #[error("its columns are not those that its metadata names: take another copy, or record anew")]
    OtherColumns,
    /// A table that cannot be read.
    #[error("its table cannot be read ({0}): correct or delete the row")]
    Table(csv::Error),
    /// It cannot be written.
    #[error("it cannot be written ({0})")]
    Write(ParquetError),
}
