//! Errors of reading and compiling a scene file, as text for people and as JSON for programs.

use serde::Serialize;
use thiserror::Error;

use super::diagnostic::Diagnostic;

/// Largest number of reported mistakes.
pub(super) const MISTAKES_MAX: usize = 100;

/// A scene file cannot be read or compiled. The message has a line for each mistake.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("{}{}", list(.diagnostics), if *.has_more { MORE } else { "" })]
pub struct CompileError {
    /// The scene file's name, as it was given.
    pub file: String,
    /// Mistakes and refusals in the order of the file, followed by those of included files; 1 to 100.
    pub diagnostics: Vec<Diagnostic>,
    /// Whether there are more than these.
    pub has_more: bool,
}

const MORE: &str = "\nthere are more than these 100 mistakes: fix these first";

fn list(diagnostics: &[Diagnostic]) -> String {
    let lines: Vec<String> = diagnostics.iter().map(ToString::to_string).collect();
    lines.join("\n")
}

impl CompileError {
    /// Creates the error with at most 100 of the mistakes.
    pub(super) fn new(file: String, mut diagnostics: Vec<Diagnostic>) -> Self {
        let has_more = diagnostics.len() > MISTAKES_MAX;
        diagnostics.truncate(MISTAKES_MAX);
        Self { file, diagnostics, has_more }
    }

    /// One JSON object on one line. A caller that reads files sets `unreadable` to a text if it could not read the
    /// file.
    ///
    /// - `file`, and `unreadable`, which is null
    /// - `mistakes`: objects with `file`, `line` and `column` (both from one), `text` (the text at that position),
    ///   `nearest` (the nearest valid name, or null) and `message` (a sentence)
    /// - `has_more`: whether there are more than 100 mistakes
    pub fn to_json(&self) -> String {
        let mistakes = self.diagnostics.iter().map(MistakeJson::of).collect();
        // Plain numbers and texts always serialize.
        serde_json::to_string(&ErrorJson { file: &self.file, unreadable: None, mistakes, has_more: self.has_more })
            .unwrap_or_default()
    }
}

#[derive(Serialize)]
struct ErrorJson<'e> {
    file: &'e str,
    unreadable: Option<()>,
    mistakes: Vec<MistakeJson<'e>>,
    has_more: bool,
}

#[derive(Serialize)]
struct MistakeJson<'e> {
    file: &'e str,
    line: usize,
    column: usize,
    text: &'e str,
    nearest: Option<&'e str>,
    message: String,
}

impl<'e> MistakeJson<'e> {
    fn of(diagnostic: &'e Diagnostic) -> Self {
        let Diagnostic { file, line, column, text, .. } = diagnostic;
        let (nearest, message) = (diagnostic.nearest(), diagnostic.sentence());
        Self { file, line: *line, column: *column, text, nearest, message }
    }
}
