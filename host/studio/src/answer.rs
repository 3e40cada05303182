//! What the page reads from the output buffer.

use std::fmt::Display;

use frixel_scene::{Diagnostic, DiagnosticKind, Program};
use serde::Serialize;
use serde_json::{Value, json};

use crate::host::HostError;
use crate::program::ProgramError;

/// A sentence about a scene, and where in the text it belongs. Lines and columns count from 1, columns in characters.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct Problem {
    /// `error` or `warning`.
    severity: &'static str,
    /// The sentence.
    message: String,
    /// The file, if it is not the scene.
    #[serde(skip_serializing_if = "Option::is_none")]
    file: Option<String>,
    #[serde(flatten)]
    place: Option<Place>,
    /// The nearest valid word, for a word that is unknown.
    #[serde(skip_serializing_if = "Option::is_none")]
    help: Option<String>,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
struct Place {
    line: usize,
    column: usize,
    end_line: usize,
    end_column: usize,
}

impl Problem {
    fn error(message: impl Display) -> Self {
        Self { severity: "error", message: message.to_string(), file: None, place: None, help: None }
    }

    /// A diagnostic of a scene called `entry`.
    fn of(diagnostic: &Diagnostic, entry: &str) -> Self {
        let Diagnostic { kind, file, line, column, text, .. } = diagnostic;
        let severity = match kind {
            DiagnosticKind::Mistake | DiagnosticKind::Refusal => "error",
            DiagnosticKind::Warning | DiagnosticKind::Note => "warning",
        };
        let file = (file != entry).then(|| file.clone());
        let marked = text.lines().next().unwrap_or_default().chars().count().max(1);
        let place = Place { line: *line, column: *column, end_line: *line, end_column: column + marked };
        let help = diagnostic.nearest().map(str::to_owned);
        Self { severity, message: diagnostic.sentence(), file, place: Some(place), help }
    }
}

/// The problems of an error, those of a scene called `entry` without its name.
pub(crate) fn problems(error: &ProgramError, entry: &str) -> Vec<Problem> {
    match error {
        ProgramError::Request(error) => vec![Problem::error(error)],
        ProgramError::Compile(error) => {
            error.diagnostics.iter().map(|diagnostic| Problem::of(diagnostic, entry)).collect()
        }
    }
}

/// The problems of a program called `entry`: why a board refuses it, if it is a draft, and warnings.
pub(crate) fn problems_of(program: &Program, entry: &str) -> Vec<Problem> {
    let is_problem = |diagnostic: &&Diagnostic| diagnostic.kind != DiagnosticKind::Note;
    program.diagnostics.iter().filter(is_problem).map(|diagnostic| Problem::of(diagnostic, entry)).collect()
}

/// An error as the page gets it: `error`, a sentence, `problems`, as [`crate::check`] returns them, and `isLinkLost`.
pub(crate) fn error(error: &HostError, entry: &str) -> Value {
    let problems = match error {
        HostError::Program(error) => problems(error, entry),
        error => vec![Problem::error(error)],
    };
    json!({ "error": error.to_string(), "problems": problems, "isLinkLost": error.is_link_lost() })
}
