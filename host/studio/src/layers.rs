//! The layers of a scene file, for a page that lists them beside the text.

use frixel_scene::Program;
use frixel_scene::check::feel;
use frixel_scene::perception::Perception;
use serde::Serialize;
use toml::de::{DeTable, DeValue};

/// A layer of a scene file.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct FileLayer {
    /// Number of the layer in the file, from 1.
    index: usize,
    /// Its name, or else its kind.
    name: String,
    /// Its kind.
    kind: String,
    /// What a person will feel of it, one sentence; empty for a layer that is not felt anywhere, or repeated.
    felt: String,
    /// Whether it can be changed while it plays.
    is_live: bool,
    /// Why it cannot, one sentence; empty if it can.
    why_not_live: String,
    /// First and last line of its table, from 1.
    from: [usize; 2],
}

/// The layers of a text that was compiled to `program`.
pub(crate) fn layers(text: &str, program: &Program, perception: &Perception) -> Vec<FileLayer> {
    let Ok(document) = DeTable::parse(text) else { return Vec::new() };
    let tables = document.get_ref().get("layer").and_then(|layers| layers.get_ref().as_array());
    let word = |table: &DeValue, key: &str| {
        table.as_table().and_then(|table| table.get(key)?.get_ref().as_str().map(str::to_owned))
    };
    let tables = tables.into_iter().flat_map(|tables| tables.iter());
    let describe = |(index, table): (usize, &toml::Spanned<DeValue>)| {
        let kind = word(table.get_ref(), "kind").unwrap_or_default();
        let live = program.layers.record(&index.to_string());
        FileLayer {
            index,
            name: word(table.get_ref(), "name").unwrap_or_else(|| kind.clone()),
            kind,
            felt: felt(index, perception),
            is_live: live.is_ok(),
            why_not_live: live.err().map_or(String::new(), |error| error.to_string()),
            from: [0, 0],
        }
    };
    let mut layers: Vec<FileLayer> = (1..).zip(tables).map(describe).collect();
    for (layer, lines) in layers.iter_mut().zip(layer_lines(text)) {
        layer.from = lines;
    }
    layers
}

/// The sentence on the layer with this number.
fn felt(index: usize, perception: &Perception) -> String {
    let title = format!("layer {index}");
    let is_it = |other: &str| other.strip_prefix(&title).is_some_and(|rest| rest.is_empty() || rest.starts_with(' '));
    let layer = perception.layers.iter().find(|layer| is_it(&layer.layer));
    layer.map_or(String::new(), feel::sentence)
}

/// First and last line of each `[[layer]]` table, from 1, without the empty lines and comments behind it.
fn layer_lines(text: &str) -> Vec<[usize; 2]> {
    let mut ranges: Vec<[usize; 2]> = Vec::new();
    let mut is_in_layer = false;
    for (number, line) in (1..).zip(text.lines().map(str::trim)) {
        if line.starts_with("[[layer]]") {
            is_in_layer = true;
            ranges.push([number, number]);
        } else if line.starts_with('[') && line.ends_with(']') && !line.starts_with("[layer.") && !line.contains(',') {
            is_in_layer = false;
        } else if is_in_layer
            && !line.is_empty()
            && !line.starts_with('#')
            && let Some([_, last]) = ranges.last_mut()
        {
            *last = number;
        }
    }
    ranges
}

#[cfg(test)]
mod tests {
    use super::layer_lines;

    #[test]
    fn the_lines_of_a_layer_end_before_the_next_table() {
        let text =
            "version = 2\n\n[[layer]]\nkind = \"grating\"\n\n# keys\n[[layer]]\nkind = \"bitmap\"\n\n[drive]\nx = 1\n";
        assert_eq!(layer_lines(text), [[3, 4], [7, 8]]);
    }
}
