//! `frixel scene check` and `frixel score` judge with one judge: for the same finger, source and seed they agree.
#![allow(clippy::unwrap_used, reason = "a test may fail")]

use std::path::Path;

use frixel::scene_file;
use frixel_felt::judge::{Advice, LayerVerdict, Verdict};
use frixel_hil_sim::{Board, RigConfig, TouchConfig};
use frixel_play::{TO_THE_END, judge, judged_rig};
use frixel_scene::compile;
use serde_json::Value;

use crate::processes::run;

/// What a check says of each layer.
fn checked(path: &Path) -> Vec<LayerVerdict> {
    let rig = RigConfig::default();
    let program = compile(&scene_file::load(path).unwrap(), &rig.board.limits, rig.board.tick_hz).unwrap();
    let rig = judged_rig(Board::SIMULATOR, TouchConfig::REALISTIC);
    judge(&program, &rig, None, Advice::Omitted, TO_THE_END).unwrap().layers
}

/// The score of the scene's own finger has the verdicts of the check.
#[test]
fn a_check_and_a_score_agree() {
    for name in ["bars", "slider", "rare"] {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("../play/tests/verdicts/{name}.toml"));
        let out = tempfile::tempdir().unwrap();
        let options = ["score", path.to_str().unwrap(), "--strokes", "1", "--seeds", "1", "--seconds", "0.5", "--json"];
        let output = run(out.path(), &options);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let score: Value = serde_json::from_slice(&output.stdout).unwrap();
        let checked = checked(&path);
        let layers = score["layers"].as_array().unwrap();
        assert_eq!(layers.len(), checked.len(), "{name}");
        for (layer, LayerVerdict { layer: title, verdict, .. }) in layers.iter().zip(&checked) {
            assert_eq!(layer["layer"], title.as_str());
            let key = match verdict {
                Verdict::Felt => "felt",
                Verdict::NearThreshold => "felt_by_some",
                Verdict::NotFelt => "not_felt",
                Verdict::Unknown => "unknown",
            };
            assert_eq!(layer["simulated_fingers"][key], 1, "{name}: {layer}");
        }
    }
}
