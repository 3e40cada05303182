//! Why a scene file does not become a program, for a person and for a program.

use std::io;

use serde::Serialize;
use thiserror::Error;

use super::mistake::Mistake;

/// Why a scene file does not become a program.
#[derive(Debug, Error)]
pub enum CompileError {
    /// The scene file itself cannot be read.
    #[error("{file}: this scene file cannot be read ({source}): check the path")]
    Unreadable {
        /// The file as it was named.
        file: String,
        /// What the system said.
        source: io::Error,
    },
    /// The file was read, and something in it is wrong. The message has a line for each mistake.
    #[error("{}", list(.file, .mistakes))]
    Mistakes {
        /// The file as it was named.
        file: String,
        /// Every mistake that was found, in the order of the file.
        mistakes: Vec<Located>,
    },
}

fn list(file: &str, mistakes: &[Located]) -> String {
    let lines: Vec<String> = mistakes.iter().map(|mistake| format!("{file}:{mistake}")).collect();
    lines.join("\n")
}

/// A mistake and where in the file it stands.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("{line}:{column}: {mistake}")]
pub struct Located {
    /// Line, from one.
    pub line: usize,
    /// Column in characters, from one.
    pub column: usize,
    /// What stands there; empty at the end of the file.
    pub text: String,
    /// What is wrong.
    pub mistake: Mistake,
}

impl CompileError {
    /// One JSON object on one line: `file`; `unreadable`, what the system said, or null; `mistakes`, a list of objects with `line` and `column`, both from
    /// one, `text`, what stands there, `nearest`, the valid name that may have been meant, or null, and `message`, a sentence.
    pub fn to_json(&self) -> String {
        let json = match self {
            Self::Unreadable { file, source } => {
                ErrorJson { file, unreadable: Some(source.to_string()), mistakes: Vec::new() }
            }
            Self::Mistakes { file, mistakes } => {
                ErrorJson { file, unreadable: None, mistakes: mistakes.iter().map(MistakeJson::of).collect() }
            }
        };
        // Plain numbers and texts always have a JSON form.
        serde_json::to_string(&json).unwrap_or_default()
    }
}

#[derive(Serialize)]
struct ErrorJson<'e> {
    file: &'e str,
    unreadable: Option<String>,
    mistakes: Vec<MistakeJson<'e>>,
}

#[derive(Serialize)]
struct MistakeJson<'e> {
    line: usize,
    column: usize,
    text: &'e str,
    nearest: Option<&'e str>,
    message: String,
}

impl<'e> MistakeJson<'e> {
    fn of(located: &'e Located) -> Self {
        let Located { line, column, text, mistake } = located;
        Self { line: *line, column: *column, text, nearest: mistake.nearest(), message: mistake.to_string() }
    }
}
