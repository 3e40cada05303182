//! The values of a text as JSON.

use std::fmt::Display;

use frixel_scene::stem;
use serde_json::{Map, Value};
use toml::de::{DeTable, DeValue};

use super::node::{entries, number};

/// A value as JSON, with keys in the order of the text, which a [`Value`] would not keep.
pub(crate) fn of(value: &DeValue<'_>) -> String {
    match value {
        DeValue::String(text) => Value::from(&**text).to_string(),
        DeValue::Integer(_) | DeValue::Float(_) => Value::from(number(value)).to_string(),
        DeValue::Boolean(flag) => flag.to_string(),
        DeValue::Datetime(time) => Value::from(time.to_string()).to_string(),
        DeValue::Array(elements) => {
            let elements: Vec<String> = elements.iter().map(|element| of(element.get_ref())).collect();
            format!("[{}]", elements.join(","))
        }
        DeValue::Table(table) => object(members(table)),
    }
}

/// A layer as JSON: its fields in the order of the text, then the defaults of fields that it does not have in any unit.
pub(super) fn with_defaults(layer: &DeValue<'_>, defaults: &Map<String, Value>) -> String {
    let Some(table) = layer.as_table() else { return of(layer) };
    let is_absent = |name: &str| !table.keys().any(|own| stem(own.get_ref()) == stem(name));
    let absent = defaults.iter().filter(|(name, _)| is_absent(name));
    object(members(table).chain(absent.map(|(name, value)| member(name, value))))
}

fn object(members: impl Iterator<Item = String>) -> String {
    format!("{{{}}}", members.collect::<Vec<_>>().join(","))
}

fn members<'n>(table: &'n DeTable<'_>) -> impl Iterator<Item = String> + 'n {
    entries(table).into_iter().map(|(key, value)| member(key.get_ref(), of(value.get_ref())))
}

fn member(name: &str, value: impl Display) -> String {
    format!("{}:{value}", Value::from(name))
}
