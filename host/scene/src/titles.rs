//! Numbers and titles of layers in messages.

use std::fmt::{self, Display};

use serde::{Serialize, Serializer};

/// Number of copies from which on a list names only the first.
const FOLDED_MIN: usize = 3;

/// The number of a layer in messages and in `frixel play --control`: `3`, or `3.2` for a copy of a layer with `repeat`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LayerNumber {
    /// The number of its `[[layer]]` in the scene, from one at the bottom.
    pub table: usize,
    /// The number of the copy, from one, of a layer with `repeat`.
    pub copy: Option<usize>,
}

impl Display for LayerNumber {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { table, copy } = self;
        match copy {
            Some(copy) => write!(formatter, "{table}.{copy}"),
            None => write!(formatter, "{table}"),
        }
    }
}

/// Title of a layer in messages: its number, with its name or kind.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LayerTitle {
    number: LayerNumber,
    name: Option<String>,
    text: String,
}

impl LayerTitle {
    /// The title of a layer with a name, or else of its kind.
    ///
    /// ```
    /// use frixel_scene::{LayerNumber, LayerTitle};
    /// let number = LayerNumber { table: 3, copy: Some(1) };
    /// assert_eq!(LayerTitle::new(number, Some("wood 1"), "grating").as_str(), "layer 3.1 \"wood 1\"");
    /// assert_eq!(LayerTitle::new(number, None, "grating").as_str(), "layer 3.1 (grating)");
    /// ```
    pub fn new(number: LayerNumber, name: Option<&str>, kind: &str) -> Self {
        let text = name.map_or_else(|| format!("layer {number} ({kind})"), |name| format!("layer {number} \"{name}\""));
        Self { number, name: name.map(str::to_owned), text }
    }

    /// The number of the layer.
    pub fn number(&self) -> LayerNumber {
        self.number
    }

    /// The layer's name, where the title is too long; the title for a layer without a name.
    pub fn name_or_title(&self) -> &str {
        self.name.as_deref().unwrap_or(&self.text)
    }

    /// The title as it appears in messages.
    pub fn as_str(&self) -> &str {
        &self.text
    }
}

impl Display for LayerTitle {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.pad(&self.text)
    }
}

impl Serialize for LayerTitle {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(&self.text)
    }
}

/// The titles of layers, listed as in a sentence, with copies folded.
pub(super) fn listed(titles: &[&LayerTitle]) -> String {
    fold_copies(titles).join(" and ")
}

/// The titles of layers for a list. Of consecutive copies of one layer, only the first is named; the others are
/// counted.
pub fn fold_copies(titles: &[&LayerTitle]) -> Vec<String> {
    let are_copies =
        |one: LayerNumber, other: LayerNumber| one.copy.is_some() && other.copy.is_some() && one.table == other.table;
    let groups = titles.chunk_by(|one, other| are_copies(one.number, other.number));
    let words = groups.flat_map(|group| match group {
        [first, rest @ ..] if group.len() >= FOLDED_MIN => vec![format!("{first} with {} more copies", rest.len())],
        titles => titles.iter().map(ToString::to_string).collect(),
    });
    words.collect()
}
