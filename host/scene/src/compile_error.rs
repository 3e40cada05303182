//! The errors of reading and compiling a scene file, as text for a person and as JSON for a program.

use serde::Serialize;
use thiserror::Error;

use super::mistake::Mistake;

/// A scene file cannot be read or compiled. The message has a line for each mistake.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("{}", list(.mistakes))]
pub struct CompileError {
    /// The scene file's name, as it was given.
    pub file: String,
    /// All mistakes, in the order of the file, then those of the files that it includes; at least one.
    pub mistakes: Vec<Located>,
}

fn list(mistakes: &[Located]) -> String {
    let lines: Vec<String> = mistakes.iter().map(ToString::to_string).collect();
    lines.join("\n")
}

/// A mistake and where it stands.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("{file}:{line}:{column}: {mistake}")]
pub struct Located {
    /// The name of the file: the scene file, or one that it includes.
    pub file: String,
    /// Line, from one.
    pub line: usize,
    /// Column in characters, from one.
    pub column: usize,
    /// The text at that position; empty at the end of the file.
    pub text: String,
    /// The mistake.
    pub mistake: Mistake,
}

impl CompileError {
    /// One JSON object on one line: `file`; `unreadable`, null; `mistakes`, a list of objects with `file`, `line` and
    /// `column`, both from one, `text`, the text at that position, `nearest`, the nearest valid name or null, and
    /// `message`, a sentence. A caller that reads files sets `unreadable` to a text if it could not read the file.
    pub fn to_json(&self) -> String {
        let mistakes = self.mistakes.iter().map(MistakeJson::of).collect();
        // Plain numbers and texts always have a JSON form.
        serde_json::to_string(&ErrorJson { file: &self.file, unreadable: None, mistakes }).unwrap_or_default()
    }
}

#[derive(Serialize)]
struct ErrorJson<'e> {
    file: &'e str,
    unreadable: Option<()>,
    mistakes: Vec<MistakeJson<'e>>,
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
    fn of(located: &'e Located) -> Self {
        let Located { file, line, column, text, mistake } = located;
        Self { file, line: *line, column: *column, text, nearest: mistake.nearest(), message: mistake.to_string() }
    }
}
