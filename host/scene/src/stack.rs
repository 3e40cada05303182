//! The layers of a scene: included files first, each file with its own defaults.

use std::collections::HashMap;
use std::sync::LazyLock;

use toml::de::DeTable;

use super::defaults;
use super::fields::{Fields, PixelSize, overlaid};
use super::grammar::KnownField;
use super::kinds::Kind;
use super::layer::Layer;
use super::log::Log;
use super::mistake::FileMistake;
use super::schema::variant::known_layer_fields;
use super::source::SourceFile;
use super::tables;

/// Every field of any kind of layer.
pub(super) static LAYER_FIELDS: LazyLock<Vec<KnownField>> = LazyLock::new(known_layer_fields);

/// The tables of the layers of all files of a scene.
pub(super) struct LayerTables<'i> {
    /// From bottom to top, with their defaults.
    layers: Vec<Fields<'i>>,
    /// The defaults of each file.
    defaults: Vec<DeTable<'i>>,
}

impl<'i> LayerTables<'i> {
    /// Takes the layer tables out of the fields of a scene's files, of which the scene file is the first.
    pub(super) fn of(files: &mut [Fields<'i>], log: &mut Log) -> Self {
        let (mut tables, mut defaults, mut misspelt) = (Vec::new(), Vec::new(), Vec::new());
        for fields in files {
            let own = fields.table(log, &tables::scene::DEFAULTS).map(Fields::into_values).unwrap_or_default();
            misspelt.extend(defaults::check_names(&own, log));
            tables.push(fields.tables(log, &tables::scene::LAYER).unwrap_or_default());
            defaults.push(own);
        }
        let mut stacked = Vec::new();
        stack(0, &defaults, log.source().files(), &mut stacked);
        let mut layers = Vec::new();
        for (number, defaults) in stacked {
            let tables = tables.get_mut(number).map(std::mem::take).unwrap_or_default();
            layers.extend(tables.into_iter().map(|layer| layer.with_defaults(&defaults, &misspelt)));
        }
        Self { layers, defaults }
    }

    /// The paths of all pictures that layers name, relative to the scene file's folder, including layers with mistakes.
    pub(super) fn pictures(&self, log: &Log) -> Vec<String> {
        let named = self.layers.iter().filter_map(|layer| layer.raw_text("picture"));
        named.map(|(offset, name)| log.source().path_at(offset, &name)).collect()
    }

    /// Reads the layers, from bottom to top, without those that have mistakes. `pixel_mm` is the size of a pixel of the
    /// scene's design, if it has one.
    pub(super) fn read(self, pixel_mm: Option<PixelSize>, log: &mut Log) -> Vec<Layer> {
        if let Some(first) = self.layers.first().filter(|_| self.layers.len() > LAYERS_MAX) {
            log.add(first.places().table(), too_many(self.layers.len()));
            return Vec::new();
        }
        // Read every layer, to report the mistakes of all.
        let mut layers = Vec::new();
        for (number, table) in (1..).zip(self.layers) {
            let mistakes = log.mistakes();
            log.set_layer(Some(number));
            let copies = Layer::read(table.with_pixels(pixel_mm), number, log);
            let copies = copies.filter(|_| log.mistakes() == mistakes).unwrap_or_default();
            if layers.len() + copies.len() > LAYERS_MAX {
                log.add(copies.first().map_or(0, |layer| layer.places.table()), too_many(layers.len() + copies.len()));
                break;
            }
            layers.extend(copies);
        }
        log.set_layer(None);
        for layer in &mut layers {
            settle(layer, log);
        }
        check_names(&layers, log);
        for defaults in &self.defaults {
            defaults::check_values(defaults, pixel_mm, log);
        }
        layers
    }
}

fn too_many(found: usize) -> FileMistake {
    FileMistake::too_much(
        "layers in this scene",
        found,
        LAYERS_MAX,
        "no board supports more than 255; draw a pattern as a picture",
    )
}

/// The numbers of the files from bottom to top, ending with file `number`, each with the defaults of its layers. Its
/// own defaults take precedence over those of included files, of which the last one counts.
pub(super) fn stack<'i>(
    number: usize,
    own: &[DeTable<'i>],
    files: &[SourceFile],
    stacked: &mut Vec<(usize, DeTable<'i>)>,
) -> DeTable<'i> {
    let mut defaults = DeTable::new();
    let includes = files.get(number).map_or(&[][..], |file| &file.includes);
    for included in includes {
        defaults = overlaid(&defaults, stack(*included, own, files, stacked));
    }
    if let Some(own) = own.get(number) {
        defaults = overlaid(&defaults, own.clone());
    }
    stacked.push((number, defaults.clone()));
    defaults
}

/// Gives a picture its path from the scene file's folder.
fn settle(layer: &mut Layer, log: &Log) {
    if let Kind::Bitmap(bitmap) = &mut layer.kind {
        bitmap.picture = log.source().path_at(layer.places.field("picture"), &bitmap.picture);
    }
}

/// Largest number of layers in a scene, including copies; no board plays more than 255.
const LAYERS_MAX: usize = 4_096;

/// Refuses layers of the same name in two files.
fn check_names(layers: &[Layer], log: &mut Log) {
    let source = log.source();
    let place = |layer: &Layer| layer.places.field("name");
    // The first layer of each name, and the first one in another file.
    let mut first: HashMap<&str, (&Layer, Option<&Layer>)> = HashMap::new();
    for layer in layers {
        let Some(name) = layer.name.as_deref() else { continue };
        let here = source.number_at(place(layer));
        let is_here = |other: &Layer| source.number_at(place(other)) == here;
        let (one, other) = first.entry(name).or_insert((layer, None));
        if other.is_none() && !is_here(one) {
            *other = Some(layer);
        }
        let twin = if is_here(one) { *other } else { Some(*one) };
        if let Some(other) = twin.filter(|other| !is_here(other)) {
            let name = name.to_owned();
            let file = source.name_at(place(layer)).to_owned();
            log.add(
                place(layer),
                FileMistake::NameTwice { name, file, other: source.name_at(place(other)).to_owned() },
            );
        }
    }
}
