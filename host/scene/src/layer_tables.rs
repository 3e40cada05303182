//! The layer tables of a scene's files, for a page that lists them beside their text.

use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::file::Scene;
use super::layer::{Layer, Rectangle, Region};
use super::source::SourceFile;
use super::stack::stack;
use super::tables::{layer, scene};
use super::toml_text::toml;

/// A layer table as written. With `repeat`, it defines several layers of the scene.
#[derive(Clone, Debug, PartialEq)]
pub struct LayerTable {
    /// Number of the table in messages, from one.
    pub number: usize,
    /// The name in the file.
    pub name: Option<String>,
    /// The value of `kind`.
    pub kind: &'static str,
    /// The gain in the file.
    pub gain: f64,
    /// Whether it is on at the start of a play.
    pub starts_on: bool,
    /// Numbers of its layers, as accepted by [`LayerMap::records`](crate::LayerMap::records): `3`, or `3.1`, `3.2` and
    /// so on for copies.
    pub layers: Vec<String>,
    /// The name of the file in messages.
    pub file: String,
    /// First and last line of the table in its file, from one.
    pub lines: (usize, usize),
    /// Left, top, width and height of the region of all its layers, mm; `None` for the whole screen.
    pub bounds_mm: Option<[f64; 4]>,
}

impl Scene {
    /// The layer tables of all files, from bottom to top, without those that have mistakes.
    pub fn layer_tables(&self) -> Vec<LayerTable> {
        let written: Vec<Written> = self.source.files().iter().flat_map(written).collect();
        let mut found: Vec<(LayerTable, Vec<Rectangle>)> = Vec::new();
        for layer in &self.layers {
            if found.last().is_none_or(|(table, _)| table.number != layer.number().table) {
                found.push((self.layer_table(layer, &written), Vec::new()));
            }
            if let Some((table, regions)) = found.last_mut() {
                table.layers.push(layer.number().to_string());
                regions.extend(layer.region.as_ref().map(Region::bounds));
            }
        }
        let with_bounds = found.into_iter().map(|(table, regions)| LayerTable { bounds_mm: bounds(&regions), ..table });
        with_bounds.collect()
    }

    /// Each file's name in messages, with the defaults of its layers. They come from `[defaults]` of the file itself and
    /// of the files that it includes.
    pub fn layer_defaults(&self) -> Vec<(&str, DeTable<'_>)> {
        let files = self.source.files();
        let own = |file| {
            let defaults = toml(file).ok()?.remove(scene::DEFAULTS.name)?.into_inner();
            if let DeValue::Table(table) = defaults { Some(table) } else { None }
        };
        let own: Vec<DeTable> = files.iter().map(|file| own(&file.text).unwrap_or_default()).collect();
        let mut stacked = Vec::new();
        stack(0, &own, files, &mut stacked);
        let named = |(number, defaults)| Some((files.get::<usize>(number)?.name.as_str(), defaults));
        stacked.into_iter().filter_map(named).collect()
    }

    /// The table of a layer, without its layers.
    fn layer_table(&self, layer: &Layer, written: &[Written]) -> LayerTable {
        let start = layer.places.table();
        let text = written.iter().find(|table| table.places.start == start);
        let end = text.map_or(start, |table| table.places.end);
        let line = |offset| self.source.line_and_column(offset).0;
        LayerTable {
            number: layer.number().table,
            name: text.and_then(|table| table.name.clone()),
            kind: layer.kind.word(),
            gain: layer.gain,
            starts_on: layer.starts_on,
            layers: Vec::new(),
            file: self.source.name_at(start).to_owned(),
            lines: (line(start), line(end)),
            bounds_mm: None,
        }
    }
}

/// A layer table in a text.
struct Written {
    /// From the table's first byte to the end of its last value.
    places: Range<usize>,
    name: Option<String>,
}

/// The layer tables of a file, at their offsets in the scene's source.
fn written(file: &SourceFile) -> Vec<Written> {
    let Ok(values) = toml(&file.text) else { return Vec::new() };
    let tables = values.get(scene::LAYER.name).and_then(|layers| layers.get_ref().as_array());
    let written = |value: &Spanned<DeValue>| {
        let name = value.get_ref().get(layer::NAME.name).and_then(|name| name.get_ref().as_str());
        Written { places: file.start + value.span().start..file.start + end(value), name: name.map(str::to_owned) }
    };
    tables.into_iter().flatten().map(written).collect()
}

/// Offset of the last byte of a value, and of the values in it. A table's own span is that of its header.
fn end(value: &Spanned<DeValue>) -> usize {
    let own = value.span().end.saturating_sub(1);
    let inner = match value.get_ref() {
        DeValue::Table(fields) => fields.values().map(end).max(),
        DeValue::Array(values) => values.iter().map(end).max(),
        _ => None,
    };
    own.max(inner.unwrap_or(own))
}

/// The smallest rectangle around several.
fn bounds(regions: &[Rectangle]) -> Option<[f64; 4]> {
    let corners = |region: &Rectangle| {
        [(region.x_mm, region.y_mm), (region.x_mm + region.width_mm, region.y_mm + region.height_mm)]
    };
    let corners: Vec<(f64, f64)> = regions.iter().flat_map(corners).collect();
    (!corners.is_empty()).then(|| {
        let Rectangle { x_mm, y_mm, width_mm, height_mm } = Rectangle::around(&corners);
        [x_mm, y_mm, width_mm, height_mm]
    })
}
