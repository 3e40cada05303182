//! The page says of a scene what `frixel scene check` says.
#![allow(clippy::unwrap_used, reason = "a test fails by a panic")]

use std::path::Path;

use frixel::rehearsal::board_costs;
use frixel::scene_file;
use frixel_hil_sim::RigConfig;
use frixel_scene::check::SceneCheck;
use frixel_scene::compile;
use frixel_studio::{Request, check};
use serde_json::json;

mod gallery;

#[test]
fn the_report_is_that_of_the_command() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let rig = RigConfig::default();
    let requests = gallery::requests(folder).unwrap();
    assert!(requests.len() >= 12, "{} scenes", requests.len());
    for request in requests {
        let scene = scene_file::load(&folder.join("../../scenes").join(&request.entry)).unwrap();
        let program = compile(&scene, &rig.board.limits, rig.board.tick_hz).unwrap();
        let costs = board_costs(&program, &rig).unwrap();
        let expected = SceneCheck::of(&program, &rig.board.limits, &costs).summary();
        let answer = check(&request);
        assert_eq!(answer["report"], expected, "{}: {answer}", request.entry);
        assert_eq!(answer["ok"], true);
        let layers = answer["layers"].as_array().unwrap();
        assert!(!layers.is_empty() && layers.iter().all(|layer| layer["from"][0].as_u64() > Some(0)), "{answer}");
    }
}

#[test]
fn a_mistake_has_its_sentence_and_its_place() {
    let text = "version = 2\n\n[[layer]]\nkind = \"gratin\"\nperiod_mm = 2\n";
    let files = [("a.toml".to_owned(), text.as_bytes().to_vec())].into();
    let answer = check(&Request { entry: "a.toml".to_owned(), files, ..Request::default() });
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.toml");
    std::fs::write(&path, text).unwrap();
    let board = RigConfig::default().board;
    let expected = compile(&scene_file::load(&path).unwrap(), &board.limits, board.tick_hz).unwrap_err().to_string();
    let problem = &answer["problems"][0];
    let (line, column) = (&problem["line"], &problem["column"]);
    let sentence = format!("{}:{line}:{column}: {}", path.display(), problem["message"].as_str().unwrap());
    assert_eq!(sentence, expected.lines().next().unwrap());
    assert_eq!((line, &problem["endColumn"], &problem["help"]), (&json!(4), &json!(16), &json!("grating")));
    assert_eq!(answer["ok"], false);
}

#[test]
fn a_missing_picture_and_an_empty_request_are_sentences() {
    let brick = gallery::requests(Path::new(env!("CARGO_MANIFEST_DIR"))).unwrap().remove(0);
    let mut files = brick.files.clone();
    files.remove("textures/brick.png");
    let answer = check(&Request { files, ..brick });
    let sentence = answer["problems"][0]["message"].as_str().unwrap();
    assert!(sentence.contains("brick.png"), "{answer}");
    let answer = check(&Request { entry: "none.toml".to_owned(), ..Request::default() });
    assert!(answer["problems"][0]["message"].as_str().unwrap().contains("none.toml"), "{answer}");
}
