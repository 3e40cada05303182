//! The page says of a scene what `frixel check` says.
#![allow(clippy::unwrap_used, reason = "a test fails by a panic")]

use std::path::Path;

use frixel::scene_file;
use frixel_felt::check::SceneCheck;
use frixel_felt::judge::Advice;
use frixel_hil_sim::{RigConfig, WorldOptions};
use frixel_play::{TO_THE_END, board_costs, judge};
use frixel_scene::compile;
use frixel_studio::{Request, check, used_files};
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
        let judgement = judge(&program, &rig, &WorldOptions::default(), Advice::Sought, TO_THE_END).unwrap();
        let expected = SceneCheck::of(&program, &rig.board.limits, &costs, judgement).lines(true);
        let answer = check(&request);
        assert_eq!(answer["report"], json!(expected), "{}: {answer}", request.entry);
        assert_eq!(answer["ok"], true);
        // At once, and without verdicts.
        let compiled = frixel_studio::compile(&request);
        for key in ["ok", "isDraft", "problems", "screen", "lowN", "highN", "reachN", "naturalN"] {
            assert_eq!(compiled[key], answer[key], "{key}");
        }
        assert!(compiled["layers"].as_array().unwrap().iter().all(|layer| layer["perceived"].is_null()));
        let layers = answer["layers"].as_array().unwrap();
        assert!(!layers.is_empty() && layers.iter().all(|layer| layer["from"][0].as_u64() > Some(0)), "{answer}");
    }
}

#[test]
fn a_mistake_has_its_sentence_and_its_place() {
    let text = "version = 1\n\n[[layer]]\nkind = \"gratin\"\nperiod_mm = 2\n";
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

/// A request for a scene `play.toml` with further files.
fn request(text: &str, files: &[(&str, &str)]) -> Request {
    let all = std::iter::once(("play.toml", text)).chain(files.iter().copied());
    let files = all.map(|(name, text)| (name.to_owned(), text.as_bytes().to_vec())).collect();
    Request { entry: "play.toml".to_owned(), files, ..Request::default() }
}

const PAD: &str = "kind = \"constant\"\nfriction_fraction = 0.3\n";

#[test]
fn layers_have_their_files_lines_and_numbers() {
    let keys = format!(
        "version = 1\n\n[[ layer ]] # spaces\nname = \"key\"\nlive = true\ngain = 0.5\n{PAD}\
         repeat = {{ columns = 3, dx_mm = 10 }}\n\n  [layer.region]\n  x_mm = 5\n  y_mm = 6\n  width_mm = 7\n  height_mm = 8\n\n"
    );
    let scene = format!("include = [\"parts/keys.toml\"]\nversion = 1\n\n[[layer]]\n{PAD}[drive]\nsaturate = true\n");
    let answer = check(&request(&scene, &[("parts/keys.toml", &keys)]));
    assert_eq!(answer["ok"], true, "{answer}");
    let layers = answer["layers"].as_array().unwrap();
    let part = |layer: usize, names: [&str; 7]| names.map(|name| layers[layer][name].clone());
    let names = ["index", "name", "file", "from", "controls", "gain", "boxMm"];
    let key = [
        json!(1),
        json!("key"),
        json!("parts/keys.toml"),
        json!([3, 15]),
        json!(["1.1", "1.2", "1.3"]),
        json!(0.5),
        json!([5.0, 6.0, 27.0, 8.0]),
    ];
    assert_eq!(part(0, names), key);
    assert_eq!(
        part(1, names),
        [json!(2), json!("constant"), json!(null), json!([4, 6]), json!(["2"]), json!(1.0), json!(null)]
    );
    assert_eq!((&layers[0]["isLive"], &layers[1]["isLive"]), (&json!(true), &json!(false)));
    assert_eq!((&layers[0]["gainMin"], &layers[0]["gainMax"]), (&json!(-100.0), &json!(100.0)));
    // The layer above covers the keys.
    assert_eq!(layers.iter().map(|layer| layer["felt"] != "").collect::<Vec<_>>(), [false, true], "{answer}");
}

#[test]
fn a_mistake_in_an_included_file_names_it() {
    let answer = check(&request("version = 1\ninclude = [\"a.toml\"]\n", &[("a.toml", "version = 1\n\ngratin = 2\n")]));
    let problem = &answer["problems"][0];
    assert_eq!((&problem["file"], &problem["line"]), (&json!("a.toml"), &json!(3)), "{answer}");
}

#[test]
fn the_used_files_are_those_that_the_compiler_reads() {
    let keys = "version = 1\n[[layer]]\nkind = \"bitmap\"\npicture = '../wood.jpg'\nx_mm = 1\ny_mm = 1\nwidth_mm = 9\n";
    let scene = "version = 1\ninclude = [\"parts/keys.toml\"]\nfinger = \"mine.toml\"\nscreen = \"example\"\n";
    let whole = request(scene, &[("parts/keys.toml", keys), ("unused.toml", "")]);
    let names = |request: &Request| used_files(request).unwrap();
    assert_eq!(names(&whole)["names"], json!(["mine.toml", "parts/keys.toml", "wood.jpg"]));
    assert_eq!(names(&whole)["isWhole"], false, "what mine.toml would name is not known");
    let finger = include_str!("../../../scenes/fingers/dry.toml");
    let whole = request(scene, &[("parts/keys.toml", keys), ("mine.toml", finger)]);
    let all = json!(["mine.toml", "parts/keys.toml", "wood.jpg"]);
    assert_eq!(names(&whole), json!({ "isWhole": true, "names": all, "kind": "scene" }));
}

#[test]
fn a_text_is_what_its_fields_say() {
    let kind = |text: &str| used_files(&request(text, &[])).unwrap()["kind"].clone();
    for request in gallery::requests(Path::new(env!("CARGO_MANIFEST_DIR"))).unwrap() {
        assert_eq!(used_files(&request).unwrap()["kind"], "scene", "{}", request.entry);
    }
    assert_eq!(kind(include_str!("../../../scenes/fingers/dry.toml")), "finger");
    let mistaken =
        "width_mm = 120\nheight_mm = 0\nvoltage_max_v_rms = 150\n[[coating]]\nthickness_um = 1\npermittivity = 3\n";
    for (text, expected) in [
        ("reports_per_s = 0\nlatency_ms = 8\n", "touch"),
        (mistaken, "screen"),
        ("version = 1\n[screen]\nwidth_mm = 150\nheight_mm = 60\n[drive]\na = 1\nb = 2\nc = 3\n", "scene"),
        ("version = 1\ninclude = [\"a.toml\", \"b.toml\", \"c.toml\", \"d.toml\"]\n", "scene"),
        ("# nothing yet\n", "scene"),
        ("width_mm = \n", "screen"),
        ("friction_coefficient = 0.4\nnormal_load_n = 0,5\n", "finger"),
        ("[defaults.region]\nwidth_mm = 4\n", "scene"),
    ] {
        assert_eq!(kind(text), expected, "{text}");
    }
}

#[test]
fn a_scene_that_a_board_refuses_is_a_draft() {
    let layer = "version = 1\n[[layer]]\nkind = \"constant\"\nfriction_n = 9\n";
    let answer = check(&request(layer, &[]));
    assert_eq!((&answer["ok"], &answer["isDraft"]), (&json!(false), &json!(true)), "{answer}");
    assert_eq!(answer["problems"][0]["severity"], "error");
    assert_eq!(answer["report"][0][0], "draft", "{answer}");
    assert_eq!(answer["layers"].as_array().unwrap().len(), 1);
    let unreadable = check(&request("version = 1\n[[layer]]\nkind = \"consant\"\n", &[]));
    assert_ne!(unreadable["isDraft"], true, "{unreadable}");
}
