//! Finds the known word most similar to an unknown one.

use std::fmt::{self, Display};

use crate::grammar::stem as without_unit;

/// The known words, and the most similar one.
#[derive(Clone, Debug, PartialEq)]
pub struct Nearest {
    /// The most similar word, if one is similar enough.
    pub suggestion: Option<String>,
    /// All known words.
    pub known: Vec<String>,
    /// Text after the suggestion, with a leading comma; without a suggestion, the replacement to use. May be empty.
    remark: &'static str,
}

/// Common words for terms of a scene or a plan, each with a remark. If a word occurs several times, the first entry
/// whose term is valid in the context counts.
const SYNONYMS: [(&str, &str, &str); 35] = [
    ("file", "picture", ""),
    ("image", "picture", ""),
    ("photo", "picture", ""),
    ("src", "picture", ""),
    ("path", "picture", ""),
    ("image", "bitmap", ""),
    ("photo", "bitmap", ""),
    ("picture", "bitmap", ""),
    ("slider", "edge", ", one for each detent, with `repeat`"),
    ("detent", "edge", ""),
    ("line", "edge", ""),
    ("bump", "edge", ""),
    ("ridge", "edge", ""),
    ("groove", "edge", ", with a negative ridge over a layer that it lowers"),
    ("click", "edge", " or `button`, which both have a click"),
    ("stripes", "grating", ""),
    ("wave", "grating", ""),
    ("texture", "noise", ", or `bitmap` for a picture of one"),
    ("plate", "constant", ", with a `region`"),
    ("dot", "constant", ", with `shape = \"ellipse\"` in its `region`"),
    ("circle", "constant", ", with `shape = \"ellipse\"` in its `region`"),
    ("circle", "ellipse", ", as wide as it is high"),
    ("oval", "ellipse", ""),
    ("notification", "vibration", ", with `live = true`, so that a program can trigger it"),
    ("buzz", "vibration", ""),
    ("key", "button", ""),
    ("switch", "button", ", with a click that a finger feels when it slides in"),
    ("dial", "spokes", ", whose notches a finger counts as it goes round"),
    ("knob", "spokes", ", whose notches a finger counts as it goes round"),
    ("velvet", "direction", ", whose friction depends on the direction"),
    ("ratchet", "direction", ", with `blend = \"multiply\"` above a `grating`"),
    ("sound", "vibration", ", which is felt and not heard"),
    ("text", "bitmap", ", with a picture of the text"),
    ("icon", "bitmap", ", with a picture of the icon"),
    ("persons", "people", ""),
];

/// Words for unsupported kinds of layer, each with a replacement. They apply where [`A_KIND`] is valid.
const NO_KINDS: [(&str, &str); 1] = [(
    "animation",
    "no kind plays pictures one after another: use `vibration`, `drift_mm_per_s` of a `grating`, or layers with \
     `live = true`, which a program switches by `--control`",
)];

/// A kind of layer: if it is valid, kinds are expected.
const A_KIND: &str = "vibration";

impl Nearest {
    /// Similarity (Jaro-Winkler, 0 to 1) from which on a word is suggested.
    const LIKENESS_MIN: f64 = 0.75;

    /// Finds the most similar of some known words, ignoring case. Of equally similar words, the first counts.
    pub fn new<'k>(found: &str, known: impl IntoIterator<Item = &'k str>) -> Self {
        let known: Vec<String> = known.into_iter().map(str::to_owned).collect();
        let found = found.to_lowercase();
        let is_known = |word: &str| known.iter().any(|known| known == word);
        let synonym = SYNONYMS.iter().find(|(synonym, meant, _)| *synonym == found && is_known(meant));
        if let Some((_, meant, remark)) = synonym.filter(|_| !is_known(&found)) {
            return Self { suggestion: Some((*meant).to_owned()), known, remark };
        }
        if let Some((_, remark)) = NO_KINDS.iter().find(|(word, _)| *word == found && is_known(A_KIND)) {
            return Self { suggestion: None, known, remark };
        }
        // A number is not nearer to another because they share digits.
        let are_numbers = known.iter().all(|word| word.parse::<f64>().is_ok());
        let suggestion = known
            .iter()
            .filter(|_| !are_numbers)
            .rev()
            .map(|word| (likeness(&found, &word.to_lowercase()), word))
            .filter(|(likeness, _)| *likeness >= Self::LIKENESS_MIN)
            .max_by(|(one, _), (other, _)| one.total_cmp(other))
            .map(|(_, word)| word.clone());
        let remark = suggestion.as_ref().map_or("", |word| other_unit(&found, word));
        Self { suggestion, known, remark }
    }

    /// The file name most similar to another one, compared without extensions, which many files share.
    pub(super) fn file(found: &str, files: &[String]) -> Option<String> {
        let stem = Self::new(stem(found), files.iter().map(|file| self::stem(file))).suggestion?;
        let is_alike = |file: &&String| self::stem(file) == stem;
        let (same_ending, other): (Vec<&String>, _) =
            files.iter().filter(is_alike).partition(|file| ending(file) == ending(found));
        same_ending.first().or(other.first()).map(|file| (*file).clone())
    }
}

/// A remark on the unit of a field that was written with another one: as it stands, its number would be another amount.
fn other_unit(found: &str, meant: &str) -> &'static str {
    let stem = without_unit(meant);
    let (written, unit) = (found.strip_prefix(stem), meant.strip_prefix(stem));
    match unit.filter(|_| written != unit && written.is_some_and(|written| written.starts_with('_'))) {
        Some("_n") => ", in N",
        Some("_mm") => ", in mm",
        _ => "",
    }
}

/// The similarity of two words, the known one with its unit or without.
fn likeness(found: &str, known: &str) -> f64 {
    strsim::jaro_winkler(found, known).max(strsim::jaro_winkler(found, without_unit(known)))
}

/// The part of a file name before the extension.
fn stem(name: &str) -> &str {
    name.rsplit_once('.').map_or(name, |(stem, _)| stem)
}

fn ending(name: &str) -> &str {
    name.rsplit_once('.').map_or("", |(_, ending)| ending)
}

impl Display for Nearest {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.suggestion {
            Some(word) => write!(formatter, "did you mean `{word}`{}?", self.remark),
            None if !self.remark.is_empty() => formatter.write_str(self.remark),
            None if self.known.is_empty() => write!(formatter, "nothing more is expected here"),
            None => write!(formatter, "expected one of `{}`", self.known.join("`, `")),
        }
    }
}
