//! Maps each layer of a file to its record, for a host that changes layers during play.

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

/// The reason why a layer cannot be changed during play.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum LayerError {
    /// No layer has this name or number.
    #[error("the scene has no layer {found:?}: {}", advice(.nearest.as_deref(), .numbers))]
    Unknown {
        /// The name or number that was given.
        found: String,
        /// The most similar name of a layer, a copy, or all copies, if one is similar enough.
        nearest: Option<String>,
        /// The first and the last number.
        numbers: Vec<String>,
    },
    /// The layer may have no record of its own.
    #[error("layer {layer:?} may be merged with others: write `live = true` in the file to change it while it plays")]
    NotLive {
        /// The name or number that was given.
        layer: String,
    },
}

fn advice(nearest: Option<&str>, numbers: &[String]) -> String {
    match (nearest, numbers) {
        (Some(name), _) => format!("did you mean {name:?}?"),
        (None, []) => "it has no layers".to_owned(),
        (None, [only]) => format!("give the name of a layer, or its number, {only}"),
        (None, [first, .., last]) => format!("give the name of a layer, or its number, {first} to {last}"),
    }
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

    /// Indices of the records of a layer, given by its name or by its number in messages: `3`, or `3.2` for a copy. The
    /// name or number of a layer with `repeat` means all its copies. If several layers share a name, the lowest one
    /// counts. `Device::set_layer` of the driver takes such an index.
    ///
    /// # Errors
    ///
    /// Fails if there is no such layer, or if it cannot be changed during play.
    pub fn records(&self, layer: &str) -> Result<Vec<u8>, LayerError> {
        let all = |is_meant: &dyn Fn(&Entry) -> bool| -> Vec<&Entry> {
            self.0.iter().filter(|entry| is_meant(entry)).collect()
        };
        let named = self.0.iter().find(|entry| entry.name.as_deref() == Some(layer)).map(|entry| vec![entry]);
        let number = |entry: &Entry| entry.number.to_string() == layer || entry.number.table.to_string() == layer;
        let meant = named.unwrap_or_else(|| {
            let copies = all(&|entry| entry.family.as_deref() == Some(layer));
            if copies.is_empty() { all(&number) } else { copies }
        });
        if meant.is_empty() {
            return Err(self.not_found(layer));
        }
        let records: Option<Vec<u8>> = meant.iter().map(|entry| entry.record).collect();
        records.ok_or_else(|| LayerError::NotLive { layer: layer.to_owned() })
    }

    /// Whether the host may change the layer of a record.
    pub fn is_live(&self, record: u8) -> bool {
        self.0.iter().any(|entry| entry.record == Some(record))
    }

    fn not_found(&self, layer: &str) -> LayerError {
        let known = self.0.iter().flat_map(|entry| [entry.family.as_deref(), entry.name.as_deref()]).flatten();
        // A name with a number means a copy.
        let family_of = |name: String| {
            let named = self.0.iter().find(|entry| entry.name.as_ref() == Some(&name));
            named.and_then(|entry| entry.family.clone()).filter(|_| !layer.contains(char::is_numeric)).unwrap_or(name)
        };
        let nearest = Nearest::new(layer, known).suggestion.map(family_of);
        let mut numbers = self.0.iter().map(|entry| entry.number.to_string());
        let numbers = numbers.next().into_iter().chain(numbers.next_back()).collect();
        LayerError::Unknown { found: layer.to_owned(), nearest, numbers }
    }
}
