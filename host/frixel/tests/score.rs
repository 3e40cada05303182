//! `frixel score`: the numbers see an output that is missing and a prediction that is switched off.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail")]

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::Command;

use frixel::scene_file;
use frixel::score::samples;
use frixel_hil_sim::{RigConfig, Stroke};
use frixel_lab::score::{Score, Trial};
use frixel_scene::{Program, Scene, compile};
use serde_json::Value;

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
            Trial { stroke_name: format!("human {seed}"), stroke, seed, finger: None }
        })
        .collect();
    let score = Score::of(&trials, |trial| samples(program, &RigConfig::default(), trial)).unwrap();
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

/// The finger's own noise and load changes are no contrast of the scene.
#[test]
fn a_scene_of_nothing_has_no_contrast() {
    let text = "version = 2\n[[layer]]\nkind = \"constant\"\nlive = true\nfriction_fraction = 0.0\n";
    let scene = Scene::parse(text, "nothing.toml", &BTreeMap::<String, Vec<u8>>::new()).unwrap();
    let rig = RigConfig::default();
    let program = compile(&scene, &rig.board.limits, rig.board.tick_hz).unwrap();
    let stroke = Stroke::human(0.12, 0.08, 1.5, Some(0.1), 1).unwrap();
    let trial = Trial { stroke_name: "human 1".to_owned(), stroke, seed: 1, finger: None };
    let rig = RigConfig { world: rig.world.realistic(), ..rig };
    let score = Score::of(&[trial], |trial| samples(&program, &rig, trial)).unwrap();
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

#[test]
fn the_command_writes_a_row_for_each_play_and_a_picture() {
    let out = tempfile::tempdir().unwrap();
    let output = Command::new(env!("CARGO_BIN_EXE_frixel"))
        .arg("score")
        .arg(scene())
        .args(["--strokes", "2", "--seeds", "2", "--seconds", "0.5", "--json", "--out"])
        .arg(out.path())
        .output()
        .unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let json: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(json["plays"].as_array().unwrap().len(), 4);
    let csv = std::fs::read_to_string(out.path().join("score.csv")).unwrap();
    assert_eq!(csv.lines().count(), 5);
    assert!(csv.starts_with("simulated_person,stroke,seed,error,correlation,"));
    assert!(std::fs::read_to_string(out.path().join("score.svg")).unwrap().contains("simulated"));
}

/// Each person has a finger and strokes of their own, and the same people come again.
#[test]
fn people_differ_and_come_again() {
    let out = tempfile::tempdir().unwrap();
    let plays = || {
        let output = Command::new(env!("CARGO_BIN_EXE_frixel"))
            .arg("score")
            .arg(scene())
            .args(["--people", "3", "--strokes", "1", "--seeds", "2", "--seconds", "2", "--json", "--out"])
            .arg(out.path())
            .output()
            .unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        serde_json::from_slice::<Value>(&output.stdout).unwrap()
    };
    let json = plays();
    let people: Vec<u64> =
        json["plays"].as_array().unwrap().iter().filter_map(|play| play["simulated_person"].as_u64()).collect();
    assert_eq!(people, [1, 1, 2, 2, 3, 3]);
    let contrast = |play: usize| json["plays"][play]["fidelity"]["contrast_weber_steps"].as_f64().unwrap();
    assert!((contrast(0) - contrast(2)).abs() > 0.05 && (contrast(2) - contrast(4)).abs() > 0.05, "{json}");
    assert_eq!(json, plays());
}
