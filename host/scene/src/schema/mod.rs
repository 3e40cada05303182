//! JSON schema of the scene file, for editors, derived from the fields that the parser reads. The parser receives texts
//! with only those fields that determine which others are known.

pub(super) mod variant;

use serde_json::{Map, Value, json};

use super::file::{VERSION, describe};
use super::grammar::{Holds, KnownField, KnownTable, Range};
use super::stack::LAYER_FIELDS;
use super::tables::layer::{KIND, NAME};
use variant::{Tables, Variant, variants};

/// A scene with empty tables, so that the parser reads their fields.
const EMPTY: &str =
    "version = 1\nscreen = { coating = [{}] }\nfinger = {}\ndrive = {}\ncarrier = {}\ntouch = {}\ndesign = {}\n";
/// The tables that are the same in all scenes.
const SHARED: [&str; 4] = ["drive", "carrier", "touch", "design"];
/// The tables that may complete a scene's layers; each layer of such a scene has the schema `shared_layer`.
const COMPLETING: [&str; 2] = ["defaults", "include"];

/// The schema (draft 7, which editors support), as a text that ends in a line feed.
pub fn json_schema() -> String {
    let mut definitions = Map::new();
    definitions.insert("layer".to_owned(), json!({ "oneOf": layers() }));
    definitions.insert("shared_layer".to_owned(), shared_layer(true));
    definitions.insert("defaults".to_owned(), shared_layer(false));
    definitions.insert("region".to_owned(), json!({ "oneOf": regions() }));
    definitions.insert("repeat".to_owned(), repeat());
    for table in describe(EMPTY).iter().filter(|table| SHARED.contains(&table.key)) {
        definitions.insert(table.key.to_owned(), object(table, &Map::new()));
    }
    let schema = json!({
        "$schema": "http://json-schema.org/draft-07/schema#",
        "title": "frixel scene",
        "description": "A scene of friction, in newtons: docs/design/scenes.md",
        "type": "object",
        "oneOf": scenes(),
        "definitions": definitions,
    });
    // A value that was just built always serializes.
    serde_json::to_string_pretty(&schema).unwrap_or_default() + "\n"
}

/// Schemas of a scene: with complete layers, and with layers completed by `[defaults]` or another file.
fn scenes() -> [Value; 2] {
    let [mut whole, mut shared] = ["layer", "shared_layer"].map(scene);
    if let Some(properties) = whole.pointer_mut("/properties").and_then(Value::as_object_mut) {
        properties.retain(|name, _| !COMPLETING.contains(&name.as_str()));
    }
    let either = COMPLETING.map(|table| json!({ "required": [table] }));
    if let Some(shared) = shared.as_object_mut() {
        shared.insert("anyOf".to_owned(), Value::from(either.to_vec()));
    }
    [whole, shared]
}

/// Schema of a layer whose fields are all optional, or of the fields that layers share.
fn shared_layer(is_layer: bool) -> Value {
    let mut properties = Map::new();
    for known in LAYER_FIELDS.iter().filter(|known| is_layer || known.field != NAME) {
        let name = known.field.name;
        let value = match name {
            "region" | "repeat" => json!({ "$ref": format!("#/definitions/{name}") }),
            _ => value(known),
        };
        properties.insert(name.to_owned(), value);
    }
    json!({ "type": "object", "properties": properties, "additionalProperties": false })
}

/// Schema of a scene whose layers have the schema `layer`.
fn scene(layer: &str) -> Value {
    let tables = describe(EMPTY);
    let Some(root) = tables.iter().find(|table| table.key.is_empty()) else { return Value::Null };
    let inner = |name: &str| {
        let mut inner = Map::new();
        for table in tables.iter().filter(|table| table.key == "coating" && name == "screen") {
            let slab = object(table, &Map::new());
            inner.insert("coating".to_owned(), one_or_more(&slab));
        }
        tables.iter().find(|table| table.key == name).map_or(Value::Null, |table| object(table, &inner))
    };
    let mut properties = Map::new();
    for KnownField { field, .. } in &root.fields {
        let name = field.name;
        let value = match field.holds {
            Holds::Table if SHARED.contains(&name) || name == "defaults" => {
                json!({ "$ref": format!("#/definitions/{name}") })
            }
            Holds::TableOrText if name == "finger" => with_name(fingers()),
            Holds::TableOrText => with_name(vec![inner(name)]),
            Holds::Tables => json!({ "type": "array", "items": { "$ref": format!("#/definitions/{layer}") } }),
            Holds::Texts => value(&KnownField { field: *field, words: Vec::new() }),
            _ => json!({ "const": VERSION }),
        };
        properties.insert(name.to_owned(), value);
    }
    json!({ "type": "object", "properties": properties, "required": root.required, "additionalProperties": false })
}

/// Schema of a table or a list of tables.
fn one_or_more(table: &Value) -> Value {
    json!({ "oneOf": [table, { "type": "array", "minItems": 1, "items": table }] })
}

/// Schema of one of several tables, or of the name of a file or bundled profile.
fn with_name(mut tables: Vec<Value>) -> Value {
    tables.push(json!({ "type": "string" }));
    json!({ "oneOf": tables })
}

/// Schemas of a finger, one for each set of fields that can occur together.
fn fingers() -> Vec<Value> {
    let tables = Tables { before: "version = 1\nfinger = {", after: "}", key: "finger" };
    variants(&tables).iter().map(|variant| variant_object(variant, &Map::new())).collect()
}

/// The schemas of a region, one for each shape.
fn regions() -> Vec<Value> {
    let tables = Tables { before: "layer = [{ kind = \"constant\", region = {", after: "} }]", key: "region" };
    variants(&tables).iter().map(|variant| variant_object(variant, &Map::new())).collect()
}

/// The schema of the copies of a layer.
fn repeat() -> Value {
    let tables = describe("layer = [{ kind = \"constant\", repeat = {} }]");
    tables.iter().find(|table| table.key == "repeat").map_or(Value::Null, |table| object(table, &Map::new()))
}

/// The schemas of a layer, one for each set of fields that can occur together.
fn layers() -> Vec<Value> {
    let none = describe("layer = [{}]");
    let known = none.iter().find(|table| table.key == "layer").into_iter().flat_map(|table| &table.fields);
    let kinds = known.filter(|known| known.field == KIND).flat_map(|known| &known.words);
    let layers = kinds.flat_map(|kind| {
        let before = format!("layer = [{{ kind = \"{kind}\"");
        let tables = Tables { before: &before, after: "}]", key: "layer" };
        let burst = describe(&format!("{before}, burst = {{}} }}]"));
        let burst = burst.iter().find(|table| table.key == "burst");
        let mut inner = Map::new();
        inner.insert("kind".to_owned(), json!({ "const": kind }));
        inner.insert("region".to_owned(), json!({ "$ref": "#/definitions/region" }));
        inner.insert("repeat".to_owned(), json!({ "$ref": "#/definitions/repeat" }));
        if let Some(burst) = burst {
            inner.insert("burst".to_owned(), object(burst, &Map::new()));
        }
        variants(&tables).iter().map(|variant| variant_object(variant, &inner)).collect::<Vec<_>>()
    });
    layers.collect()
}

/// The schema of a table for one variant, with the choices that lead to it.
fn variant_object(variant: &Variant, inner: &Map<String, Value>) -> Value {
    let mut inner = inner.clone();
    let mut table = variant.table.clone();
    for part in &variant.parts {
        if part.table && part.absent {
            table.fields.retain(|known| known.field.name != part.field);
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
    object(&table, &inner)
}

/// Schema of a table. `inner` has more precise schemas for some fields.
fn object(table: &KnownTable, inner: &Map<String, Value>) -> Value {
    let mut properties = Map::new();
    for known in &table.fields {
        let name = known.field.name;
        let mut value = inner.get(name).cloned().unwrap_or_else(|| value(known));
        // A `$ref` allows no other keys beside it.
        if let Some(object) = value.as_object_mut().filter(|object| !object.contains_key("$ref")) {
            object.insert("description".to_owned(), Value::from(plain(known.field.meaning)));
        }
        properties.insert(name.to_owned(), value);
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

fn value(known: &KnownField) -> Value {
    match known.field.holds {
        Holds::Number(range) => number("number", range),
        Holds::Whole(range) => number("integer", range),
        Holds::Flag => json!({ "type": "boolean" }),
        Holds::Text => json!({ "type": "string" }),
        Holds::Word => json!({ "enum": known.words }),
        Holds::Table => json!({ "type": "object" }),
        Holds::TableOrText => json!({ "type": ["object", "string"] }),
        Holds::Tables | Holds::TableOrTables => json!({ "type": "array", "items": { "type": "object" } }),
        Holds::NumberOrAuto(range) => json!({ "oneOf": [number("number", range), { "const": "auto" }] }),
        Holds::Texts => json!({ "type": "array", "items": { "type": "string" } }),
        Holds::Numbers(range) => json!({ "type": "array", "items": number("number", range) }),
        Holds::Interval(range) => two_numbers(range),
        Holds::Pairs(range) => json!({ "type": "array", "items": two_numbers(range) }),
    }
}

fn two_numbers(range: Range) -> Value {
    json!({ "type": "array", "items": number("number", range), "minItems": 2, "maxItems": 2 })
}

fn number(kind: &str, range: Range) -> Value {
    json!({ "type": kind, "minimum": range.min, "maximum": range.max })
}

/// Markdown without its links.
fn plain(markdown: &str) -> String {
    let mut text = String::new();
    for (number, part) in markdown.split("](").enumerate() {
        let rest = if number == 0 { part } else { part.split_once(')').map_or("", |(_, rest)| rest) };
        text.push_str(rest);
    }
    text.replace('[', "")
}
