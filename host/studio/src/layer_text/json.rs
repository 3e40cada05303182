//! The values of a text as JSON.

use serde_json::Value;
use toml::de::DeValue;

use super::node::{entries, number};

/// A value as JSON, with keys in the order of the text, which a [`Value`] would not keep.
pub(super) fn of(value: &DeValue<'_>) -> String {
    match value {
        DeValue::String(text) => Value::from(&**text).to_string(),
        DeValue::Integer(_) | DeValue::Float(_) => Value::from(number(value)).to_string(),
        DeValue::Boolean(flag) => flag.to_string(),
        DeValue::Datetime(time) => Value::from(time.to_string()).to_string(),
        DeValue::Array(elements) => {
            let elements: Vec<String> = elements.iter().map(|element| of(element.get_ref())).collect();
            format!("[{}]", elements.join(","))
        }
        DeValue::Table(table) => {
            let entries = entries(table).into_iter();
            let entries =
                entries.map(|(key, value)| format!("{}:{}", Value::from(&**key.get_ref()), of(value.get_ref())));
            format!("{{{}}}", entries.collect::<Vec<_>>().join(","))
        }
    }
}
