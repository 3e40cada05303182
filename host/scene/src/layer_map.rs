//! The record of each layer of the file, for a host that changes layers while they play.

use thiserror::Error;

use super::layer::Layer;
use super::nearest::Nearest;
use super::titles::LayerNumber;

/// The layers of a file, each with its record in the compiled program.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct LayerMap(Vec<Entry>);

#[derive(Clone, Debug, PartialEq, Eq)]
struct Entry {
    number: LayerNumber,
    name: Option<String>,
    /// The name of the layer that `repeat` copied.
    family: Option<String>,
    record: Option<u8>,
}

/// The reason why a layer of the file cannot be changed while it plays.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum LayerError {
    /// No layer has this name or number.
    #[error("the scene has no layer {found:?}: {}", advice(.nearest, .numbers))]
    Unknown {
        /// The name or number that was given.
        found: String,
        /// The nearest name, if one is near enough: that of a layer, or the first and the last of its copies.
        nearest: Vec<String>,
        /// The first and the last number.
        numbers: Vec<String>,
    },
    /// The layer is one of several copies.
    #[error("{layer:?} is repeated: give one of its copies, {}", range(.copies))]
    Repeated {
        /// The name or number that was given.
        layer: String,
        /// Name or number of the first and of the last copy.
        copies: Vec<String>,
    },
    /// The layer may have no record of its own.
    #[error("layer {layer:?} may be merged with others: write `live = true` in the file to change it while it plays")]
    NotLive {
        /// The name or number that was given.
        layer: String,
    },
}

fn advice(nearest: &[String], numbers: &[String]) -> String {
    match (nearest, numbers) {
        ([], []) => "it has no layers".to_owned(),
        ([], numbers) => format!("give the name of a layer, or its number, {}", range(numbers)),
        ([name], _) => format!("did you mean {name:?}?"),
        (copies, _) => format!("did you mean one of {}?", range(copies)),
    }
}

/// The first and the last of a list, as a sentence names them.
fn range(names: &[String]) -> String {
    let quoted = |name: &String| if name.parse::<f64>().is_ok() { name.clone() } else { format!("{name:?}") };
    match names {
        [] => String::new(),
        [only] => quoted(only),
        [first, .., last] => format!("{} to {}", quoted(first), quoted(last)),
    }
}

/// The first and the last of some names, or the only one.
fn ends<T: Into<String>>(mut names: impl DoubleEndedIterator<Item = T>) -> Vec<String> {
    let first = names.next();
    let last = names.next_back();
    first.into_iter().chain(last).map(Into::into).collect()
}

impl LayerMap {
    /// The layers from bottom to top, each with its record if the host may change it.
    pub(super) fn new<'l>(layers: impl IntoIterator<Item = (&'l Layer, Option<u8>)>) -> Self {
        let entry = |(layer, record): (&Layer, Option<u8>)| Entry {
            number: layer.number(),
            name: layer.name.clone(),
            family: layer.family.clone(),
            record,
        };
        Self(layers.into_iter().map(entry).collect())
    }

    /// Number of the record, from zero, of the layer with the name `layer`, or with the number `layer` as messages have
    /// it: `3`, or `3.2` for a copy. If several layers have the same name, the lowest one counts.
    /// `Device::set_layer` of the driver takes the record's number.
    ///
    /// # Errors
    ///
    /// There is no such layer, it is a family of copies, or it cannot be changed while it plays.
    pub fn record(&self, layer: &str) -> Result<u8, LayerError> {
        let named = self.0.iter().find(|entry| entry.name.as_deref() == Some(layer));
        let numbered = || self.0.iter().find(|entry| entry.number.to_string() == layer);
        match named.or_else(numbered) {
            Some(entry) => entry.record.ok_or_else(|| LayerError::NotLive { layer: layer.to_owned() }),
            None => Err(self.not_found(layer)),
        }
    }

    /// Whether the host may change the layer of a record.
    pub fn is_live(&self, record: u8) -> bool {
        self.0.iter().any(|entry| entry.record == Some(record))
    }

    fn not_found(&self, layer: &str) -> LayerError {
        let names = |entries: Vec<&Entry>| ends(entries.into_iter().filter_map(|entry| entry.name.clone()));
        let copies: Vec<&Entry> = self.0.iter().filter(|entry| entry.family.as_deref() == Some(layer)).collect();
        let numbered: Vec<&Entry> = self.0.iter().filter(|entry| entry.number.table.to_string() == layer).collect();
        if !copies.is_empty() {
            return LayerError::Repeated { layer: layer.to_owned(), copies: names(copies) };
        }
        if !numbered.is_empty() {
            let copies = ends(numbered.iter().map(|entry| entry.number.to_string()));
            return LayerError::Repeated { layer: layer.to_owned(), copies };
        }
        let known = self.0.iter().flat_map(|entry| [entry.family.as_deref(), entry.name.as_deref()]).flatten();
        let nearest = Nearest::new(layer, known).suggestion.map_or(Vec::new(), |nearest| {
            // The name of a copy stands for all copies, unless it differs in its capitals only.
            let is_same = nearest.to_lowercase() == layer.to_lowercase();
            let named = self.0.iter().find(|entry| entry.name.as_ref() == Some(&nearest));
            let family = named.and_then(|entry| entry.family.clone()).filter(|_| !is_same);
            let family = Some(family.unwrap_or_else(|| nearest.clone()));
            let copies = names(self.0.iter().filter(|entry| entry.family == family).collect());
            if copies.is_empty() { vec![nearest] } else { copies }
        });
        let numbers = ends(self.0.iter().map(|entry| entry.number.to_string()));
        LayerError::Unknown { found: layer.to_owned(), nearest, numbers }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn entry(table: usize, copy: Option<usize>, name: Option<&str>, record: Option<u8>) -> Entry {
        let name = name.map(str::to_owned);
        let family = copy.and(name.as_ref()).map(|name| name.trim_end_matches([' ', '1', '2', '3']).to_owned());
        Entry { number: LayerNumber { table, copy }, name, family, record }
    }

    fn map() -> LayerMap {
        LayerMap(vec![
            entry(1, None, None, Some(0)),
            entry(2, None, Some("bricks"), None),
            entry(3, Some(1), Some("rain 1"), Some(1)),
            entry(3, Some(2), Some("rain 2"), Some(2)),
            entry(3, Some(3), Some("rain 3"), Some(3)),
            entry(4, None, Some("1"), Some(4)),
            entry(5, Some(1), None, Some(5)),
            entry(5, Some(2), None, Some(6)),
        ])
    }

    #[test]
    fn a_layer_is_found_by_name_or_by_the_number_of_messages() {
        for (layer, record) in [("rain 2", 2), ("3.2", 2), ("5.1", 5), ("1", 4), ("4", 4)] {
            assert_eq!(map().record(layer), Ok(record), "{layer}");
        }
        assert_eq!(map().record("bricks"), Err(LayerError::NotLive { layer: "bricks".into() }));
    }

    #[test]
    fn a_layer_that_is_not_found_is_missed_in_a_sentence() {
        for (layer, sentence) in [
            ("Bricks", "the scene has no layer \"Bricks\": did you mean \"bricks\"?"),
            ("rain", "\"rain\" is repeated: give one of its copies, \"rain 1\" to \"rain 3\""),
            ("Rain", "the scene has no layer \"Rain\": did you mean one of \"rain 1\" to \"rain 3\"?"),
            ("rian", "the scene has no layer \"rian\": did you mean one of \"rain 1\" to \"rain 3\"?"),
            ("RAIN 2", "the scene has no layer \"RAIN 2\": did you mean \"rain 2\"?"),
            ("3", "\"3\" is repeated: give one of its copies, 3.1 to 3.3"),
            ("5", "\"5\" is repeated: give one of its copies, 5.1 to 5.2"),
            ("6", "the scene has no layer \"6\": give the name of a layer, or its number, 1 to 5.2"),
            ("", "the scene has no layer \"\": give the name of a layer, or its number, 1 to 5.2"),
        ] {
            assert_eq!(map().record(layer).unwrap_err().to_string(), sentence);
        }
        let nothing = LayerMap::default().record("x").unwrap_err().to_string();
        assert_eq!(nothing, "the scene has no layer \"x\": it has no layers");
    }
}
