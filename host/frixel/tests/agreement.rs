//! `frixel scene check` and `frixel score` mean the same by *felt* and *not felt*: over every scene of `scenes/`, what a
//! check calls felt is noticed by at least half of the simulated fingers, and what it calls not felt by at most half.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail")]

use std::fs;
use std::path::Path;

use frixel::scene_file;
use frixel_felt::perception::{Perception, Verdict};
use frixel_hil_sim::RigConfig;
use frixel_scene::{LayerTitle, compile};
use serde_json::Value;

use crate::processes::{repository, run};

/// Simulated people.
const PEOPLE: &str = "10";
/// Fewer fingers that touched a layer say nothing about half of them.
const TOUCHED_MIN: u64 = 5;

/// Layers about which the two differ, with the reason: scene, what the title contains, reason.
const EXCEPTIONS: [(&str, &str, &str); 3] = [
    (
        "heartbeat",
        "heart",
        "a check gives a border to the uppermost layer, here the beat, which ends where the heart does",
    ),
    (
        "ruler",
        "ten",
        "a check without a touch source takes a ridge of 3 mm as played in place; 100 reports a second blur it",
    ),
    ("slider", "detent", "the same of ridges of 4 mm"),
];

/// What a check says of each layer, by itself and by its borders.
fn checked(path: &Path) -> Vec<(LayerTitle, Verdict)> {
    let rig = RigConfig::default();
    let program = compile(&scene_file::load(path).unwrap(), &rig.board.limits, rig.board.tick_hz).unwrap();
    let Perception { layers, steps, .. } = Perception::of(&program);
    let verdict = |layer: &LayerTitle| {
        let own = layers.iter().filter(|judged| judged.layer == *layer);
        let own = own.flat_map(|judged| {
            let textures = judged.textures.iter().map(|texture| texture.verdict);
            textures.chain(judged.click.map(|click| click.verdict)).chain([judged.contrast.verdict])
        });
        let borders = steps.iter().filter(|step| [&step.from, &step.to].contains(&&Some(layer.clone())));
        Verdict::of_any(own.chain(borders.map(|border| border.step.verdict)))
    };
    layers.iter().map(|judged| (judged.layer.clone(), verdict(&judged.layer))).collect()
}

/// How many simulated people touched each layer, and how many of them notice it.
fn scored(path: &Path) -> Vec<(String, [u64; 2])> {
    let out = tempfile::tempdir().unwrap();
    let scene = path.to_str().unwrap();
    let options = ["--people", PEOPLE, "--strokes", "2", "--seeds", "1", "--seconds", "2", "--json"];
    let output = run(out.path(), &[["score", scene].as_slice(), &options].concat());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let score: Value = serde_json::from_slice(&output.stdout).unwrap();
    let layer = |layer: &Value| {
        let fingers = &layer["simulated_fingers"];
        let title = layer["layer"].as_str().unwrap().to_owned();
        (title, ["touched", "felt"].map(|key| fingers[key].as_u64().unwrap()))
    };
    score["layers"].as_array().unwrap().iter().map(layer).collect()
}

#[test]
fn a_check_and_a_score_of_every_scene_agree() {
    let entries = fs::read_dir(repository().join("scenes")).unwrap().map(|entry| entry.unwrap().path());
    let mut compared = [0, 0];
    let mut apart = Vec::new();
    for path in entries.filter(|path| path.extension().is_some_and(|end| end == "toml")) {
        let (checked, scene) = (checked(&path), path.file_stem().unwrap().to_str().unwrap());
        for (title, [touched, felt]) in scored(&path).into_iter().filter(|(_, [touched, _])| *touched >= TOUCHED_MIN) {
            let Some((_, verdict)) = checked.iter().find(|(layer, _)| layer.as_str() == title) else { continue };
            let agrees = match verdict {
                Verdict::Felt => 2 * felt >= touched,
                Verdict::NotFelt => 2 * felt <= touched,
                Verdict::NearThreshold | Verdict::Unknown => continue,
            };
            compared[usize::from(*verdict == Verdict::Felt)] += 1;
            let is_excepted = EXCEPTIONS.iter().any(|(of, part, _)| *of == scene && title.contains(part));
            if !agrees && !is_excepted {
                apart.push(format!("{scene}: {title}: {}, and {felt} of {touched} notice it", verdict.words()));
            }
        }
    }
    assert!(compared[0] >= 1 && compared[1] >= 10, "{compared:?} layers were called not felt and felt");
    assert!(apart.is_empty(), "{apart:#?}");
}
