//! Finds the known word that is nearest to an unknown one.

use std::fmt::{self, Display};

/// The known words that an unknown word may stand for.
#[derive(Clone, Debug, PartialEq)]
pub struct Nearest {
    /// The nearest word, if one is near enough.
    pub suggestion: Option<String>,
    /// All known words.
    pub known: Vec<String>,
}

impl Nearest {
    /// Likeness (Jaro-Winkler, 0 to 1) from which a word is suggested.
    const LIKENESS_MIN: f64 = 0.75;

    pub(super) fn new<'k>(found: &str, known: impl Iterator<Item = &'k str>) -> Self {
        let known: Vec<String> = known.map(str::to_owned).collect();
        let suggestion = known
            .iter()
            .map(|word| (strsim::jaro_winkler(found, word), word))
            .filter(|(likeness, _)| *likeness >= Self::LIKENESS_MIN)
            .max_by(|(one, _), (other, _)| one.total_cmp(other))
            .map(|(_, word)| word.clone());
        Self { suggestion, known }
    }
}

impl Display for Nearest {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.suggestion {
            Some(word) => write!(formatter, "did you mean `{word}`?"),
            None if self.known.is_empty() => write!(formatter, "nothing more is expected here"),
            None => write!(formatter, "expected one of `{}`", self.known.join("`, `")),
        }
    }
}
