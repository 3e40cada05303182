//! Finds the known word that is nearest to an unknown one.

use std::fmt::{self, Display};

/// The known words that an unknown word may stand for.
#[derive(Clone, Debug, PartialEq)]
pub struct Nearest {
    /// The nearest word, if one is near enough.
    pub suggestion: Option<String>,
    /// All known words.
    pub known: Vec<String>,
    /// What belongs to the suggestion, with a comma before it; without one, what to use instead. Empty if there is nothing.
    remark: &'static str,
}

/// Words of other trades for words of a scene, each with a remark. Of those with one word, the first one whose meaning
/// is known where it is written counts.
const SYNONYMS: [(&str, &str, &str); 22] = [
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
    ("notification", "vibration", ", with `live = true`, so that a program can trigger it"),
    ("buzz", "vibration", ""),
    ("key", "button", ""),
    ("switch", "button", ", with a click that a finger feels when it slides in"),
    ("dial", "spokes", ", whose notches a finger counts as it goes round"),
    ("knob", "spokes", ", whose notches a finger counts as it goes round"),
    ("velvet", "direction", ", whose friction is another one way than the other"),
    ("ratchet", "direction", ", with `blend = \"multiply\"` above a `grating`"),
    ("sound", "vibration", ", which is felt and not heard"),
    ("text", "bitmap", ", with a picture of the text"),
    ("icon", "bitmap", ", with a picture of the icon"),
];

/// Words for what no kind of layer is, each with what to use instead. They count where [`A_KIND`] is known.
const NO_KINDS: [(&str, &str); 1] = [(
    "animation",
    "no kind plays pictures one after another: use `vibration`, `drift_mm_per_s` of a `grating`, or layers with \
     `live = true`, which a program switches by `--control`",
)];

/// A kind of layer: where it is known, the known words are kinds.
const A_KIND: &str = "vibration";

impl Nearest {
    /// Likeness (Jaro-Winkler, 0 to 1) from which a word is suggested.
    const LIKENESS_MIN: f64 = 0.75;

    /// Finds the nearest of some known words, upper and lower case alike. Of words that are equally near, the first one
    /// counts.
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
        let suggestion = known
            .iter()
            .rev()
            .map(|word| (strsim::jaro_winkler(&found, &word.to_lowercase()), word))
            .filter(|(likeness, _)| *likeness >= Self::LIKENESS_MIN)
            .max_by(|(one, _), (other, _)| one.total_cmp(other))
            .map(|(_, word)| word.clone());
        Self { suggestion, known, remark: "" }
    }

    /// The file that is nearest to the name of another one. Files are alike by what stands before the ending, which is
    /// the same for many.
    pub(super) fn file(found: &str, files: &[String]) -> Option<String> {
        let stem = Self::new(stem(found), files.iter().map(|file| self::stem(file))).suggestion?;
        let is_alike = |file: &&String| self::stem(file) == stem;
        let (same_ending, other): (Vec<&String>, _) =
            files.iter().filter(is_alike).partition(|file| ending(file) == ending(found));
        same_ending.first().or(other.first()).map(|file| (*file).clone())
    }
}

/// What stands before the ending of a file's name.
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
