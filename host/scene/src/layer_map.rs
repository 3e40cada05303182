//! The record of each layer of the file, for a host that changes layers while they play.

use thiserror::Error;

use super::nearest::Nearest;

/// The layers of a file, each with its record in the compiled program.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct LayerMap(Vec<Entry>);

#[derive(Clone, Debug, PartialEq, Eq)]
struct Entry {
    name: Option<String>,
    record: Option<u8>,
}

/// The reason why a layer of the file cannot be changed while it plays.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum LayerError {
    /// No layer has this name or number.
    #[error(
        "the scene has no layer {found:?}{}: give the name of a layer, or a number from 1 to {count}",
        suggested(.suggestion.as_deref())
    )]
    Unknown {
        /// The name or number that was given.
        found: String,
        /// The nearest name, if one is near enough.
        suggestion: Option<String>,
        /// How many layers the scene has.
        count: usize,
    },
    /// The layer may have no record of its own.
    #[error("layer {layer:?} may be merged with others: write `live = true` in the file to change it while it plays")]
    NotLive {
        /// The name or number that was given.
        layer: String,
    },
}

fn suggested(suggestion: Option<&str>) -> String {
    suggestion.map(|name| format!("; did you mean {name:?}?")).unwrap_or_default()
}

impl LayerMap {
    /// The layers from bottom to top: name, if any, and record, if the host may change it.
    pub(super) fn new(layers: impl IntoIterator<Item = (Option<String>, Option<u8>)>) -> Self {
        Self(layers.into_iter().map(|(name, record)| Entry { name, record }).collect())
    }

    /// Number of the record, from zero, of the layer with the name `layer`, or with the number `layer` counted from
    /// one. If several layers have the same name, the first one counts. `Device::set_layer` of the driver takes this
    /// number.
    pub fn record(&self, layer: &str) -> Result<u8, LayerError> {
        let named = self.0.iter().find(|entry| entry.name.as_deref() == Some(layer));
        let numbered = || self.0.get(layer.parse::<usize>().ok()?.checked_sub(1)?);
        match named.or_else(numbered) {
            Some(entry) => entry.record.ok_or_else(|| LayerError::NotLive { layer: layer.to_owned() }),
            None => Err(LayerError::Unknown {
                found: layer.to_owned(),
                suggestion: Nearest::new(layer, self.0.iter().filter_map(|entry| entry.name.as_deref())).suggestion,
                count: self.0.len(),
            }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_layer_is_found_by_name_or_number_and_missed_in_a_sentence() {
        let name = |name: &str| Some(name.to_owned());
        let map =
            LayerMap::new([(None, Some(0)), (name("bricks"), None), (name("rain"), Some(1)), (name("1"), Some(2))]);
        assert_eq!(map.record("rain"), Ok(1));
        assert_eq!(map.record("3"), Ok(1));
        assert_eq!(map.record("1"), Ok(2), "a name comes before a number");
        assert_eq!(map.record("bricks"), Err(LayerError::NotLive { layer: "bricks".into() }));
        for wrong in ["0", "5", "brick", ""] {
            let sentence = map.record(wrong).unwrap_err().to_string();
            assert!(sentence.contains("has no layer") && sentence.contains("a number from 1 to 4"), "{sentence}");
            assert_eq!(sentence.contains("did you mean \"bricks\"?"), wrong == "brick", "{sentence}");
        }
    }
}
