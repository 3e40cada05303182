//! Why a table is refused: what was found, and what to do about it.

use std::io;

use frixel_scene::WrongKind;
use thiserror::Error;

/// Why a table, or a row of it, cannot be read: what was found, and what to do.
#[derive(Debug, Error)]
#[error("{found}: {advice}")]
pub struct TableError {
    found: String,
    advice: String,
    source: Option<io::Error>,
}

/// Advice about an input that is not a table.
const NO_TABLE: &str = "give a CSV file with a header row";

impl TableError {
    pub(super) fn new(found: impl Into<String>, advice: impl Into<String>) -> Self {
        Self { found: found.into(), advice: advice.into(), source: None }
    }

    /// The input is not a table.
    pub(super) fn no_table(found: impl Into<String>) -> Self {
        Self::new(found, NO_TABLE)
    }

    /// The found and the expected contents, for a caller with better advice.
    pub fn found(&self) -> &str {
        &self.found
    }
}

impl From<WrongKind> for TableError {
    fn from(wrong: WrongKind) -> Self {
        Self::new(wrong.finding(), wrong.advice())
    }
}

impl From<io::Error> for TableError {
    fn from(error: io::Error) -> Self {
        let found = format!("the table cannot be read ({error})");
        Self { source: Some(error), ..Self::no_table(found) }
    }
}

impl From<csv::Error> for TableError {
    /// Only the input itself fails: any bytes are a table.
    fn from(error: csv::Error) -> Self {
        system_error(error).into()
    }
}

/// The error of the operating system with its kind, which the conversion of the `csv` crate discards.
pub(crate) fn system_error(error: csv::Error) -> io::Error {
    match error.into_kind() {
        csv::ErrorKind::Io(error) => error,
        other => io::Error::other(format!("{other:?}")),
    }
}
