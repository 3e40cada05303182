//! Tests that the JSON schema agrees with the parser, and that `docs/design/scene.schema.json` is the generated one.

use std::fs;
use std::path::PathBuf;
use std::sync::LazyLock;

use frixel_testkit::golden;
use serde_json::Value;

use super::json_schema::is_valid;
use super::*;
use crate::diagnostic::Message;
use crate::json_schema;
use crate::mistake::{FieldMistake, FileMistake, Mistake};

static SCHEMA: LazyLock<Value> = LazyLock::new(|| serde_json::from_str(&json_schema()).expect("it is JSON"));

fn schema_takes(scene: &Value) -> bool {
    is_valid(&SCHEMA, &SCHEMA, scene)
}

/// Whether the schema accepts a text.
pub(super) fn takes_text(text: &str) -> bool {
    schema_takes(&json(text).expect("it is TOML"))
}

/// A scene as an editor's schema validates it. Values without a JSON form become `null`.
fn json(text: &str) -> Option<Value> {
    let table: toml::Table = toml::from_str(text).ok()?;
    serde_json::to_value(table).ok()
}

/// Whether a mistake is one of grammar, which a schema can detect.
fn is_grammar(diagnostic: &Diagnostic) -> bool {
    let Message::Mistake(mistake) = &diagnostic.message else { return false };
    matches!(
        mistake,
        Mistake::Field(
            FieldMistake::UnknownField { .. }
                | FieldMistake::Misplaced { .. }
                | FieldMistake::MissingField { .. }
                | FieldMistake::WrongType { .. }
                | FieldMistake::NotATable { .. }
                | FieldMistake::NotTables { .. }
                | FieldMistake::UnknownChoice { .. }
                | FieldMistake::TwoUnits { .. }
                | FieldMistake::NotWhole { .. }
        ) | Mistake::File(FileMistake::Version { .. })
    )
}

/// Panics if the schema accepts a text that the parser refuses for its grammar, or refuses one that the parser accepts.
#[track_caller]
pub(super) fn check_agrees(text: &str, mistakes: &[Diagnostic]) {
    let Some(scene) = json(text) else { return };
    // Only the parser knows the fields that `[defaults]` and other files give to a layer.
    let is_completed = ["defaults", "include"].iter().any(|table| scene.get(table).is_some());
    if mistakes.is_empty() {
        assert!(schema_takes(&scene), "the parser takes it, the schema does not:\n{text}");
    }
    let grammar = mistakes.iter().find(|mistake| is_grammar(mistake));
    if let Some(mistake) = grammar.filter(|_| !is_completed) {
        assert!(!schema_takes(&scene), "the schema does not see that {mistake}\n{text}");
    }
}

#[test]
fn the_schema_in_the_docs_is_the_one_that_is_made() {
    let path: PathBuf = scenes().join("../docs/design/scene.schema.json");
    golden::hold(&path, &json_schema());
}

#[test]
fn every_scene_of_the_gallery_is_valid() {
    let mut found = 0;
    for entry in fs::read_dir(scenes()).expect("a folder") {
        let path = entry.expect("a file").path();
        if path.extension().is_some_and(|extension| extension == "toml") {
            check_agrees(&fs::read_to_string(&path).expect("a text"), &[]);
            found += 1;
        }
    }
    assert!(found >= 8, "{found}");
}

/// The schema of a field of an object.
fn field<'v>(object: &'v Value, name: &str) -> &'v Value {
    &object["properties"][name]
}

#[test]
fn every_field_has_a_meaning() {
    let schema: Value = serde_json::from_str(&json_schema()).expect("it is JSON");
    let layers = schema["definitions"]["layer"]["oneOf"].as_array().expect("layers").iter();
    let tables = ["drive", "carrier", "touch"].map(|table| &schema["definitions"][table]);
    let scenes = schema["oneOf"].as_array().expect("scenes");
    let profiles = ["screen", "finger"].map(|table| field(&scenes[0], table)["oneOf"].as_array().expect("a list"));
    let profiles = profiles.into_iter().flatten().filter(|value| value["type"] == "object");
    let mut described = 0;
    for object in layers.chain(tables).chain(profiles) {
        for (name, field) in object["properties"].as_object().expect("fields") {
            // The kind describes itself, and a reference allows no other keys beside it.
            if name != "kind" && field.get("$ref").is_none() {
                assert!(field["description"].as_str().is_some_and(|text| !text.is_empty()), "{name} in {object}");
                described += 1;
            }
        }
    }
    assert!(described > 150, "{described}");
}
