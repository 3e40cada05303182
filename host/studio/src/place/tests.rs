//! The place of every layer of the gallery, as read from the text, is the compiler's: before and after the layer is
//! moved or resized.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use super::*;
use crate::Request;
use crate::layer_text::{edit, read};

/// Scenes of what the gallery does not show.
const MORE: [&str; 4] = [
    "version = 1\n[design]\nwidth_px = 1200\nheight_px = 400\n[defaults]\n\
     region = { x_px = 100, y_mm = 10, width_px = 200, height_mm = 20 }\n\
     [[layer]]\nkind = \"constant\"\nfriction_fraction = 0.5\n\
     [[layer]]\nkind = \"edge\"\nx_px = 600\ny_px = 200\nwidth_mm = 3\nridge_fraction = 0.4\n\
     repeat = { columns = 2, rows = 3, dx_px = 300, dy_mm = 15 }\n",
    "version = 1\n[defaults]\nregion = { shape = \"polygon\", points_mm = [[10, 10], [40, 10], [25.5, 30]] }\n\
     [[layer]]\nkind = \"constant\"\nfriction_fraction = 0.5\nrepeat = { columns = 2, dx_mm = -5 }\n\
     [[layer]]\nkind = \"constant\"\nfriction_fraction = 0.5\nregion.shape = \"polygon\"\nregion.points_mm = [\n\
     [60, 10], # a corner\n[90, 20],\n[70, 60],\n]\n",
    "version = 1\n[[layer]]\nkind = \"bitmap\"\npicture = \"textures/brick.png\"\nx_mm = 20\ny_mm = 10\nwidth_mm = 20\n\
     [[layer]]\nkind = \"bitmap\"\npicture = \"textures/brick.png\"\nx_mm = 60\ny_mm = 20\nwidth_mm = 30\n\
     height_mm = 20\nangle_deg = 30\n\
     [[layer]]\nkind = \"bitmap\"\npicture = \"textures/brick.png\"\n\
     region = { x_mm = 10, y_mm = 50, width_mm = 20, height_mm = 20 }\n",
    "version = 1\ninclude = [\"parts/b.toml\"]\n[[layer]]\nkind = \"constant\"\nfriction_fraction = 0.5\n\
     [[layer]]\nkind = \"edge\"\nwidth_mm = 3\nridge_fraction = 0.4\n\
     region = { x_px = 500, y_px = 100, width_px = 400, height_px = 200 }\n\
     [[layer]]\nkind = \"edge\"\nx_mm = 60\nwidth_mm = 3\nridge_fraction = 0.4\n\
     region = { x_px = 500, y_px = 100, width_px = 400, height_px = 200 }\n",
];
/// Files that the last of them includes: the place of a layer, and the size of a pixel, stand in other files.
const INCLUDED: [(&str, &str); 2] = [
    (
        "parts/b.toml",
        "version = 1\ninclude = [\"../c.toml\"]\n[design]\nwidth_px = 1200\nheight_px = 400\n\
         [defaults]\nx_px = 600\ny_px = 200\n",
    ),
    (
        "c.toml",
        "version = 1\n[defaults]\nx_mm = 10\nregion = { x_px = 100, y_mm = 10, width_px = 200, height_mm = 20 }\n",
    ),
];
/// Parts of what the compiler says of friction, or of a place inside the layer, where a layer has gone elsewhere.
const OF_FELT: [&str; 4] =
    ["of the reach), and at", "outside its `region`", "clips its edges", "the picture is stretched by"];

fn in_folder(folder: &str, ending: &str) -> Vec<(String, Vec<u8>)> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes").join(folder);
    let entries = fs::read_dir(path).unwrap().map(|entry| entry.unwrap().path());
    let files = entries.filter(|path| path.is_file() && path.to_str().unwrap().ends_with(ending));
    files.map(|path| (path.file_name().unwrap().to_str().unwrap().to_owned(), fs::read(path).unwrap())).collect()
}

fn compiled(files: &BTreeMap<String, Vec<u8>>, text: &str) -> Value {
    let mut files = files.clone();
    files.insert("a.toml".to_owned(), text.as_bytes().to_owned());
    crate::compile(&Request { entry: "a.toml".to_owned(), files, ..Request::default() })
}

/// A value as `valueText` of `toml_text.js` writes it, apart from the order of fields.
fn written(value: &Value, decimals: usize) -> String {
    match value {
        Value::Number(number) => {
            // Halves go up.
            let scale = 10_f64.powi(decimals as i32);
            let text = format!("{:.decimals$}", (number.as_f64().unwrap() * scale).round() / scale);
            if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.').to_owned() } else { text }
        }
        Value::Array(values) => {
            format!("[{}]", values.iter().map(|value| written(value, decimals)).collect::<Vec<_>>().join(", "))
        }
        Value::Object(fields) => {
            let fields = fields.iter().map(|(key, value)| format!("{key} = {}", written(value, decimals)));
            format!("{{ {} }}", fields.collect::<Vec<_>>().join(", "))
        }
        other => other.to_string(),
    }
}

/// A text with these changes.
fn with(text: &str, changes: &Value) -> String {
    let parts = changes.as_array().unwrap().iter().flat_map(|change| {
        let path = change["path"].as_array().unwrap().iter();
        let path: Vec<String> = path.map(|key| key.as_str().map_or(key.to_string(), str::to_owned)).collect();
        let decimals = change["decimals"].as_u64().unwrap() as usize;
        [path.join("\n"), written(&change["value"], decimals), change["after"].as_str().unwrap_or_default().to_owned()]
    });
    let request: Vec<String> = ["set".to_owned(), text.to_owned()].into_iter().chain(parts).collect();
    edit(&request.join("\0")).unwrap()
}

/// Around all copies of a box.
fn around(found: &Value, first: [f64; 4]) -> [f64; 4] {
    let offsets = |axis: usize| {
        let offsets = found["copies"].as_array().unwrap().iter().map(move |copy| copy[axis].as_f64().unwrap());
        offsets.fold([f64::MAX, f64::MIN], |[least, most], offset| [least.min(offset), most.max(offset)])
    };
    let ([left, right], [top, bottom]) = (offsets(0), offsets(1));
    let [x, y, width, height] = first;
    [x + left, y + top, width + right - left, height + bottom - top]
}

fn sides(value: &Value) -> Option<[f64; 4]> {
    let sides: Vec<f64> = value.as_array()?.iter().map(|side| side.as_f64().unwrap()).collect();
    sides.try_into().ok()
}

/// A pixel of the designs is 0.1 mm wide and 0.2 mm high.
fn assert_near(found: Option<[f64; 4]>, expected: Option<[f64; 4]>, about: &str) {
    let is_near = |(one, other): ([f64; 4], [f64; 4])| one.into_iter().zip(other).all(|(a, b)| (a - b).abs() < 0.11);
    let is_same = found.zip(expected).map_or(found.is_none() && expected.is_none(), is_near);
    assert!(is_same, "{about}: {found:?}, expected {expected:?}");
}

/// The compiler's boxes of a layer and of the others after a change of the text.
fn assert_changed(
    files: &BTreeMap<String, Vec<u8>>,
    (before, text): (&Value, &str),
    layer: usize,
    expected: Option<[f64; 4]>,
    about: &str,
) {
    let after = compiled(files, text);
    let boxes = |check: &Value| -> Vec<Value> {
        check["layers"].as_array().unwrap_or(&Vec::new()).iter().map(|layer| layer["boxMm"].clone()).collect()
    };
    let (mut was, mut is) = (boxes(before), boxes(&after));
    assert_eq!(was.len(), is.len(), "{about}: {after}\n{text}");
    was.remove(layer);
    assert_near(sides(&is.remove(layer)), expected, about);
    assert_eq!(was, is, "{about}: other layers stay");
    let messages = |check: &Value| -> Vec<String> {
        check["problems"].as_array().unwrap().iter().map(|problem| problem["message"].to_string()).collect()
    };
    let known = messages(before);
    let is_of_place = |message: &String| !known.contains(message) && !OF_FELT.iter().any(|part| message.contains(part));
    assert_eq!(messages(&after).into_iter().find(is_of_place), None, "{about}");
}

#[test]
fn the_place_of_a_layer_in_its_text_is_the_compilers_also_after_it_was_moved_and_resized() {
    let textures = ["png", "jpg"].into_iter().flat_map(|ending| in_folder("textures", ending));
    let mut files: BTreeMap<String, Vec<u8>> =
        textures.map(|(name, bytes)| (format!("textures/{name}"), bytes)).collect();
    files.extend(INCLUDED.map(|(name, text)| (name.to_owned(), text.as_bytes().to_owned())));
    let gallery = in_folder("", ".toml").into_iter().map(|(_, bytes)| String::from_utf8(bytes).unwrap());
    let (mut moved, mut resized) = (0, 0);
    for text in gallery.chain(MORE.map(str::to_owned)) {
        let before = compiled(&files, &text);
        let defaults = before["defaults"]["a.toml"].as_str().unwrap_or("{}");
        let own: Value = serde_json::from_str(&read(&format!("{text}\0{defaults}")).unwrap()).unwrap();
        let lines = own["lines"].as_array().unwrap();
        for (number, layer) in before["layers"].as_array().unwrap().iter().enumerate() {
            let Some(at) = lines.iter().position(|line| *line == layer["from"][0] && layer.get("file").is_none())
            else {
                continue;
            };
            let has_own_region = own["values"]["layer"][at].get("region").is_some();
            let ask = |act: Value| {
                let (fields, screen) = (&own["fields"][at], &before["screen"]);
                place(
                    &json!({ "fields": fields, "hasOwnRegion": has_own_region, "at": at, "kind": layer["kind"],
                        "boxMm": layer["boxMm"], "screen": screen, "act": act })
                    .to_string(),
                )
                .unwrap()
            };
            let found = ask(Value::Null);
            let box_mm = sides(&layer["boxMm"]);
            let [x, y, width, height] = ["x", "y", "width", "height"].map(|side| found["box"][side].as_f64().unwrap());
            let all = around(&found, [x, y, width, height]);
            let about = format!("layer {} of\n{text}", layer["name"]);
            assert_near(box_mm.map(|_| all), box_mm, &about);
            if found["whyNotMoved"] == "" {
                let [left, top, wide, high] = all;
                let room = before["screen"]["widthMm"].as_f64().unwrap() - left - wide;
                let expected = box_mm.map(|_| [left + room.min(3.0), top + (-4.0_f64).max(-top), wide, high]);
                let changed = with(&text, &ask(json!({ "move": [3, -4] })));
                assert_changed(&files, (&before, &changed), number, expected, &format!("moved, {about}"));
                moved += 1;
            }
            if found["whyNotResized"] == "" {
                let part = if found["keepsRatio"] == true { 0.5 } else { 0.8 };
                let to = [x + 2.0, y + 1.0, width * 0.5, height * part];
                let [x, y, width, height] = to;
                let act = json!({ "resize": { "x": x, "y": y, "width": width, "height": height } });
                let expected = if box_mm.is_some() { around(&found, to) } else { to };
                let changed = with(&text, &ask(act));
                assert_changed(&files, (&before, &changed), number, Some(expected), &format!("resized, {about}"));
                resized += 1;
            }
        }
    }
    assert!(moved > 20 && resized > 30, "{moved} moved, {resized} resized");
}

#[test]
fn pixels_stay_whole_unless_one_has_a_part_or_a_step_is_finer() {
    for (x, by_mm, expected) in [(30.0, 1.0, "33"), (30.0, 0.1, "30.25"), (30.5, 1.0, "33"), (30.5, 0.4, "31.5")] {
        let request = json!({
            "fields": { "region": { "x_px": x, "y_px": 10, "width_px": 10, "height_px": 10 } },
            "hasOwnRegion": true, "at": 0, "kind": "constant", "boxMm": [10, 4, 4, 4],
            "screen": { "widthMm": 120, "heightMm": 80, "pixelMm": [0.4, 0.4] }, "act": { "move": [by_mm, 0] },
        });
        let changes = place(&request.to_string()).unwrap();
        let decimals = changes[0]["decimals"].as_u64().unwrap() as usize;
        assert_eq!(written(&changes[0]["value"], decimals), expected, "{x} px by {by_mm} mm");
    }
}
