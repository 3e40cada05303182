//! Mistakes in a scene. Each message states what was found, what is expected, and how to fix it.

mod field;
mod file;
mod fit;

use thiserror::Error;

use crate::printable::brief;

pub(crate) use field::FieldMistake;
pub(crate) use file::FileMistake;
pub(crate) use fit::FitMistake;

/// Advice for a path that starts with a tilde.
pub const TILDE_ADVICE: &str = "only a shell expands `~`, so write your home folder's path in full";

/// Advice for a path with backslashes, which begin escapes such as `\t` in a TOML string.
pub(crate) const SLASH_ADVICE: &str = "write / instead of \\ between the parts of a path";

/// A mistake in a scene file. Its text is one sentence for the person who wrote the file.
#[derive(Clone, Debug, PartialEq, Error)]
pub(crate) enum Mistake {
    /// In a field, or between fields of a table.
    #[error(transparent)]
    Field(#[from] FieldMistake),
    /// Of a whole file, or between files.
    #[error(transparent)]
    File(#[from] FileMistake),
    /// The scene exceeds the screen, the finger or the board.
    #[error(transparent)]
    Fit(#[from] FitMistake),
    /// An expectation of a scenario has no condition.
    #[error(
        "this [[expect]] expects nothing: add `output`, `electrode_below_fraction`, `friction_fraction`, `state`, `fault` or `error`"
    )]
    NothingExpected,
    /// An expectation of a scenario refers to an unknown name.
    #[error(
        "`after = \"{}\"` names neither a command nor a fault: give one of them this `name`", brief(.found)
    )]
    UnknownEvent { found: String },
    /// Two commands or faults of a scenario share a name.
    #[error("`name = \"{}\"` is already used on line {line}: choose another name", brief(.name))]
    NameTwice { name: String, line: usize },
    /// An expectation of a scenario ends before it begins.
    #[error("`to_ms = {to_ms}` is before `from_ms = {from_ms}`: give a later end, or an earlier beginning")]
    EndsBeforeStart { from_ms: f64, to_ms: f64 },
    /// A command or a fault of a scenario begins after the scenario's end.
    #[error(
        "`at_ms = {at_ms}` is after the end of the scenario, which runs for {seconds} s: raise `seconds`, \
         or begin earlier"
    )]
    AfterEnd { at_ms: f64, seconds: f64 },
}

impl Mistake {
    /// The valid name most similar to an unknown one, if one is similar enough.
    pub(crate) fn nearest(&self) -> Option<&str> {
        match self {
            Self::Field(FieldMistake::UnknownField { nearest, .. } | FieldMistake::UnknownChoice { nearest, .. })
            | Self::File(FileMistake::UnknownProfile { nearest, .. }) => nearest.suggestion.as_deref(),
            Self::File(FileMistake::FileMissing { nearest, .. } | FileMistake::IncludedMissing { nearest, .. }) => {
                nearest.as_deref()
            }
            _ => None,
        }
    }
}
