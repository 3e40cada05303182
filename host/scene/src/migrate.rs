//! Writes a scene file of version 1 as version 2.

use toml_edit::{Array, DocumentMut, InlineTable, Item, TableLike, Value};

use super::compile_error::CompileError;
use super::file::{Scene, Version};
use super::files::Files;
use super::kinds::{Bitmap, PITCH_V1_MM, Words};
use super::log::Log;
use super::mistake::FileMistake;
use super::screen::{Screen, Slab};

/// Writes the text of a scene of version 1 as version 2, with its layout and its comments but for those of `[coating]`.
///
/// The friction stays the same, because coating and skin keep their effective gap together. Version 1 does not say
/// which part of it is skin: slabs of permittivity 1 are taken for air and become the finger's skin gap. If that leaves
/// no coating, the screen gets [`Slab::EXAMPLE`], whose gap is taken from the skin's. A picture without a pitch gets
/// the one that version 1 gives it. A scene of version 2 is refused.
pub fn migrate(text: &str, name: &str, files: &dyn Files) -> Result<String, CompileError> {
    let scene = Scene::parse(text, name, files)?;
    let mut log = Log::resuming(&scene.source, &scene.mistakes);
    if scene.version != Version::One {
        log.add(scene.version_place, FileMistake::NothingToMigrate);
        return log.finish(None);
    }
    // A text that `Scene::parse` reads is TOML with these tables.
    let migrated = text.parse::<DocumentMut>().ok().and_then(|document| rewritten(document, scene.screen()));
    log.finish(Some(migrated.unwrap_or_default()))
}

fn rewritten(mut document: DocumentMut, screen: &Screen) -> Option<String> {
    let (coating, skin_gap_um) = split(screen);
    if let Some(version) = document.get_mut("version").and_then(Item::as_value_mut) {
        let decor = version.decor().clone();
        *version = Value::from(2);
        *version.decor_mut() = decor;
    }
    document.remove("coating");
    let slabs = coating.iter().map(|slab| {
        let mut table = InlineTable::new();
        table.insert("thickness_um", number(slab.thickness_um));
        table.insert("permittivity", number(slab.permittivity));
        Value::from(table)
    });
    let slabs: Vec<Value> = slabs.collect();
    let coating = match <[Value; 1]>::try_from(slabs) {
        Ok([slab]) => slab,
        Err(slabs) => Value::from(Array::from_iter(slabs)),
    };
    for layer in layers(&mut document) {
        let is_bitmap = layer.get("kind").and_then(Item::as_str) == Some(Bitmap::WORD);
        if is_bitmap && layer.get("pitch_mm").is_none() {
            layer.insert("pitch_mm", Item::Value(number(PITCH_V1_MM)));
        }
    }
    table(&mut document, "screen")?.insert("coating", Item::Value(coating));
    table(&mut document, "finger")?.insert("skin_gap_um", Item::Value(number(skin_gap_um)));
    Some(document.to_string())
}

fn layers(document: &mut DocumentMut) -> Vec<&mut dyn TableLike> {
    match document.get_mut("layer") {
        Some(Item::ArrayOfTables(tables)) => tables.iter_mut().map(|table| table as &mut dyn TableLike).collect(),
        Some(Item::Value(Value::Array(values))) => {
            let tables = values.iter_mut().filter_map(Value::as_inline_table_mut);
            tables.map(|table| table as &mut dyn TableLike).collect()
        }
        _ => Vec::new(),
    }
}

fn table<'d>(document: &'d mut DocumentMut, name: &str) -> Option<&'d mut dyn TableLike> {
    document.get_mut(name).and_then(Item::as_table_like_mut)
}

/// Whole numbers are written without a fraction.
fn number(number: f64) -> Value {
    if number.fract() == 0.0 && number.abs() < 1e15 { Value::from(number as i64) } else { Value::from(number) }
}

/// The coating of the screen, and the skin gap of the finger, um.
fn split(screen: &Screen) -> (Vec<Slab>, f64) {
    let total_um = screen.coating_gap_um();
    let is_solid = |slab: &&Slab| slab.permittivity > 1.0;
    let solid: Vec<Slab> = screen.coating.iter().filter(is_solid).copied().collect();
    let coating = if solid.is_empty() { vec![Slab::EXAMPLE] } else { solid };
    let coating_um = Screen { coating: coating.clone(), ..screen.clone() }.coating_gap_um();
    if coating_um > total_um { (screen.coating.clone(), 0.0) } else { (coating, total_um - coating_um) }
}
