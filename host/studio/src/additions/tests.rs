//! Tests of the layers that a person adds.

use std::collections::BTreeMap;

use frixel_felt::check::feel;
use frixel_felt::judge::{Advice, Verdict};
use frixel_hil_sim::{Board, RigConfig, WorldOptions};
use frixel_play::{TO_THE_END, judge};
use frixel_scene::{DiagnosticKind, Program, Scene, compile};

use super::*;

const SCREENS_MM: [[f64; 2]; 3] = [[30.0, 20.0], [300.0, 60.0], SCREEN_MM];

fn program(text: &str) -> Program {
    let wood = include_bytes!("../../../../scenes/textures/wood.jpg");
    let brick = include_bytes!("../../../../scenes/textures/brick.png");
    let files = [(PICTURE.0, wood.to_vec()), ("textures/brick.png", brick.to_vec())];
    let files: BTreeMap<_, _> = files.map(|(name, bytes)| (name.to_owned(), bytes)).into();
    let scene = Scene::parse(text, "scene.toml", &files).unwrap();
    let board = Board::SIMULATOR;
    compile(&scene, &board.limits, board.tick_hz).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// Adds a layer to a text, and returns the new text and the layer's box.
fn added(text: &str, name: &str, screen_mm: [f64; 2], taken_mm: &[BoxMm]) -> (String, Option<BoxMm>) {
    let request = json!({ "text": text, "name": name, "layer": name, "screenMm": screen_mm, "takenMm": taken_mm });
    let answer = add(&request.to_string()).unwrap();
    (answer["text"].as_str().unwrap().to_owned(), serde_json::from_value(answer["boxMm"].clone()).unwrap())
}

/// As New has it, and as Add puts it beside others: by the example finger, and also at 0.8 of its strength.
#[test]
fn whatever_can_be_added_is_felt_and_weaker_too() {
    let mut weak = Vec::new();
    for listed in list().unwrap().as_array().unwrap() {
        let name = listed["name"].as_str().unwrap();
        let (beside, _) = added("version = 1\n", name, SCREEN_MM, &[[0.0, 0.0, 10.0, 10.0]]);
        for text in [listed["scene"].as_str().unwrap(), &beside] {
            for gain in ["", "gain = 0.8\n"] {
                let program = program(&format!("{text}{gain}"));
                let problem = program.diagnostics.iter().find(|found| found.kind != DiagnosticKind::Note);
                assert!(problem.is_none(), "{text}{problem:?}");
                let judged =
                    judge(&program, &RigConfig::default(), &WorldOptions::default(), Advice::Omitted, TO_THE_END)
                        .unwrap()
                        .layers;
                assert!(!judged.is_empty(), "{text}");
                for found in judged {
                    let is_clicked = found.click.is_none_or(|click| click.verdict == Verdict::Felt);
                    if found.verdict != Verdict::Felt || !is_clicked {
                        weak.push(format!("{text}{gain}{}", feel::sentence(&found)));
                    }
                }
            }
        }
    }
    assert!(weak.is_empty(), "{}", weak.join("\n\n"));
}

/// The scene that the page opens with is a picture over most of the screen, with no room beside it.
#[test]
fn a_board_takes_what_is_added_to_the_first_scene() {
    let brick = include_str!("../../../../scenes/brick.toml");
    for listed in list().unwrap().as_array().unwrap() {
        let name = listed["name"].as_str().unwrap();
        // Another picture does not fit into the board's memory.
        if listed["isPicture"] != true {
            program(&added(brick, name, SCREEN_MM, &[[10.0, 0.0, 100.0, 80.0]]).0);
        }
    }
}

/// No two overlap, as long as there is room.
#[test]
fn a_layer_is_added_where_there_is_room() {
    let mut taken_mm: Vec<BoxMm> = Vec::new();
    for name in ["stripes", "button", "noise", "slider"] {
        let (_, box_mm) = added("", name, SCREEN_MM, &taken_mm);
        let [x, y, width, height] = box_mm.unwrap();
        for [left, top, wide, high] in &taken_mm {
            let is_beside = x >= left + wide || left >= &(x + width) || y >= top + high || top >= &(y + height);
            assert!(is_beside, "{name} at {box_mm:?}, {taken_mm:?}");
        }
        taken_mm.extend(box_mm);
    }
}

#[test]
fn layers_fit_screens_of_any_size_and_their_lengths_the_layers() {
    for screen_mm in SCREENS_MM {
        for Addition { name, .. } in &ADDITIONS {
            let (text, box_mm) = added("", name, screen_mm, &[]);
            let Some([x, y, width, height]) = box_mm else { continue };
            let is_in = x >= 0.0 && y >= 0.0 && x + width <= screen_mm[0] && y + height <= screen_mm[1];
            assert!(is_in && width >= 0.2 * screen_mm[0], "{text}");
            let lengths = text.lines().filter_map(|line| line.split_once(" = "));
            let of = |key| lengths.clone().find(|(field, _)| *field == key);
            let length = |key| of(key).map(|(_, mm)| mm.parse::<f64>().unwrap());
            assert!(length("width_mm").is_none_or(|mm| mm > 0.0 && mm <= width), "{text}");
            let range = length("wavelength_min_mm").zip(length("wavelength_max_mm"));
            assert!(range.is_none_or(|(min, max)| min < max), "{text}");
            let lengths = lengths.filter(|(field, _)| field.starts_with("wavelength") || *field == "rim_width_mm");
            let most_mm = 0.25 * width.min(height);
            for (field, mm) in lengths.map(|(field, mm)| (field, mm.parse::<f64>().unwrap())) {
                assert!(mm > 0.0 && mm <= most_mm, "{field} of {text}");
            }
        }
    }
}

/// In the middle where it is alone, as large as fits.
#[test]
fn a_picture_keeps_its_ratio() {
    for (screen_mm, aspect) in [(SCREEN_MM, 1.5), ([300.0, 60.0], 1.5), (SCREEN_MM, 0.5)] {
        let request = json!({
            "text": "", "name": "a \u{7f}", "layer": ["a \u{7f}.png", aspect], "screenMm": screen_mm, "takenMm": [],
        });
        let answer = add(&request.to_string()).unwrap();
        let [x, y, width, height]: BoxMm = serde_json::from_value(answer["boxMm"].clone()).unwrap();
        assert!((width / height / aspect - 1.0).abs() < 1e-9, "{answer}");
        assert!((x + 0.5 * width - 0.5 * screen_mm[0]).abs() <= 0.5 && y >= 0.0, "{answer}");
        assert!(height > 0.7 * screen_mm[1] && y + height <= screen_mm[1], "{answer}");
        assert!(answer["text"].as_str().unwrap().contains("picture = \"a \\u007f.png\"\n"), "{answer}");
    }
}
