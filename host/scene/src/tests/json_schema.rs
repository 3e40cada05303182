//! Validates the keywords of JSON Schema (draft 7) that the schema of scenes uses. A library for all keywords takes
//! minutes to compile.

use serde_json::Value;

/// Whether a value is valid under a schema within `root`. Panics on a keyword that this module does not implement.
pub(super) fn is_valid(schema: &Value, root: &Value, value: &Value) -> bool {
    let rules = schema.as_object().expect("a schema is an object");
    if let Some(reference) = rules.get("$ref") {
        // Draft 7 ignores other keywords beside a reference.
        assert_eq!(rules.len(), 1, "{schema}");
        let pointer = reference.as_str().and_then(|text| text.strip_prefix('#')).expect("a place in this document");
        return is_valid(root.pointer(pointer).expect("what is referred to"), root, value);
    }
    let all_of = |rule: &Value, of: fn(usize, usize) -> bool| {
        let schemas = rule.as_array().expect("a list of schemas");
        of(schemas.iter().filter(|schema| is_valid(schema, root, value)).count(), schemas.len())
    };
    rules.iter().all(|(keyword, rule)| match keyword.as_str() {
        "$schema" | "title" | "description" | "definitions" => true,
        "type" => has_type(value, rule.as_str().expect("the name of a type")),
        "const" => is_equal(rule, value),
        "enum" => rule.as_array().expect("a list of values").iter().any(|one| is_equal(one, value)),
        "minimum" => value.as_f64().is_none_or(|number| number >= rule.as_f64().expect("a number")),
        "maximum" => value.as_f64().is_none_or(|number| number <= rule.as_f64().expect("a number")),
        "minItems" => value.as_array().is_none_or(|items| items.len() as u64 >= rule.as_u64().expect("a count")),
        "maxItems" => value.as_array().is_none_or(|items| items.len() as u64 <= rule.as_u64().expect("a count")),
        "items" => value.as_array().is_none_or(|items| items.iter().all(|item| is_valid(rule, root, item))),
        "required" => value.as_object().is_none_or(|fields| {
            let names = rule.as_array().expect("a list of names");
            names.iter().all(|name| fields.contains_key(name.as_str().expect("a name")))
        }),
        "properties" => value.as_object().is_none_or(|fields| {
            let schemas = rule.as_object().expect("schemas by name");
            fields.iter().all(|(name, field)| schemas.get(name).is_none_or(|schema| is_valid(schema, root, field)))
        }),
        "additionalProperties" => {
            assert_eq!(*rule, Value::Bool(false), "only `false` is known here");
            let known = |name: &String| rules["properties"].get(name).is_some();
            value.as_object().is_none_or(|fields| fields.keys().all(known))
        }
        "oneOf" => all_of(rule, |valid, _| valid == 1),
        "anyOf" => all_of(rule, |valid, _| valid > 0),
        "allOf" => all_of(rule, |valid, all| valid == all),
        "not" => !is_valid(rule, root, value),
        other => panic!("the keyword `{other}` is not known here"),
    })
}

fn has_type(value: &Value, name: &str) -> bool {
    match name {
        "object" => value.is_object(),
        "array" => value.is_array(),
        "string" => value.is_string(),
        "boolean" => value.is_boolean(),
        "number" => value.is_number(),
        "integer" => value.as_f64().is_some_and(|number| number.fract() == 0.0),
        other => panic!("the type `{other}` is not known here"),
    }
}

/// 1 and 1.0 are the same number.
fn is_equal(one: &Value, other: &Value) -> bool {
    match (one.as_f64(), other.as_f64()) {
        (Some(one), Some(other)) => one.total_cmp(&other).is_eq(),
        _ => one == other,
    }
}
