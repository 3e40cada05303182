//! Diagnostics of a compile.

use std::fmt::{self, Display};

use thiserror::Error;

use super::mistake::{FieldMistake, Mistake};
use super::optimisation::Optimisation;
use super::printable::printable;
use super::warning::Warning;

/// A diagnostic of the compiler about a place in a scene. It displays as the place and one sentence for the scene's
/// author: what was found, what was expected, and what to do.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagnostic {
    /// Its severity.
    pub kind: DiagnosticKind,
    /// The name of the file: the scene file, or one that it includes.
    pub file: String,
    /// Line, from one.
    pub line: usize,
    /// Column in characters, from one.
    pub column: usize,
    /// The text at that position; empty at the end of the file.
    pub text: String,
    /// The number of the layer's table in the scene, counted from 1, the bottom layer; `None` if the diagnostic is
    /// about no single layer.
    pub layer: Option<usize>,
    /// The sentence.
    pub(crate) message: Message,
}

/// Severity of a diagnostic.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DiagnosticKind {
    /// The scene cannot be read.
    Mistake,
    /// A board refuses the scene. A draft plays it clamped or in part.
    Refusal,
    /// The scene plays, with a reason for doubt.
    Warning,
    /// The scene plays, and the compiler has rounded, converted, clamped or omitted something.
    Note,
}

/// The sentence of a diagnostic.
#[derive(Clone, Debug, PartialEq, Error)]
pub(crate) enum Message {
    /// The sentence of a mistake or a refusal.
    #[error(transparent)]
    Mistake(#[from] Mistake),
    /// The sentence of a warning.
    #[error(transparent)]
    Warning(#[from] Warning),
    /// The sentence of a note about an optimisation.
    #[error(transparent)]
    Optimisation(#[from] Optimisation),
    /// The sentence of any other note.
    #[error("{0}")]
    Note(String),
}

impl Diagnostic {
    /// The sentence without its place.
    pub fn sentence(&self) -> String {
        printable(&self.message.to_string()).into_owned()
    }

    /// The valid name most similar to an unknown one, if one is similar enough.
    pub fn nearest(&self) -> Option<&str> {
        match &self.message {
            Message::Mistake(mistake) => mistake.nearest(),
            _ => None,
        }
    }

    /// The name of a field that the scene file does not have, if that is the mistake.
    pub fn unknown_field(&self) -> Option<&str> {
        match &self.message {
            Message::Mistake(Mistake::Field(FieldMistake::UnknownField { field, .. })) => Some(field),
            _ => None,
        }
    }

    /// Whether both have the same sentence and place. Layers share the mistakes of `[defaults]`.
    pub(super) fn repeats(&self, other: &Self) -> bool {
        let layer = other.layer;
        Self { layer, ..self.clone() } == *other
    }
}

impl Display for Diagnostic {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { file, line, column, .. } = self;
        write!(formatter, "{}:{line}:{column}: {}", printable(file), self.sentence())
    }
}

impl Display for DiagnosticKind {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Self::Mistake => "mistake",
            Self::Refusal => "refusal",
            Self::Warning => "warning",
            Self::Note => "note",
        })
    }
}
