//! A field of a scene by its path, and the values that a sweep gives it.

use std::collections::BTreeMap;

use frixel_scene::{Lines, Nearest, brief};
use serde::{Deserialize, Serialize};
use toml::de::{DeTable, DeValue};
use toml_edit::{DocumentMut, Item, TableLike};

use super::PlanError;
use super::plan::Places;

/// The name of the tables of layers.
const LAYER: &str = "layer";

/// A value of a field.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Value {
    /// `true` or `false`.
    Switch(bool),
    /// A whole number.
    Whole(i64),
    /// Any other number.
    Number(f64),
    /// A word, such as the name of a wave.
    Word(String),
}

impl Value {
    /// The value as a number; `None` for a word or a switch.
    pub fn number(&self) -> Option<f64> {
        match self {
            Self::Whole(number) => Some(*number as f64),
            Self::Number(number) => Some(*number),
            Self::Switch(_) | Self::Word(_) => None,
        }
    }
}

impl std::fmt::Display for Value {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Switch(is_on) => is_on.fmt(formatter),
            Self::Whole(number) => number.fmt(formatter),
            Self::Number(number) => number.fmt(formatter),
            Self::Word(word) => formatter.write_str(word),
        }
    }
}

impl From<&Value> for toml_edit::Value {
    fn from(value: &Value) -> Self {
        match value {
            Value::Switch(is_on) => (*is_on).into(),
            Value::Whole(number) => (*number).into(),
            Value::Number(number) => (*number).into(),
            Value::Word(word) => word.as_str().into(),
        }
    }
}

/// The text of a scene with fields set, which are added where the scene does not have them. A path is the names of
/// tables and of the field with dots between them; behind `layer` stands the number of a layer, from 1.
pub(super) fn with_fields(
    text: &str,
    scene: &str,
    fields: &BTreeMap<String, Value>,
    places: &Places,
) -> Result<String, PlanError> {
    let not_toml = |error: toml_edit::TomlError| format!("{scene} is not TOML: {}", error.to_string().trim_end());
    let mut document: DocumentMut = text.parse().map_err(not_toml).map_err(PlanError)?;
    for (path, value) in fields {
        set_at(&mut document, path, value)
            .map_err(|misplaced| places.refuse_parameter(path, &misplaced.in_scene(scene)))?;
    }
    Ok(document.to_string())
}

fn set_at<'p>(document: &mut DocumentMut, path: &'p str, value: &Value) -> Result<(), Misplaced<'p>> {
    let parts: Vec<&str> = path.split('.').collect();
    match parts.split_last() {
        Some((field, tables)) => set(document.as_table_mut(), tables, field, value),
        None => Err(Misplaced::Part(path)),
    }
}

/// Whether a scene has the field at a path, or its value, at a line and column.
pub(super) fn has_at(text: &str, path: &str, place: (usize, usize)) -> bool {
    let span = || {
        let root = DeValue::Table(DeTable::parse(text).ok()?.into_inner());
        path.split('.')
            .try_fold((0..text.len(), &root), |(_, item), name| match item {
                DeValue::Table(table) => {
                    let (key, value) = table.get_key_value(name)?;
                    Some((key.span().start..value.span().end, value.get_ref()))
                }
                DeValue::Array(items) => {
                    let item = items.get(name.parse::<usize>().ok()?.checked_sub(1)?)?;
                    Some((item.span(), item.get_ref()))
                }
                _ => None,
            })
            .map(|(span, _)| span)
    };
    let lines = Lines::of(text);
    let at = |offset| lines.line_and_column(text, offset);
    span().is_some_and(|span| (at(span.start)..at(span.end)).contains(&place))
}

/// The field of a scene whose name is nearest to that at a path, in the same table.
pub(super) fn nearest_field(text: &str, path: &str) -> Option<String> {
    let document: DocumentMut = text.parse().ok()?;
    let (tables, field) = path.rsplit_once('.')?;
    let mut item = document.as_item();
    for name in tables.split('.') {
        item = match name.parse::<usize>() {
            Ok(number) => item.get(number.checked_sub(1)?)?,
            Err(_) => item.get(name)?,
        };
    }
    let others = item.as_table_like()?.iter().map(|(name, _)| name).filter(|name| *name != field);
    Nearest::new(field, others).suggestion
}

/// The part of a path that does not fit.
enum Misplaced<'p> {
    /// It is not a table, or not a field.
    Part(&'p str),
    /// There is no such layer; the scene has this many.
    Layer(&'p str, usize),
}

impl Misplaced<'_> {
    fn in_scene(self, scene: &str) -> String {
        match self {
            Self::Part(part) => format!(
                "\"{}\" cannot be set in {scene}: give the path of one field, such as \"drive.voltage_max_v_rms\" or \
                 \"layer.2.high_n\"",
                brief(part)
            ),
            Self::Layer(found, count) => {
                let layers = match count {
                    0 => "no layers".to_owned(),
                    1 => "1 layer: write layer.1".to_owned(),
                    _ => format!("{count} layers: write layer.1 to layer.{count}"),
                };
                format!("{scene} has no layer {}, but {layers}", brief(found))
            }
        }
    }
}

fn set<'p>(table: &mut dyn TableLike, tables: &[&'p str], field: &'p str, value: &Value) -> Result<(), Misplaced<'p>> {
    let Some((name, rest)) = tables.split_first() else {
        return match table.get_mut(field) {
            Some(Item::Value(toml_edit::Value::InlineTable(_)) | Item::Table(_) | Item::ArrayOfTables(_)) => {
                Err(Misplaced::Part(field))
            }
            _ if field.is_empty() => Err(Misplaced::Part(field)),
            _ => {
                table.insert(field, Item::Value(value.into()));
                Ok(())
            }
        };
    };
    match (table.get_mut(name), rest.split_first()) {
        (Some(Item::ArrayOfTables(layers)), Some((number, rest))) => {
            let count = layers.len();
            let index = number.parse::<usize>().ok().and_then(|number| number.checked_sub(1));
            match index.and_then(|index| layers.get_mut(index)) {
                Some(layer) => set(layer, rest, field, value),
                None => Err(Misplaced::Layer(number, count)),
            }
        }
        (Some(item), _) => match item.as_table_like_mut() {
            Some(table) => set(table, rest, field, value),
            None => Err(Misplaced::Part(name)),
        },
        (None, Some((number, _))) if *name == LAYER => Err(Misplaced::Layer(number, 0)),
        (None, _) => {
            // The compiler says whether a scene has such a table.
            let Some(table) = table.entry(name).or_insert(toml_edit::table()).as_table_like_mut() else {
                return Err(Misplaced::Part(name));
            };
            set(table, rest, field, value)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SCENE: &str = "version = 1\n\n[[layer]]\nkind = \"constant\"\nfriction_n = 0.01 # little\n\n[[layer]]\nkind = \"grating\"\n\
                         region = { x_mm = 1, width_mm = 5 }\n";

    fn set(path: &str, value: &Value) -> Result<String, String> {
        let fields = BTreeMap::from([(path.to_owned(), value.clone())]);
        with_fields(SCENE, "a.toml", &fields, &Places::default()).map_err(|error| error.to_string())
    }

    #[test]
    fn a_field_of_a_layer_of_a_region_and_of_the_scene_is_set_or_added() {
        let set = |path, value| set(path, &value).unwrap();
        assert!(set("layer.1.friction_n", Value::Number(0.02)).contains("friction_n = 0.02"));
        assert!(set("layer.2.region.width_mm", Value::Whole(7)).contains("width_mm = 7"));
        assert!(set("layer.2.wave", Value::Word("saw".to_owned())).contains("wave = \"saw\""));
        let whole = set("drive.voltage_max_v_rms", Value::Whole(100));
        assert!(whole.contains("[drive]\nvoltage_max_v_rms = 100\n"), "{whole}");
    }

    #[test]
    fn a_path_that_leads_nowhere_is_named() {
        let value = Value::Whole(1);
        for (path, said) in [
            ("layer.3.high_n", "a.toml has no layer 3, but 2 layers: write layer.1 to layer.2"),
            ("layer.first.high_n", "no layer first"),
            ("layer.0.high_n", "no layer 0"),
            ("layer.1", "cannot be set in a.toml"),
            ("layer", "\"layer\" cannot be set"),
            ("layer.2.region", "\"region\" cannot be set"),
            ("version.x_mm", "\"version\" cannot be set"),
            ("layer.1.kind.x", "\"kind\" cannot be set"),
            ("", "cannot be set in a.toml"),
        ] {
            let error = set(path, &value).unwrap_err();
            assert!(error.contains(said), "{path}: {error}");
        }
    }
}
