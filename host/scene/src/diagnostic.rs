//! What a compile says about a scene.

use std::fmt::{self, Display};

use thiserror::Error;

use super::mistake::Mistake;
use super::optimisation::Optimisation;
use super::printable::printable;
use super::warning::Warning;

/// What the compiler says about a place in a scene. Its text is the place and one sentence for the person who wrote the
/// scene: what was found, what was expected, and what to do.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagnostic {
    /// What follows from it.
    pub kind: DiagnosticKind,
    /// The name of the file: the scene file, or one that it includes.
    pub file: String,
    /// Line, from one.
    pub line: usize,
    /// Column in characters, from one.
    pub column: usize,
    /// The text at that position; empty at the end of the file.
    pub text: String,
    /// The number of the layer's table in the scene, from one at the bottom; `None` for what is said about no layer, or
    /// about several.
    pub layer: Option<usize>,
    /// The sentence.
    pub message: Message,
}

/// What follows from a diagnostic.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DiagnosticKind {
    /// The scene cannot be read.
    Mistake,
    /// A board refuses the scene. A draft plays it in part, or clamped.
    Refusal,
    /// The scene plays, and there is a reason to doubt it.
    Warning,
    /// The scene plays, and the compiler has rounded, converted, clamped or omitted something.
    Note,
}

/// The sentence of a diagnostic.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum Message {
    /// Of a mistake or a refusal.
    #[error(transparent)]
    Mistake(#[from] Mistake),
    /// Of a warning.
    #[error(transparent)]
    Warning(#[from] Warning),
    /// Of a note: part of the scene is not needed.
    #[error(transparent)]
    Optimisation(#[from] Optimisation),
    /// Of any other note.
    #[error("{0}")]
    Note(String),
}

impl Diagnostic {
    /// The sentence without its place.
    pub fn sentence(&self) -> String {
        printable(&self.message.to_string()).into_owned()
    }

    /// The nearest valid name to an unknown one, if one is near enough.
    pub fn nearest(&self) -> Option<&str> {
        match &self.message {
            Message::Mistake(mistake) => mistake.nearest(),
            _ => None,
        }
    }

    /// Whether both say the same about the same place. Layers share what they have from `[defaults]`.
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
