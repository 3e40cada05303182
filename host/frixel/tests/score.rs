//! `frixel score`: the numbers see an output that is missing and a prediction that is switched off.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail")]

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use frixel::scene_file;
use frixel_hil_sim::{RigConfig, Stroke, WorldOptions};
use frixel_lab::score::{Score, Trial};
use frixel_play::{SimulationError, TO_THE_END, break_if};
use frixel_scene::{Program, Scene, compile};
use serde_json::Value;

use crate::processes::{repository, succeed};

fn scene() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/grating.toml")
}

fn program() -> Program {
    let rig = RigConfig::default();
    compile(&scene_file::load(&scene()).unwrap(), &rig.board.limits, rig.board.tick_hz).unwrap()
}

/// The mean of a number over two human strokes in an ideal world.
fn mean(program: &Program, key: &str) -> f64 {
    let trials: Vec<Trial> = (1..=2)
        .map(|seed| {
            let stroke = Stroke::human(0.12, 0.08, 1.5, Some(0.1), seed).unwrap();
            Trial { stroke_name: format!("human {seed}"), stroke: stroke.into(), seed, finger: None }
        })
        .collect();
    let score =
        Score::of(program, &WorldOptions { ideal: true, ..WorldOptions::default() }, &trials, TO_THE_END).unwrap();
    score.metrics.iter().find(|metric| metric.key == key).unwrap().mean
}

#[test]
fn an_output_forced_to_zero_keeps_nothing() {
    let mut zero = program();
    zero.header.voltage_max_v_rms = 1.0;
    assert!(mean(&program(), "contrast_kept") > 0.9);
    assert!(mean(&zero, "contrast_kept") < 0.01);
    assert!(mean(&zero, "error_below_40_hz") > 0.9);
}

#[test]
fn an_interrupted_score_is_none() {
    let stroke = Stroke::human(0.12, 0.08, 1.5, Some(0.1), 1).unwrap();
    let trial = Trial { stroke_name: "human 1".to_owned(), stroke: stroke.into(), seed: 1, finger: None };
    let goes_on = || break_if(true);
    for trials in [vec![], vec![trial]] {
        let found = Score::of(&program(), &WorldOptions::default(), &trials, &goes_on);
        assert!(matches!(found, Err(SimulationError::Interrupted)));
    }
}

/// The finger's own noise and load changes are no contrast of the scene.
#[test]
fn a_scene_of_nothing_has_no_contrast() {
    let text = "version = 1\n[[layer]]\nkind = \"constant\"\nlive = true\nfriction_fraction = 0.0\n";
    let scene = Scene::parse(text, "nothing.toml", &BTreeMap::<String, Vec<u8>>::new()).unwrap();
    let rig = RigConfig::default();
    let program = compile(&scene, &rig.board.limits, rig.board.tick_hz).unwrap();
    let stroke = Stroke::human(0.12, 0.08, 1.5, Some(0.1), 1).unwrap();
    let trial = Trial { stroke_name: "human 1".to_owned(), stroke: stroke.into(), seed: 1, finger: None };
    let score = Score::of(&program, &WorldOptions::default(), &[trial], TO_THE_END).unwrap();
    let contrast = score.metrics.iter().find(|metric| metric.key == "contrast_weber_steps").unwrap().mean;
    assert!(contrast.abs() < 0.01, "{contrast} Weber steps");
}

#[test]
fn without_prediction_friction_is_late() {
    let mut late = program();
    late.header.prediction = false;
    assert!(mean(&program(), "delay_ms").abs() < 3.0);
    assert!((10.0..25.0).contains(&mean(&late, "delay_ms")), "{}", mean(&late, "delay_ms"));
    assert!(mean(&late, "error_below_40_hz") > 2.0 * mean(&program(), "error_below_40_hz"));
}

/// What a score of a scene prints, with its files in a folder.
fn score(out: &Path, scene: &Path, options: &[&str]) -> String {
    succeed(out, &[&["score", scene.to_str().unwrap(), "--out", "."], options].concat())
}

#[test]
fn the_command_writes_a_row_for_each_play_and_a_picture() {
    let out = tempfile::tempdir().unwrap();
    let options = ["--strokes", "2", "--seeds", "2", "--seconds", "0.5", "--json"];
    let json: Value = serde_json::from_str(&score(out.path(), &scene(), &options)).unwrap();
    assert_eq!(json["plays"].as_array().unwrap().len(), 4);
    let csv = std::fs::read_to_string(out.path().join("score.csv")).unwrap();
    assert_eq!(csv.lines().count(), 5);
    assert!(csv.starts_with("simulated_person,stroke,seed,error,correlation,"));
    assert_eq!((json["simulated_fingers"].as_u64(), json["layers"].as_array().unwrap().len()), (Some(1), 1));
    let svg = std::fs::read_to_string(out.path().join("score.svg")).unwrap();
    let layers = std::fs::read_to_string(out.path().join("score-layers.csv")).unwrap();
    assert!(
        layers.starts_with("layer,simulated_fingers,felt,") && layers.contains("\n\"layer 1 \"\"stripes\"\"\",1,1,")
    );
    assert_eq!(json["touch_source"]["latency_ms"].as_f64(), Some(10.0));
    let said = "a verdict on 1 simulated finger in 4 plays";
    assert!(svg.contains(said) && json["simulated"].as_str().unwrap().starts_with(said), "{json}");
    assert_eq!(json["verdict"], "1 of 1 layer is noticed by the simulated finger");
}

/// The lines of a score of a scene, each with its name; the first one is the verdict.
fn lines(scene: &str, more: &[&str]) -> Vec<(String, String)> {
    let out = tempfile::tempdir().unwrap();
    let file = out.path().join("scene.toml");
    std::fs::write(&file, scene).unwrap();
    let text = score(out.path(), &file, &[&["--strokes", "1", "--seeds", "1"], more].concat());
    let (verdict, rest) = text.split_once('\n').unwrap();
    let line = |line: &str| (line[2..32].trim_end().to_owned(), line[32..].trim_start().to_owned());
    [(verdict.trim().to_owned(), String::new())].into_iter().chain(rest.lines().map(line)).collect()
}

/// A plate is one friction everywhere: there are no ratios to its changes, and nothing to notice.
#[test]
fn a_plate_has_no_ratios_and_is_not_noticed() {
    let lines = lines(
        "version = 1\n[[layer]]\nkind = \"constant\"\nfriction_fraction = 0.5\n",
        &["--people", "2", "--fidelity"],
    );
    let names: Vec<&str> = lines.iter().map(|(name, _)| name.as_str()).collect();
    for ratio in ["error, 0 to 400 Hz", "correlation, 0 to 400 Hz", "contrast kept", "delay", "peak dF/dt kept"] {
        assert!(!names.contains(&ratio), "{lines:?}");
    }
    let (_, row) = lines.iter().find(|(name, _)| name == "layer 1 (constant)").unwrap();
    assert_eq!(row, "felt by 0 of 2; contrast 0.0 Weber steps");
    let verdict = "not noticed by all 2 simulated fingers: layer 1 (constant) by 0";
    assert_eq!(lines[0].0, verdict);
}

/// Two plates beside one another are noticed, and their levels are told apart as far as these differ.
#[test]
fn levels_are_told_apart_as_far_as_they_differ() {
    let plates = |fraction: f64| {
        format!(
            "version = 1\n[[layer]]\nname = \"left\"\nkind = \"constant\"\n\
             region = {{ x_mm = 0, y_mm = 0, width_mm = 60, height_mm = 80 }}\nfriction_fraction = {fraction}\n\
             [[layer]]\nname = \"right\"\nkind = \"constant\"\n\
             region = {{ x_mm = 60, y_mm = 0, width_mm = 60, height_mm = 80 }}\nfriction_fraction = 1\n"
        )
    };
    let apart = |fraction: f64| {
        let lines = lines(&plates(fraction), &["--stroke", "sweep"]);
        lines.iter().find(|(name, _)| name == "levels").map(|(_, text)| text.clone()).unwrap()
    };
    // A plate has no contrast to speak of.
    let lines = lines(&plates(0.1), &["--stroke", "sweep"]);
    let (_, row) = lines.iter().find(|(name, _)| name.starts_with("layer 2")).unwrap();
    assert!(row.starts_with("felt by 1 of 1; step onto it from layer 1 \"left\" "), "{row}");
    assert!(row.ends_with(" Weber steps"), "{row}");
    let pair = "layer 1 \"left\" and layer 2 \"right\"";
    assert!(apart(0.1).starts_with(&format!("{pair}: told apart by 1 of 1; ")), "{}", apart(0.1));
    assert!(apart(0.9).starts_with(&format!("{pair}: told apart by 0 of 1; ")), "{}", apart(0.9));
}

/// Each person has a finger and strokes of their own, and the same people come again.
#[test]
fn people_differ_and_come_again() {
    let out = tempfile::tempdir().unwrap();
    let options = ["--people", "3", "--strokes", "1", "--seeds", "2", "--seconds", "2", "--json"];
    let plays = || serde_json::from_str::<Value>(&score(out.path(), &scene(), &options)).unwrap();
    let json = plays();
    let people: Vec<u64> =
        json["plays"].as_array().unwrap().iter().filter_map(|play| play["simulated_person"].as_u64()).collect();
    assert_eq!(people, [1, 1, 2, 2, 3, 3]);
    let contrast = |play: usize| json["plays"][play]["fidelity"]["contrast_weber_steps"].as_f64().unwrap();
    assert!((contrast(0) - contrast(2)).abs() > 0.05 && (contrast(2) - contrast(4)).abs() > 0.05, "{json}");
    assert_eq!(json, plays());
}

/// The command under the table of `docs/design/touch.md` prints the row that it is said to print, on fewer strokes.
#[test]
fn the_command_of_the_touch_table_prints_its_row() {
    let docs = repository().join("docs/design");
    let page = std::fs::read_to_string(docs.join("touch.md")).unwrap();
    let command = page.lines().find(|line| line.starts_with("frixel score touch/")).unwrap();
    let row = page.lines().find_map(|line| line.strip_prefix("| 100 Hz, 10 mm | 100 mm/s | ")).unwrap();
    let row: Vec<f64> = row.split('|').take(3).map(|cell| cell.replace("mN", "").trim().parse().unwrap()).collect();
    let out = tempfile::tempdir().unwrap();
    let mut arguments: Vec<&str> = command.split(' ').skip(1).collect();
    arguments.extend(["--json", "--out", out.path().to_str().unwrap()]);
    let score: Value = serde_json::from_str(&succeed(&docs, &arguments)).unwrap();
    let mean = |key: &str| {
        let metrics = score["metrics"].as_array().unwrap().iter();
        metrics.filter(|metric| metric["key"] == key).find_map(|metric| metric["mean"].as_f64()).unwrap()
    };
    for (key, cell, rounding) in
        [("error", row[0], 0.02), ("correlation", row[1], 0.01), ("spurious_40_to_400_hz_mn", row[2], 1.0)]
    {
        assert!((mean(key) - cell).abs() <= rounding, "{key}: {}, and {cell} in the page", mean(key));
    }
}

/// The number of threads changes nothing of what is said or written.
#[test]
fn every_number_of_jobs_has_the_same_bytes() {
    let scored = |jobs: &str| {
        let out = tempfile::tempdir().unwrap();
        let options = ["--people", "5", "--strokes", "2", "--seeds", "1", "--seconds", "0.4", "--json", "--jobs", jobs];
        let said = score(out.path(), &scene(), &options);
        let file = |name: &str| std::fs::read(out.path().join(name)).unwrap();
        (said, ["score.csv", "score-layers.csv", "score.svg"].map(file))
    };
    let (said, files) = scored("1");
    for jobs in ["2", "7"] {
        assert!(scored(jobs) == (said.clone(), files.clone()), "--jobs {jobs}");
    }
}
