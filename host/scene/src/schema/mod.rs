//! A JSON schema of the scene file, for editors. It is made by asking the parser what it would read: texts that leave out
//! everything but what decides on the fields of a table.

mod meaning;
mod variant;

use serde_json::{Map, Value, json};

use super::asked::{Asked, AskedTable, Holds};
use super::fields::Range;
use super::file::{VERSION, describe};
use meaning::Meanings;
use variant::{Tables, Variant, variants};

/// The tables of a scene, empty, so that the parser asks for their fields.
const EMPTY: &str = "coating = [{}]\nscreen = {}\nfinger = {}\ndrive = {}\ncarrier = {}\ntouch = {}\n";

/// The schema (draft 7, which editors know), as a text that ends in a line feed.
pub fn json_schema() -> String {
    let meanings = Meanings::of_docs();
    let mut properties = Map::new();
    let tables = describe(EMPTY);
    let Some(root) = tables.iter().find(|table| table.key.is_empty()) else { return String::new() };
    for Asked { field, holds } in &root.asked {
        let inner = || match tables.iter().find(|table| table.key == *field) {
            Some(table) => object(table, &Map::new(), &meanings.section(field)),
            None => json!({ "oneOf": layers(&meanings) }),
        };
        let value = match holds {
            Holds::Table => inner(),
            Holds::Tables { one: true } => {
                let table = inner();
                json!({ "oneOf": [table, { "type": "array", "minItems": 1, "items": table }] })
            }
            Holds::Tables { one: false } => json!({ "type": "array", "items": inner() }),
            _ => json!({ "const": VERSION }),
        };
        properties.insert((*field).to_owned(), value);
    }
    let schema = json!({
        "$schema": "http://json-schema.org/draft-07/schema#",
        "title": "frixel scene",
        "description": "A scene of friction, in newtons: docs/scene.md",
        "type": "object",
        "properties": properties,
        "required": root.required,
        "additionalProperties": false,
        "definitions": { "region": { "oneOf": regions(&meanings) } },
    });
    // A value that was just made always has a text.
    serde_json::to_string_pretty(&schema).unwrap_or_default() + "\n"
}

/// What a region may be, one for each shape.
fn regions(meanings: &Meanings) -> Vec<Value> {
    let tables = Tables { before: "layer = [{ kind = \"constant\", region = {", after: "} }]", key: "region" };
    let section = meanings.section("regions");
    variants(&tables).iter().map(|variant| variant_object(variant, &Map::new(), &section)).collect()
}

/// What a layer may be, one for each set of fields that goes together.
fn layers(meanings: &Meanings) -> Vec<Value> {
    let none = describe("layer = [{}]");
    let kinds = none.iter().find(|table| table.key == "layer").into_iter().flat_map(|table| &table.asked);
    let kinds = kinds.filter_map(|asked| match &asked.holds {
        Holds::Choice(words) if asked.field == "kind" => Some(words.clone()),
        _ => None,
    });
    let layers = kinds.flatten().flat_map(|kind| {
        let section = meanings.layer(kind);
        let before = format!("layer = [{{ kind = \"{kind}\"");
        let tables = Tables { before: &before, after: "}]", key: "layer" };
        let burst = describe(&format!("{before}, burst = {{}} }}]"));
        let burst = burst.iter().find(|table| table.key == "burst");
        let mut inner = Map::new();
        inner.insert("kind".to_owned(), json!({ "const": kind }));
        inner.insert("region".to_owned(), json!({ "$ref": "#/definitions/region" }));
        if let Some(burst) = burst {
            inner.insert("burst".to_owned(), object(burst, &Map::new(), &section));
        }
        variants(&tables).iter().map(|variant| variant_object(variant, &inner, &section)).collect::<Vec<_>>()
    });
    layers.collect()
}

/// A table with the choices made that a variant stands for.
fn variant_object(variant: &Variant, inner: &Map<String, Value>, meanings: &meaning::Section) -> Value {
    let mut inner = inner.clone();
    let mut table = variant.table.clone();
    for part in &variant.parts {
        if part.table && part.absent {
            table.asked.retain(|asked| asked.field != part.field);
        }
        if !part.words.is_empty() {
            inner.insert(part.field.to_owned(), json!({ "enum": part.words }));
        }
        if !part.absent {
            table.required.push(part.field);
        }
    }
    table.required.sort_unstable();
    table.required.dedup();
    object(&table, &inner, meanings)
}

/// A table; `inner` are fields that are known better than from what was asked.
fn object(table: &AskedTable, inner: &Map<String, Value>, meanings: &meaning::Section) -> Value {
    let mut properties = Map::new();
    for Asked { field, holds } in &table.asked {
        let mut value = inner.get(*field).cloned().unwrap_or_else(|| holds_value(holds));
        if let (Some(object), Some(meaning)) = (value.as_object_mut(), meanings.of(field)) {
            object.insert("description".to_owned(), Value::from(meaning));
        }
        properties.insert((*field).to_owned(), value);
    }
    let mut required = table.required.clone();
    let mut rules = Vec::new();
    for [one, other] in &table.either {
        if required.contains(one) {
            required.retain(|field| field != one);
            rules.push(json!({ "oneOf": [{ "required": [one] }, { "required": [other] }] }));
        } else {
            rules.push(json!({ "not": { "required": [one, other] } }));
        }
    }
    let mut object = json!({
        "type": "object",
        "properties": properties,
        "required": required,
        "additionalProperties": false,
    });
    if let (Some(object), false) = (object.as_object_mut(), rules.is_empty()) {
        object.insert("allOf".to_owned(), Value::from(rules));
    }
    object
}

fn holds_value(holds: &Holds) -> Value {
    match holds {
        Holds::Number(range) => number("number", range),
        Holds::Whole(range) => number("integer", range),
        Holds::Flag => json!({ "type": "boolean" }),
        Holds::Text => json!({ "type": "string" }),
        Holds::Choice(words) => json!({ "enum": words }),
        Holds::Table => json!({ "type": "object" }),
        Holds::Tables { .. } => json!({ "type": "array", "items": { "type": "object" } }),
        Holds::Numbers(range) => json!({ "type": "array", "items": number("number", range) }),
        Holds::Pairs(range) => {
            let pair = json!({ "type": "array", "items": number("number", range), "minItems": 2, "maxItems": 2 });
            json!({ "type": "array", "items": pair })
        }
    }
}

fn number(kind: &str, range: &Range) -> Value {
    json!({ "type": kind, "minimum": range.min, "maximum": range.max })
}
