//! `frixel scene check` and `frixel score` mean the same by *felt* and *not felt*, and so does a person: what a check
//! calls felt is noticed by at least half of the simulated fingers, and what it calls not felt by at most half.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail")]

use std::fs;
use std::path::{Path, PathBuf};

use frixel::scene_file;
use frixel_felt::perception::{Perception, Verdict};
use frixel_hil_sim::{RigConfig, TouchConfig};
use frixel_scene::{LayerTitle, compile};
use serde_json::Value;

use crate::processes::{repository, run};

/// Simulated people.
const PEOPLE: &str = "10";
/// Fewer fingers that touched a layer say nothing about half of them.
const TOUCHED_MIN: u64 = 5;

/// What a check says of each layer.
fn checked(path: &Path) -> Vec<(LayerTitle, Verdict)> {
    let rig = RigConfig::default();
    let program = compile(&scene_file::load(path).unwrap(), &rig.board.limits, rig.board.tick_hz).unwrap();
    let layers = Perception::of(&program, &TouchConfig::REALISTIC).layers;
    layers.into_iter().map(|judged| (judged.layer, judged.verdict)).collect()
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

/// Where a check of a scene and a score of it use one word for two things; `compared` counts the layers that a check
/// called not felt and felt.
fn disagreements(path: &Path, checked: &[(LayerTitle, Verdict)], compared: &mut [usize; 2]) -> Vec<String> {
    let mut apart = Vec::new();
    for (title, [touched, felt]) in scored(path).into_iter().filter(|(_, [touched, _])| *touched >= TOUCHED_MIN) {
        let Some((_, verdict)) = checked.iter().find(|(layer, _)| layer.as_str() == title) else { continue };
        let agrees = match verdict {
            Verdict::Felt => 2 * felt >= touched,
            Verdict::NotFelt => 2 * felt <= touched,
            Verdict::NearThreshold | Verdict::Unknown => continue,
        };
        compared[usize::from(*verdict == Verdict::Felt)] += 1;
        if !agrees {
            let scene = path.file_stem().unwrap().display();
            apart.push(format!("{scene}: {title}: {}, and {felt} of {touched} notice it", verdict.words()));
        }
    }
    apart
}

fn scenes(folder: &Path) -> impl Iterator<Item = PathBuf> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    entries.filter(|path| path.extension().is_some_and(|end| end == "toml"))
}

#[test]
fn a_check_and_a_score_of_every_scene_agree() {
    let mut compared = [0, 0];
    let apart: Vec<String> = scenes(&repository().join("scenes"))
        .flat_map(|path| disagreements(&path, &checked(&path), &mut compared))
        .collect();
    assert!(compared[0] >= 1 && compared[1] >= 10, "{compared:?} layers were called not felt and felt");
    assert!(apart.is_empty(), "{apart:#?}");
}

/// Scenes whose first comment has what a person would say before anybody computes anything: `# felt: NAME, NAME` for
/// each verdict.
#[test]
fn check_score_and_common_sense_agree() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/verdicts");
    let mut compared = [0, 0];
    let mut apart = Vec::new();
    for path in scenes(&folder) {
        let (text, checked) = (fs::read_to_string(&path).unwrap(), checked(&path));
        let expected: Vec<(&str, &str)> = text
            .lines()
            .filter_map(|line| line.strip_prefix("# ")?.split_once(": "))
            .filter(|(word, _)| ["felt", "maybe", "not felt", "unknown"].contains(word))
            .flat_map(|(word, names)| names.split(", ").map(move |name| (word, name)))
            .collect();
        assert!(!expected.is_empty(), "{}", path.display());
        for (layer, verdict) in &checked {
            let expected = expected.iter().find(|(_, name)| layer.as_str().contains(&format!("\"{name}")));
            let (expected, _) = expected.unwrap_or_else(|| panic!("{}: {layer} is not named", path.display()));
            if *expected != verdict.words() {
                apart.push(format!("{}: {layer}: {}, and a person says {expected}", path.display(), verdict.words()));
            }
        }
        apart.extend(disagreements(&path, &checked, &mut compared));
    }
    assert!(compared[0] >= 3 && compared[1] >= 10, "{compared:?} layers were called not felt and felt");
    assert!(apart.is_empty(), "{apart:#?}");
}
