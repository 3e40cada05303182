//! The mistakes that a scene can have. Each message states what was found, what is expected, and what to do.

mod field;
mod file;
mod fit;

use thiserror::Error;

use crate::printable::brief;

pub use field::FieldMistake;
pub use file::FileMistake;
pub use fit::FitMistake;

/// What to do about a path that starts with a tilde.
pub const TILDE_ADVICE: &str = "only a shell replaces `~` by your folder, so write that folder's path in full";

/// What to do about a path with backslashes, which begin escapes such as `\t` in a TOML string.
pub(crate) const SLASH_ADVICE: &str = "write / instead of \\ between the parts of a path";

/// A mistake in a scene file. Its text is one sentence for the person who wrote the file.
#[derive(Clone, Debug, PartialEq, Error)]
#[non_exhaustive]
pub enum Mistake {
    /// In a field, or between fields of a table.
    #[error(transparent)]
    Field(#[from] FieldMistake),
    /// Of a whole file, or between files.
    #[error(transparent)]
    File(#[from] FileMistake),
    /// The scene asks for more than screen, finger and board have.
    #[error(transparent)]
    Fit(#[from] FitMistake),
    /// An expectation of a scenario does not say what has to be seen.
    #[error(
        "this [[expect]] expects nothing: add `output`, `electrode_below_fraction`, `friction_fraction`, `state`, `fault` or `error`"
    )]
    NothingExpected,
    /// An expectation of a scenario counts from what has no such name.
    #[error(
        "`after = \"{}\"` names no command and no fault: give one of them this `name`", brief(.found)
    )]
    UnknownEvent {
        /// The name, as written.
        found: String,
    },
    /// A command or a fault of a scenario has the name of another one.
    #[error("`name = \"{}\"` is the name of line {line}, too: give each its own", brief(.name))]
    NameTwice {
        /// The name.
        name: String,
        /// The line that has it first.
        line: usize,
    },
    /// An expectation of a scenario ends before it begins.
    #[error("`to_ms = {to_ms}` is before `from_ms = {from_ms}`: give a later end, or an earlier beginning")]
    EndsBeforeStart {
        /// First time, in ms.
        from_ms: f64,
        /// Last time, in ms.
        to_ms: f64,
    },
    /// A command or a fault of a scenario begins after its end.
    #[error(
        "`at_ms = {at_ms}` is after the end of the scenario, which runs for {seconds} s: raise `seconds`, \
         or begin earlier"
    )]
    AfterEnd {
        /// When it begins, in ms since the start.
        at_ms: f64,
        /// How long the scenario runs, in s.
        seconds: f64,
    },
}

impl Mistake {
    /// The nearest valid name to an unknown one, if one is near enough.
    pub fn nearest(&self) -> Option<&str> {
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
