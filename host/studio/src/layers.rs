//! The layers of a scene's files, for a page that lists them beside the text.

use frixel_felt::check::feel;
use frixel_felt::perception::Perception;
use frixel_layers::range;
use frixel_scene::{LayerTable, Program, Scene};
use serde::Serialize;

/// A layer as it is written in a file. With `repeat`, it is several layers of the scene.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(rename_all = "camelCase")]
pub(crate) struct FileLayer {
    /// Number of the layer in messages, from 1.
    index: usize,
    /// Its name, or else its kind.
    name: String,
    /// Its kind.
    kind: &'static str,
    /// What a person will feel of it, or of its first copy, one sentence; empty for a layer that is not felt anywhere.
    felt: String,
    /// The numbers of its layers in control lines.
    controls: Vec<String>,
    /// Whether they can be changed while they play.
    is_live: bool,
    /// Why they cannot, one sentence; empty if they can.
    why_not_live: String,
    /// Whether they are on when the scene begins to play.
    starts_on: bool,
    /// The gain in the file, and the least and the largest that a board takes.
    gain: f64,
    gain_min: f64,
    gain_max: f64,
    /// The file that it stands in, if that is not the scene.
    #[serde(skip_serializing_if = "Option::is_none")]
    file: Option<String>,
    /// First and last line of its table, from 1.
    from: (usize, usize),
    /// Left, top, width and height of its region, mm; `null` for the whole screen.
    box_mm: Option<[f64; 4]>,
}

/// The layers of a scene, called `entry`, that was compiled to `program`.
pub(crate) fn layers(scene: &Scene, entry: &str, program: &Program, perception: &Perception) -> Vec<FileLayer> {
    let describe = |table: LayerTable| {
        let LayerTable { number, name, kind, gain, starts_on, layers, file, lines, bounds_mm } = table;
        let live = layers.iter().try_for_each(|layer| program.layers.record(layer).map(drop));
        FileLayer {
            index: number,
            name: name.unwrap_or_else(|| kind.to_owned()),
            kind,
            felt: felt(number, perception),
            controls: layers,
            is_live: live.is_ok(),
            why_not_live: live.err().map_or(String::new(), |error| error.to_string()),
            starts_on,
            gain,
            gain_min: range::GAIN.min,
            gain_max: range::GAIN.max,
            file: (file != entry).then_some(file),
            from: lines,
            box_mm: bounds_mm,
        }
    };
    scene.layer_tables().into_iter().map(describe).collect()
}

/// The sentence on the layer of the table with this number, or on its first copy.
fn felt(table: usize, perception: &Perception) -> String {
    let layer = perception.layers.iter().find(|layer| layer.layer.number().table == table);
    layer.map_or(String::new(), feel::sentence)
}
