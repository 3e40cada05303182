//! `frixel check` and `frixel score` use the same judge: they agree for the same finger, source and seed.
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

/// The verdicts of a check on each layer.
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
