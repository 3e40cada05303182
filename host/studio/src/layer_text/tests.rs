//! An independent reader sees what an edit has changed and nothing else, and what it did not have to touch stays as it
//! was, byte by byte.

use std::fs;
use std::path::Path;

use serde_json::json;
use toml::{Table, Value};

use super::{TextError, edit, read};

const FORMS: &str = "# 🖐 a head\nversion = 1 # one\n\n[ defaults ]\ny_mm=40\nregion.x_mm = 1.50\nregion . y_mm = +2\n\n\
    # above\n[[layer]] # first\n  \"kind\" = 'rings'\n  region.x_mm = 3   # left\n  region.shape = \"ellipse\"\n  \
    points = [ [0, 1.0],\n    [2.5, 1_000], # inside\n  ]\n# below\n\n[layer.burst]\nperiod_ms = 1e3\n\n[[layer]]\n\
    region = {x_mm = 1.0, \"y_mm\" = 2,width_mm=3}\nburst = {}\n\n# the last one\n[[layer]]\n# empty\n[layer.region]\n\
    x_mm = -0.5#close";
const ARRAY: &str = "version = 1\nlayer = [\n  { kind = \"constant\", friction_n = 0.3 }, # one\n  \
    { kind = \"stream\", region.x_mm = 1 },\n]\n";
/// Forms that only a hand writes: words of tables in a string, hexadecimal, a table out of order, comments inside,
/// dotted keys apart from each other.
const ODD: &str = "version = 1\n\n[[layer]]\nkind = \"rings\"\nfrom.x = 1\ngain = 0x1F\nfrom.y = 2 # apart\n\
    note = \"\"\"\n[[layer]] # no table\ngain = 7\n\"\"\"\nregion = { x_mm = 1, # left\n  y_mm = 0b11, \
    width_mm = 5 }\n\n[design]\nwidth_px = 1200\n\n[layer.repeat]\ncolumns = 0o17\ndx_mm = 4\n\n[[layer]]\ngain = 2\n";

/// These, and the scenes of the gallery.
fn texts() -> Vec<String> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let paths = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let scenes = paths.filter(|path| path.extension().is_some_and(|extension| extension == "toml"));
    let own = [FORMS, ARRAY, ODD].map(str::to_owned);
    let texts: Vec<String> = own.into_iter().chain(scenes.map(|path| fs::read_to_string(path).unwrap())).collect();
    assert!(texts.len() > 10, "{}", texts.len());
    texts
}

/// Values with all numbers as floating-point numbers.
fn plain(value: Value) -> Value {
    match value {
        Value::Integer(number) => Value::Float(number as f64),
        Value::Array(values) => values.into_iter().map(plain).collect::<Vec<_>>().into(),
        Value::Table(table) => Value::Table(table.into_iter().map(|(key, value)| (key, plain(value))).collect()),
        value => value,
    }
}

/// The values of a text.
fn parsed(text: &str) -> Value {
    plain(Value::Table(text.parse::<Table>().unwrap_or_else(|error| panic!("{error}\n{text}"))))
}

/// A text after an act with these words.
fn edited(act: &str, text: &str, words: &[&str]) -> Result<String, TextError> {
    edit(&[&[act, text], words].concat().join("\0"))
}

/// The words of a change of the value at a path.
fn change(path: &str, value: &str, after: &str) -> [String; 3] {
    [path.replace('.', "\n"), value.to_owned(), after.to_owned()]
}

fn set(text: &str, changes: &[[String; 3]]) -> Result<String, TextError> {
    let words: Vec<&str> = changes.as_flattened().iter().map(String::as_str).collect();
    edited("set", text, &words)
}

/// The paths of all numbers, each with a pointer to set them in parsed values.
fn numbers<'v>(value: &'v mut Value, path: &str, found: &mut Vec<(String, &'v mut f64)>) {
    let behind = |key: &str| if path.is_empty() { key.to_owned() } else { format!("{path}.{key}") };
    match value {
        Value::Float(number) => found.push((path.to_owned(), number)),
        Value::Array(values) => {
            values.iter_mut().enumerate().for_each(|(at, value)| numbers(value, &behind(&at.to_string()), found));
        }
        Value::Table(table) => table.iter_mut().for_each(|(key, value)| numbers(value, &behind(key), found)),
        _ => {}
    }
}

#[test]
fn a_number_is_changed_where_it_stands_and_nothing_else() {
    let mut changed = 0;
    for text in texts() {
        let mut before = parsed(&text);
        let mut paths = Vec::new();
        numbers(&mut before, "", &mut paths);
        let count = paths.len();
        for (at, value) in (0..count).flat_map(|at| ["-3", "0", "64", "0.3", "-123456.79"].map(|value| (at, value))) {
            let mut expected = parsed(&text);
            let mut paths = Vec::new();
            numbers(&mut expected, "", &mut paths);
            let (path, number) = paths.swap_remove(at);
            let is_same = Ok(*number) == value.parse();
            *number = value.parse().unwrap();
            let after = set(&text, &[change(&path, value, "")]).unwrap();
            assert_eq!(parsed(&after), expected, "{path:?} = {value}");
            assert_eq!(after == text, is_same, "{path:?} = {value}");
            let same = |(one, other): &(u8, u8)| one == other;
            let from = text.bytes().zip(after.bytes()).take_while(same).count();
            let to = text.bytes().rev().zip(after.bytes().rev()).take_while(same).count();
            let digits = text.get(from..(text.len() - to).max(from)).unwrap();
            assert!(digits.chars().all(|digit| digit.is_ascii_hexdigit() || "+-._xo".contains(digit)), "{digits:?}");
            changed += usize::from(!is_same);
        }
    }
    assert!(changed > 500, "{changed} changes");
}

#[test]
fn several_values_are_changed_at_once_and_a_number_keeps_its_point() {
    let changes = [
        change("layer.1.region.width_mm", "4.25", ""),
        change("layer.0.points.1.0", "7", ""),
        change("layer.0.kind", "\"edge\"", ""),
        change("layer.1.region.x_mm", "6", ""),
    ];
    let expected = FORMS.replace("[2.5,", "[7.0,").replace("{x_mm = 1.0", "{x_mm = 6.0").replace("=3}", "=4.25}");
    assert_eq!(set(FORMS, &changes).unwrap(), expected.replace("'rings'", "\"edge\""));
}

#[test]
fn a_key_that_is_missing_is_added_in_the_form_that_its_table_has() {
    for (text, path, value, from, to) in [
        (FORMS, "layer.0.region.y_mm", "4", "\"ellipse\"", "\"ellipse\"\n  region.y_mm = 4"),
        (FORMS, "defaults.region.width_mm", "4", "= +2", "= +2\nregion.width_mm = 4"),
        (FORMS, "layer.1.region.height_mm", "4", "width_mm=3}", "width_mm=3, height_mm = 4}"),
        (FORMS, "layer.1.burst.on_ms", "4", "burst = {}", "burst = { on_ms = 4 }"),
        (FORMS, "layer.1.gain", "0.5", "burst = {}", "burst = {}\ngain = 0.5"),
        (FORMS, "layer.2.gain", "0.5", "# empty", "gain = 0.5\n# empty"),
        (FORMS, "layer.2.region.y_mm", "1", "-0.5#close", "-0.5#close\ny_mm = 1"),
        (FORMS, "layer.2.repeat", "{ rows = 2 }", "# empty", "repeat = { rows = 2 }\n# empty"),
        (ODD, "layer.0.region.height_mm", "4", "width_mm = 5 }", "width_mm = 5, height_mm = 4 }"),
        (ODD, "layer.0.angle_deg", "4", "width_mm = 5 }", "width_mm = 5 }\nangle_deg = 4"),
        (ODD, "layer.0.repeat.rows", "2", "dx_mm = 4", "dx_mm = 4\nrows = 2"),
        (ARRAY, "layer.1.region.y_mm", "2", "x_mm = 1 }", "x_mm = 1, region.y_mm = 2 }"),
    ] {
        let after = set(text, &[change(path, value, "")]).unwrap();
        assert_eq!(after, text.replacen(from, to, 1), "{path}");
        parsed(&after);
    }
    let behind = set(FORMS, &[change("layer.0.gain", "2", "kind")]).unwrap();
    assert_eq!(behind, FORMS.replace("'rings'", "'rings'\n  gain = 2"));
}

fn layers(value: &mut Value) -> &mut Vec<Value> {
    value.get_mut("layer").unwrap().as_array_mut().unwrap()
}

#[test]
fn a_layer_comes_goes_and_is_copied_and_every_other_value_stays() {
    for text in texts() {
        for at in 0..layers(&mut parsed(&text)).len() {
            let (mut less, mut more) = (parsed(&text), parsed(&text));
            layers(&mut less).remove(at);
            let without = edited("remove", &text, &[&at.to_string()]).unwrap();
            let left =
                without.parse::<Table>().unwrap().get("layer").map_or(0, |layers| layers.as_array().unwrap().len());
            assert_eq!(left, layers(&mut less).len());
            if left > 0 {
                assert_eq!(parsed(&without), less, "{without}");
            }
            assert!(!without.contains("\n\n\n") && !without.ends_with("\n\n"), "a gap is left:\n{without}");
            let copy = layers(&mut more)[at].clone();
            layers(&mut more).insert(at + 1, copy);
            assert_eq!(parsed(&edited("copy", &text, &[&at.to_string()]).unwrap()), more);
        }
        let mut more = parsed(&text);
        layers(&mut more).push(Value::Table("kind = \"edge\"\nregion = { x_mm = 1.0 }".parse().unwrap()));
        assert_eq!(parsed(&super::add(&text, "kind = \"edge\"\nregion = { x_mm = 1 }").unwrap()), more);
    }
    assert_eq!(super::add("# a\n", "b = 1").unwrap(), "# a\n\n[[layer]]\nb = 1\n");
    assert_eq!(super::add("layer = []", "b = 1").unwrap(), "layer = [{ b = 1 }]");
}

#[test]
fn a_layer_goes_with_its_own_comment_and_no_other() {
    let without = |text: &str, at: usize| edited("remove", text, &[&at.to_string()]).unwrap();
    let before = |part: &str| FORMS.find(part).unwrap();
    assert_eq!(without(FORMS, 2), format!("{}\n", &FORMS[..before("\n\n# the last one")]));
    assert_eq!(without(FORMS, 0), FORMS[..before("# above")].to_owned() + &FORMS[before("[[layer]]\nregion")..]);
    // The comment at the head of a file says what the scene is.
    assert_eq!(without("# a scene\n[[layer]]\nkind = 1\n", 0), "# a scene\n");
    assert_eq!(without("a = 1\n\n# part\n\n# b\n[[layer]]\n\n[[layer]]\n", 0), "a = 1\n\n# part\n\n[[layer]]\n");
    assert_eq!(without("[[layer]]\na = 1\n# b\n[[layer]]\nb = 2\n", 0), "# b\n[[layer]]\nb = 2\n");
    let (head, layer) = ("version = 1\n\n", "[[layer]]\nkind = \"constant\"\n\n");
    let design = "# the design\n[design]\nwidth_px = 10 # wide\n\n";
    let text = format!("{head}{layer}{design}# where\n[layer.region]\nx_px = 1\n\n{layer}");
    assert_eq!(without(&text, 0), format!("{head}{design}{layer}"));
    assert_eq!(without(&text, 1), text[..text.len() - layer.len() - 1]);
}

#[test]
fn the_last_element_of_an_array_goes_and_the_comment_of_the_one_before_stays() {
    for (text, expected) in [
        (ARRAY, "version = 1\nlayer = [\n  { kind = \"constant\", friction_n = 0.3 }, # one\n]\n"),
        ("layer = [{ a = 1 }, { b = 2 }]", "layer = [{ a = 1 }]"),
        ("layer = [{ a = 1 }, # one\n  { b = 2 }]", "layer = [{ a = 1 }, # one\n]"),
        ("layer = [{ a = 1 }, # one\n  { b = 2 } # 2, 3\n]", "layer = [{ a = 1 }, # one\n]"),
        ("layer = [\n  { a = 1 }, # one\n  { b = 2 } # two, too\n  , # end\n]", "layer = [\n  { a = 1 }, # one\n]"),
    ] {
        assert_eq!(edited("remove", text, &["1"]).unwrap(), expected);
    }
    assert_eq!(edited("remove", "layer = [ { a = 1 }, ]", &["0"]).unwrap(), "layer = [  ]");
}

#[test]
fn values_are_read_in_the_order_of_the_text_with_the_lines_of_the_layers() {
    let reading: serde_json::Value = serde_json::from_str(&read(FORMS).unwrap()).unwrap();
    let begins = FORMS.lines().enumerate().filter(|(_, line)| line.starts_with("[[layer]]"));
    assert_eq!(reading["lines"], json!(begins.map(|(at, _)| at + 1).collect::<Vec<_>>()));
    let array: serde_json::Value = serde_json::from_str(&read(ARRAY).unwrap()).unwrap();
    assert_eq!(array["lines"], json!([3, 4]));
    for text in texts() {
        let reading: serde_json::Value = serde_json::from_str(&read(&text).unwrap()).unwrap();
        assert_eq!(plain(Value::try_from(&reading["values"]).unwrap()), parsed(&text));
    }
    let text = read("b = 1\na = { d = inf, c = 2020-01-01 }\n").unwrap();
    assert_eq!(text, r#"{"values":{"b":1.0,"a":{"d":null,"c":"2020-01-01"}},"lines":[],"fields":[]}"#);
    let text = read("layer = [{ low_n = 1, gain = 2 }]\0{\"low_fraction\":3,\"gain\":4,\"x_mm\":5}").unwrap();
    assert!(text.ends_with(r#""fields":[{"low_n":1.0,"gain":2.0,"x_mm":5}]}"#), "{text}");
    assert!(matches!(read("\0no JSON"), Err(TextError::Request)));
}

#[test]
fn what_cannot_be_edited_is_an_error() {
    let error = |act: &str, text: &str, word: &str| edited(act, text, &[word]).unwrap_err();
    assert!(matches!(read("a = ["), Err(TextError::Toml(_))));
    assert!(matches!(error("copy", "a = [", "0"), TextError::Toml(_)));
    assert!(matches!(error("copy", FORMS, "3"), TextError::NoLayer(3)));
    assert!(matches!(error("remove", FORMS, "3"), TextError::NoLayer(3)));
    assert!(matches!(error("remove", "a = 1\n", "0"), TextError::NoLayer(0)));
    let no_table = set(FORMS, &[change("layer.0.repeat.rows", "2", "")]).unwrap_err();
    assert_eq!(no_table.to_string(), "the text has no table layer.0.repeat: write it first");
    assert!(matches!(error("turn", "", "1"), TextError::Request));
    assert!(matches!(error("copy", "", "one"), TextError::Request));
    assert!(matches!(edit("set\0a = 1\0a\0b"), Err(TextError::Request)));
}
