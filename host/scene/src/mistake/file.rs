//! Mistakes that concern a whole file: the scene, an included file, or a file that it names.

use thiserror::Error;

use super::{SLASH_ADVICE, TILDE_ADVICE};
use crate::file::VERSION;
use crate::file_kind::WrongKind;
use crate::files::{FileUnavailable, file_name};
use crate::nearest::Nearest;
use crate::printable::{Shown, brief};

/// A mistake of a whole file, or between the files of a scene.
#[derive(Clone, Debug, PartialEq, Error)]
pub(crate) enum FileMistake {
    /// The bytes are not UTF-8.
    #[error("this byte is not UTF-8 text: save the file as UTF-8")]
    NotUtf8,
    /// The file is of another kind.
    #[error(transparent)]
    WrongKind(#[from] WrongKind),
    /// The text is not TOML.
    #[error("this is not TOML: {0}")]
    Syntax(String),
    /// The scene file has another version.
    #[error(
        "this scene file has version {}, and this frixel reads version {VERSION}: use a version that supports it",
        Shown(*.found)
    )]
    Version { found: f64 },
    /// No screen or finger of this name is bundled.
    #[error(
        "there is no bundled {what} \"{}\", and a file name needs an extension such as .toml; {nearest}",
        brief(.found)
    )]
    UnknownProfile { what: &'static str, found: String, nearest: Nearest },
    /// There are more entries than the limit.
    #[error("there are {found} {what}, and at most {max} are read: {advice}")]
    TooMuch { what: &'static str, found: usize, max: usize, advice: &'static str },
    /// Files include each other in a cycle.
    #[error("{}: remove {}", in_circle(.circle), if .circle.len() == 1 { "it" } else { "one of them" })]
    IncludedByItself { circle: Vec<String> },
    /// A scene has too many files.
    #[error("a scene has at most {max} files, and this is one too many: merge some of them")]
    TooManyFiles { max: usize },
    /// A file is included by two files, or twice by one.
    #[error(
        "{included} is included {}: a scene includes each file once, so leave one of them out",
        if .file == .other { format!("twice by {file}") } else { format!("by {file} and by {other}") }
    )]
    IncludedTwice { file: String, included: String, other: String },
    /// An included file is missing.
    #[error(
        "{file} includes {}, which was not found: names start from the folder of {file}{}",
        brief(.included),
        did_you_mean(.nearest.as_deref())
    )]
    IncludedMissing { file: String, included: String, nearest: Option<String> },
    /// An included file cannot be used.
    #[error("{file} includes {}, which cannot be used: {reason}", brief(.included))]
    IncludedUnusable { file: String, included: String, reason: String },
    /// Two files of a scene have the same table.
    #[error("`{field}` is in both {file} and {other}: a scene has only one, so remove one of them")]
    TableTwice { field: &'static str, file: String, other: String },
    /// Layers of two files have the same name.
    #[error("a layer \"{name}\" is in {file} and in {other}: rename one of them")]
    NameTwice { name: String, file: String, other: String },
    /// A file is missing.
    #[error(
        "{what} \"{}\" was not found in {}{}: {}",
        brief(.file),
        brief(.folder),
        which_has(.nearest.as_deref()),
        missing_advice(.file)
    )]
    FileMissing { what: &'static str, file: String, folder: String, nearest: Option<String> },
    /// The name of a file is empty.
    #[error("`{field}` is empty: write a file name between the quotation marks")]
    NoFileName { field: &'static str },
    /// A file cannot be used.
    #[error("{what} \"{}\" cannot be used: {reason}", brief(.file))]
    FileUnusable { what: &'static str, file: String, reason: String },
}

impl FileMistake {
    pub(crate) fn too_much(what: &'static str, found: usize, max: usize, advice: &'static str) -> Self {
        Self::TooMuch { what, found, max, advice }
    }

    /// A file that is not available: a `picture`, `finger` or `screen`.
    pub(crate) fn unavailable(what: &'static str, name: &str, unavailable: &FileUnavailable) -> Self {
        let file = name.to_owned();
        match unavailable {
            FileUnavailable::Unreadable { reason } => {
                Self::FileUnusable { what, file, reason: format!("it cannot be read ({reason})") }
            }
            FileUnavailable::Missing { place, files } => {
                let nearest = Nearest::file(file_name(name), files);
                Self::FileMissing { what, file, folder: place.clone(), nearest }
            }
        }
    }
}

/// Advice for a missing file.
fn missing_advice(file: &str) -> &'static str {
    if file.starts_with('~') {
        TILDE_ADVICE
    } else if file.contains(|character: char| character == '\\' || character.is_control()) {
        SLASH_ADVICE
    } else {
        "paths start from the folder of the file that names it"
    }
}

fn did_you_mean(nearest: Option<&str>) -> String {
    nearest.map_or(String::new(), |name| format!("; did you mean \"{name}\"?"))
}

fn which_has(nearest: Option<&str>) -> String {
    nearest.map_or(String::new(), |name| format!(", which has \"{name}\""))
}

/// Names the cycle of including files, beginning with the last one.
fn in_circle(files: &[String]) -> String {
    let Some((last, others)) = files.split_last() else { return String::new() };
    let way: Vec<&str> = std::iter::once(last).chain(others).map(String::as_str).collect();
    match &way[..] {
        [only] => format!("{only} includes {only} itself"),
        [first, rest @ ..] => {
            format!("{first} includes {}, which includes {last} itself", rest.join(", which includes "))
        }
        [] => String::new(),
    }
}
