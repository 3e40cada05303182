//! Corpora: Markdown files of inputs, each followed by the expected messages.
//!
//! A heading names the cases below it. A code block with a file name after its language, such as `toml scene.toml`, is
//! an input, or several copies of it: `toml scene.toml x65`. Blocks of the introduction are prepended to the file of
//! the same name in each case. A block with the language `says` ends a case with the expected messages. A test
//! regenerates the page with the current messages, and compares it as a [golden file](crate::golden).
//!
//! ````text
//! # Layers
//!
//! Each scene begins with
//!
//! ```toml scene.toml
//! version = 1
//! ```
//!
//! ## A misspelt kind
//!
//! ```toml scene.toml
//! [[layer]]
//! kind = "gratng"
//! ```
//!
//! ```says
//! scene.toml:3:8: `kind = "gratng"` is not known; did you mean `grating`?
//! ```
//! ````
#![allow(clippy::panic, reason = "part of a test, which may fail")]

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use crate::golden;

const FENCE: &str = "```";
/// The language of the block with the expected messages.
const SAYS: &str = "says";

/// The inputs of a case.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Case {
    /// The heading above it.
    pub heading: String,
    /// Names and texts of its files.
    pub files: BTreeMap<String, String>,
}

/// The pages of a folder.
///
/// # Panics
///
/// The folder cannot be read, or has no pages.
#[track_caller]
pub fn pages(folder: &Path) -> Vec<PathBuf> {
    let pages = fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let mut pages: Vec<_> = pages.filter_map(|entry| Some(entry.ok()?.path())).collect();
    pages.retain(|page| page.extension().is_some_and(|extension| extension == "md"));
    pages.sort();
    assert!(!pages.is_empty(), "{} has no pages", folder.display());
    pages
}

/// Runs all cases of a page, and compares their messages with the page.
///
/// `answer` takes the inputs of a case and returns the lines of its messages.
///
/// # Panics
///
/// A case has other messages than the page states, or the page cannot be read.
#[track_caller]
pub fn hold(page: &Path, mut answer: impl FnMut(&Case) -> String) {
    let text = fs::read_to_string(page).unwrap_or_else(|error| panic!("{}: {error}", page.display()));
    golden::hold(page, &answered(&text, &mut answer));
}

/// A page with its expected messages replaced by the current ones.
fn answered(page: &str, answer: &mut impl FnMut(&Case) -> String) -> String {
    let mut answered = String::new();
    let mut introduction = BTreeMap::new();
    let mut case = Case::default();
    let mut lines = page.lines();
    while let Some(line) = lines.next() {
        answered.extend([line, "\n"]);
        if let Some(heading) = line.strip_prefix("## ") {
            if case.heading.is_empty() {
                introduction = case.files;
            }
            case = Case { heading: heading.to_owned(), files: introduction.clone() };
        }
        let Some(block) = line.strip_prefix(FENCE) else { continue };
        let held: String = lines.by_ref().take_while(|line| *line != FENCE).flat_map(|line| [line, "\n"]).collect();
        let text = if block == SAYS {
            let said = answer(&case);
            case.files.clone_from(&introduction);
            said
        } else {
            let mut words = block.split(' ').skip(1);
            let name = words.next().unwrap_or_else(|| panic!("a block of {} names no file", case.heading));
            let copies = words.next().and_then(|word| word.strip_prefix('x')?.parse().ok()).unwrap_or(1);
            *case.files.entry(name.to_owned()).or_default() += &held.repeat(copies);
            held
        };
        answered.extend([&text, FENCE, "\n"]);
    }
    answered
}

#[cfg(test)]
mod tests {
    use super::*;

    const PAGE: &str = "# Sums\n\n```text a\n1\n```\n\n## Two\n\n```text a\n2\n```\n\n```says\n3\n```\n\n## None, and copies\n\n```says\n1\n```\n\n```text a x3\n5\n```\n\n```says\n16\n```\n";

    fn sum(case: &Case) -> String {
        let sum: u32 = case.files["a"].lines().filter_map(|line| line.parse::<u32>().ok()).sum();
        format!("{sum}\n")
    }

    #[test]
    fn another_answer_takes_the_place_of_the_old_one() {
        let wrong = PAGE.replace("\n3\n", "\n4\n5\n");
        assert_eq!(answered(&wrong, &mut sum), PAGE);
    }
}
