//! The errors of reading and compiling a scene file, as text for a person and as JSON for a program.

use serde::Serialize;
use thiserror::Error;

use super::mistake::Mistake;
use super::printable::printable;

/// Most mistakes that are reported at once.
pub(super) const MISTAKES_MAX: usize = 100;

/// A scene file cannot be read or compiled. The message has a line for each mistake.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("{}{}", list(.mistakes), if *.has_more { MORE } else { "" })]
pub struct CompileError {
    /// The scene file's name, as it was given.
    pub file: String,
    /// The mistakes, in the order of the file, then those of the files that it includes; at least one, at most 100.
    pub mistakes: Vec<Located>,
    /// Whether there are mistakes beside those.
    pub has_more: bool,
}

const MORE: &str = "\nthese are 100 mistakes, and there are more: mend these first";

fn list(mistakes: &[Located]) -> String {
    let lines: Vec<String> = mistakes.iter().map(ToString::to_string).collect();
    lines.join("\n")
}

/// A mistake and where it stands.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("{}:{line}:{column}: {}", printable(.file), printable(&.mistake.to_string()))]
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
    /// The mistakes of a file, of which no more than 100 are kept.
    pub(super) fn new(file: String, mut mistakes: Vec<Located>) -> Self {
        let has_more = mistakes.len() > MISTAKES_MAX;
        mistakes.truncate(MISTAKES_MAX);
        Self { file, mistakes, has_more }
    }

    /// One JSON object on one line: `file`; `unreadable`, null; `mistakes`, a list of objects with `file`, `line` and
    /// `column`, both from one, `text`, the text at that position, `nearest`, the nearest valid name or null, and
    /// `message`, a sentence; `has_more`, whether there are more mistakes than those 100. A caller that reads files sets `unreadable` to a text if it could not read the file.
    pub fn to_json(&self) -> String {
        let mistakes = self.mistakes.iter().map(MistakeJson::of).collect();
        // Plain numbers and texts always have a JSON form.
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
    fn of(located: &'e Located) -> Self {
        let Located { file, line, column, text, mistake } = located;
        Self {
            file,
            line: *line,
            column: *column,
            text,
            nearest: mistake.nearest(),
            message: printable(&mistake.to_string()).into_owned(),
        }
    }
}
