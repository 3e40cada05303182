//! `frixel check`, `frixel score` and `frixel play` judge with one judge: the first two agree for the same finger,
//! source and seed, and the third judges what its own finger felt.
#![allow(clippy::unwrap_used, reason = "a test may fail")]

use std::fs;
use std::path::Path;

use frixel::scene_file;
use frixel_felt::judge::{Advice, LayerVerdict};
use frixel_hil_sim::{RigConfig, WorldOptions};
use frixel_play::{TO_THE_END, judge};
use frixel_scene::compile;
use serde_json::Value;

use crate::processes::run;

/// What a check says of each layer.
fn checked(path: &Path) -> Vec<LayerVerdict> {
    let rig = RigConfig::default();
    let program = compile(&scene_file::load(path).unwrap(), &rig.board.limits, rig.board.tick_hz).unwrap();
    judge(&program, &rig, &WorldOptions::default(), Advice::Omitted, TO_THE_END).unwrap().layers
}

/// Stripes under layers that start off: one replaces the stripes everywhere, and one comes in bursts.
const OFF: &str = "\
version = 1
[[layer]]
kind = \"grating\"
wavelength_mm = 10
low_fraction = 0
high_fraction = 0.9
[[layer]]
name = \"cover\"
kind = \"constant\"
live = true
start = \"off\"
friction_fraction = 0.5
[[layer]]
name = \"alarm\"
kind = \"vibration\"
live = true
start = \"off\"
frequency_hz = 90
low_fraction = 0
high_fraction = 0.5
burst = { on_ms = 100, period_ms = 2000 }
";

/// The score of the scene's own finger has the verdicts of the check.
#[test]
fn a_check_and_a_score_agree() {
    let scenes = tempfile::tempdir().unwrap();
    let off = scenes.path().join("off.toml");
    fs::write(&off, OFF).unwrap();
    let listed = |name| Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../play/tests/verdicts/{name}.toml"));
    for path in ["bars", "slider", "rare"].map(listed).into_iter().chain([off]) {
        let name = path.display();
        let out = tempfile::tempdir().unwrap();
        let options = ["score", path.to_str().unwrap(), "--strokes", "1", "--seeds", "1", "--seconds", "0.5", "--json"];
        let output = run(out.path(), &options);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let score: Value = serde_json::from_slice(&output.stdout).unwrap();
        let checked = checked(&path);
        let layers = score["layers"].as_array().unwrap();
        assert_eq!(layers.len(), checked.len(), "{name}");
        for (layer, LayerVerdict { layer: title, verdict, contrast, .. }) in layers.iter().zip(&checked) {
            assert_eq!(layer["layer"], title.as_str());
            let difference = layer["contrast_weber_steps"].as_f64().unwrap() - contrast.weber_steps;
            assert!(difference.abs() < 1e-12, "{name}: {layer} has another contrast, by {difference}");
            assert_eq!(layer["simulated_fingers"][verdict.key()], 1, "{name}: {layer}");
        }
    }
}

/// A strong and a faint plate under one stroke.
const PLATES: &str = "\
version = 1
[[layer]]
name = \"strong\"
kind = \"constant\"
friction_fraction = 0.9
region = { x_mm = 20, y_mm = 20, width_mm = 30, height_mm = 40 }
[[layer]]
name = \"faint\"
kind = \"constant\"
friction_fraction = 0.01
region = { x_mm = 70, y_mm = 20, width_mm = 30, height_mm = 40 }
";

#[test]
fn a_play_judges_what_its_finger_felt() {
    let out = tempfile::tempdir().unwrap();
    fs::write(out.path().join("plates.toml"), PLATES).unwrap();
    fs::write(out.path().join("way.csv"), "t_s,x_mm,y_mm\n0,10,40\n2,110,40\n").unwrap();
    let play = |options: &[&str]| {
        let line = [&["play", "plates.toml", "--stroke", "way.csv"], options].concat();
        let output = run(out.path(), &line);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8_lossy(&output.stdout).into_owned()
    };
    let json: Value = serde_json::from_str(&play(&["--json"])).unwrap();
    let verdicts: Vec<[&str; 2]> = json["in_this_play"]
        .as_array()
        .unwrap()
        .iter()
        .map(|layer| ["layer", "verdict"].map(|key| layer[key].as_str().unwrap()))
        .collect();
    assert_eq!(verdicts, [["layer 1 \"strong\"", "felt"], ["layer 2 \"faint\"", "not_felt"]]);
    let said = play(&[]);
    assert!(said.contains("  in this play     not felt: layer 2 \"faint\": "), "{said}");
    assert!(said.contains("  in this play     felt: layer 1 \"strong\": "), "{said}");
}
