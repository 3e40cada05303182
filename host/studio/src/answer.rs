//! What the page reads from the output buffer.

use std::fmt::Display;

use frixel_scene::{Located, Program};
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
    pub(crate) fn warning(message: String) -> Self {
        Self { severity: "warning", message, file: None, place: None, help: None }
    }

    fn error(message: impl Display) -> Self {
        Self { severity: "error", ..Self::warning(message.to_string()) }
    }

    fn located(located: &Located, entry: &str) -> Self {
        let Located { file, line, column, text, mistake } = located;
        let file = (file != entry).then(|| file.clone());
        let marked = text.lines().next().unwrap_or_default().chars().count().max(1);
        let place = Place { line: *line, column: *column, end_line: *line, end_column: column + marked };
        let help = mistake.nearest().map(str::to_owned);
        Self { file, place: Some(place), help, ..Self::error(mistake) }
    }
}

/// The problems of an error, those of a scene called `entry` without its name.
pub(crate) fn problems(error: &ProgramError, entry: &str) -> Vec<Problem> {
    match error {
        ProgramError::Request(error) => vec![Problem::error(error)],
        ProgramError::Compile(error) => error.mistakes.iter().map(|located| Problem::located(located, entry)).collect(),
    }
}

/// The reasons why a board refuses a draft called `entry`; none of another program.
pub(crate) fn refusals(program: &Program, entry: &str) -> Vec<Problem> {
    program.refusals.iter().map(|located| Problem::located(located, entry)).collect()
}

/// An error as the page gets it: `error`, a sentence, `problems`, as [`crate::check`] returns them, and `isLinkLost`.
pub(crate) fn error(error: &HostError, entry: &str) -> Value {
    let problems = match error {
        HostError::Program(error) => problems(error, entry),
        error => vec![Problem::error(error)],
    };
    json!({ "error": error.to_string(), "problems": problems, "isLinkLost": error.is_link_lost() })
}
