//! The judge on the simulated board, for scenes whose verdict is common sense.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail")]

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};

use frixel_felt::check::feel;
use frixel_felt::judge::{Advice, Judgement, LayerVerdict, Reason, Verdict};
use frixel_hil_sim::{RigConfig, WorldOptions};
use frixel_play::{SimulationError, TO_THE_END, break_if, judge};
use frixel_scene::{Program, Scene, compile};
use frixel_testkit::examples;

fn program(text: &str) -> Program {
    let board = RigConfig::default().board;
    let brick = include_bytes!("../../../scenes/textures/brick.png");
    let files = BTreeMap::from([("textures/brick.png".to_owned(), brick.to_vec())]);
    let scene = Scene::parse(text, "scene.toml", &files).unwrap();
    compile(&scene, &board.limits, board.tick_hz).unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn judged_program(program: &Program, advice: Advice) -> Judgement {
    judge(program, &RigConfig::default(), &WorldOptions::default(), advice, TO_THE_END).unwrap()
}

fn judged(layers: &str, advice: Advice) -> Judgement {
    judged_program(&program(&format!("version = 1\n{layers}")), advice)
}

/// The topmost layer of a scene.
fn top(layers: &str) -> LayerVerdict {
    judged(layers, Advice::Omitted).layers.pop().unwrap()
}

fn bar(width_mm: f64) -> String {
    let x_mm = 60.0 - 0.5 * width_mm;
    format!(
        "[[layer]]\nkind = \"constant\"\nfriction_fraction = 0.9\n\
         region = {{ x_mm = {x_mm}, y_mm = 0, width_mm = {width_mm}, height_mm = 80 }}\n"
    )
}

fn button([width_mm, height_mm, rim_mm]: [f64; 3]) -> String {
    let (x_mm, y_mm) = (60.0 - 0.5 * width_mm, 40.0 - 0.5 * height_mm);
    format!(
        "[[layer]]\nkind = \"button\"\nrim_width_mm = {rim_mm}\nrim_fraction = 0.9\nface_fraction = 0\n\
         region = {{ x_mm = {x_mm}, y_mm = {y_mm}, width_mm = {width_mm}, height_mm = {height_mm} }}\n"
    )
}

fn dot(size_mm: f64) -> String {
    let at_mm = 5.0 - 0.5 * size_mm;
    format!(
        "[[layer]]\nkind = \"constant\"\nfriction_fraction = 0.9\n\
         region = {{ x_mm = 55, y_mm = 35, width_mm = 10, height_mm = 10 }}\n\
         [[layer]]\nkind = \"constant\"\nfriction_fraction = 0\n\
         region = {{ x_mm = {}, y_mm = {}, width_mm = {size_mm}, height_mm = {size_mm} }}\n",
        55.0 + at_mm,
        35.0 + at_mm
    )
}

fn grating(wavelength_mm: f64) -> String {
    format!("[[layer]]\nkind = \"grating\"\nwavelength_mm = {wavelength_mm}\nlow_fraction = 0\nhigh_fraction = 0.9\n")
}

/// A larger element of the same friction is never felt less surely.
#[test]
fn no_verdict_is_worse_than_that_of_a_smaller_element() {
    let buttons = [[6.0, 6.0, 2.0], [14.0, 10.0, 2.0], [20.0, 10.0, 2.0], [30.0, 16.0, 4.0], [40.0, 20.0, 4.0]];
    let grown = [[10.0, 8.0, 2.0], [48.0, 40.0, 2.0], [96.0, 64.0, 2.0]];
    for scenes in [
        buttons.map(button).to_vec(),
        grown.map(button).to_vec(),
        [1.0, 2.0, 3.0, 10.0, 96.0].map(bar).to_vec(),
        [3.0, 4.0, 5.0, 6.0].map(dot).to_vec(),
    ] {
        let found: Vec<LayerVerdict> = scenes.iter().map(|scene| top(scene)).collect();
        let said: Vec<String> = found.iter().map(feel::sentence).collect();
        assert!(found.is_sorted_by_key(|found| sureness(found.verdict)), "{said:#?}");
        assert_eq!(found.last().unwrap().verdict, Verdict::Felt, "{said:#?}");
    }
}

#[test]
fn an_interrupted_judgement_has_no_verdicts() {
    let (rig, world) = (RigConfig::default(), WorldOptions::default());
    for asked_max in [0, 2] {
        let asked = AtomicUsize::new(0);
        let goes_on = || break_if(asked.fetch_add(1, Ordering::Relaxed) >= asked_max);
        let program = program(&format!("version = 1\n{}", bar(10.0)));
        let found = judge(&program, &rig, &world, Advice::Omitted, &goes_on);
        assert!(matches!(found, Err(SimulationError::Interrupted)), "{found:?}");
    }
}

fn sureness(verdict: Verdict) -> usize {
    [Verdict::NotFelt, Verdict::Unknown, Verdict::Maybe, Verdict::Felt]
        .into_iter()
        .position(|other| other == verdict)
        .unwrap()
}

/// The middle row lies on a border of the spokes, where the finger is on neither side for long.
#[test]
fn spokes_are_felt_however_they_are_turned() {
    for (number, angle_deg) in [(7, 0), (8, 0), (12, 0), (12, 10), (24, 0)] {
        let spokes = top(&format!(
            "[[layer]]\nkind = \"spokes\"\nwave = \"square\"\nx_mm = 60\ny_mm = 40\nnumber = {number}\n\
             angle_deg = {angle_deg}\nlow_fraction = 0\nhigh_fraction = 0.9\n"
        ));
        assert!(
            spokes.verdict == Verdict::Felt && spokes.contrast.verdict == Verdict::Felt,
            "{number} spokes at {angle_deg}: {}",
            feel::sentence(&spokes)
        );
    }
}

/// Layers and clicks that people copy. No study covers what a program streams.
#[test]
fn the_examples_of_the_docs_are_felt() {
    let examples = examples::blocks(include_str!("../../../docs/design/scenes.md"));
    for example in examples.iter().filter(|example| example.contains("[[layer]]")) {
        let program = program(&examples::below_head(examples[0], example));
        let expected = if example.contains("kind = \"stream\"") { Verdict::Unknown } else { Verdict::Felt };
        for found in judged_program(&program, Advice::Omitted).layers {
            assert_eq!(found.verdict, expected, "{}\n{example}", feel::sentence(&found));
            let is_felt = found.click.is_none_or(|click| click.verdict == Verdict::Felt);
            assert!(is_felt, "{}\n{example}", feel::sentence(&found));
        }
    }
}

#[test]
fn reasons_name_what_is_in_the_way() {
    let slope = top(&grating(500.0));
    assert!(matches!(slope.reasons[..], [Reason::TooSlow { .. }]), "{}", feel::sentence(&slope));
    for wavelength_mm in [0.05, 0.2, 1.0, 2.0] {
        let fine = top(&grating(wavelength_mm));
        assert_eq!(
            (fine.verdict, &fine.reasons[..]),
            (Verdict::Felt, &[Reason::Buzz][..]),
            "{}",
            feel::sentence(&fine)
        );
    }
    for (on_ms, verdict) in [(1, Verdict::NotFelt), (2, Verdict::Maybe)] {
        let burst = top(&format!(
            "[[layer]]\nkind = \"vibration\"\nfrequency_hz = 120\nlow_fraction = 0\nhigh_fraction = 0.9\n\
             burst = {{ period_ms = 60000, on_ms = {on_ms}, ramp_ms = 0.5 }}\n"
        ));
        let [Reason::TooShort { .. }, Reason::TooRare { .. }] = burst.reasons[..] else {
            panic!("{}", feel::sentence(&burst));
        };
        assert_eq!(burst.verdict, verdict, "{}", feel::sentence(&burst));
    }
}

#[test]
fn gratings_of_almost_the_same_wavelength_are_alike() {
    let half = |x_mm: u32, wavelength_mm: f64| {
        format!("{}region = {{ x_mm = {x_mm}, y_mm = 0, width_mm = 30, height_mm = 80 }}\n", grating(wavelength_mm))
    };
    assert_eq!(judged(&(half(0, 2.0) + &half(60, 2.05)), Advice::Omitted).alike.len(), 1);
    assert_eq!(judged(&(half(0, 2.0) + &half(60, 5.0)), Advice::Omitted).alike.len(), 0);
}

/// The element that follows its advice is felt.
#[test]
fn advice_that_is_followed_ends_in_felt() {
    let faint = "[[layer]]\nkind = \"constant\"\nfriction_fraction = FRACTION\n\
                 region = { x_mm = 40, y_mm = 20, width_mm = 30, height_mm = 30 }\n";
    let edge = "[[layer]]\nkind = \"edge\"\nx_mm = 60\ny_mm = 40\nwidth_mm = 0.3\nridge_fraction = 0.9\n";
    let ridge_over_stripes = "[[layer]]\nkind = \"grating\"\nwavelength_mm = 1.5\n\
                              low_fraction = 0.2\nhigh_fraction = 0.8\n\
                              [[layer]]\nkind = \"edge\"\nx_mm = 60\ny_mm = 40\nwidth_mm = 8\nridge_fraction = 0.9\n\
                              blend = \"max\"\nregion = { x_mm = 50, y_mm = 20, width_mm = 20, height_mm = 40 }\n";
    let button = |fields: &str| {
        format!(
            "{}[[layer]]\nkind = \"button\"\nrim_width_mm = 4\n\
             region = {{ x_mm = 40, y_mm = 28, width_mm = 40, height_mm = 24 }}\n{fields}",
            grating(12.0)
        )
    };
    for layers in [
        faint.replace("FRACTION", "0.1"),
        faint.replace("FRACTION", "0.25"),
        bar(1.0),
        edge.to_owned(),
        button("rim_fraction = 0.5\nface_fraction = 0.2\n"),
        button("rim_fraction = 0.5\nface_fraction = 0.2\ngain = 0.9\nclick_fraction = 0.05\n"),
        ridge_over_stripes.to_owned(),
    ] {
        let found = judged(&layers, Advice::Sought).layers.pop().unwrap();
        assert_ne!(found.verdict, Verdict::Felt, "{layers}");
        let advice = found.advice.clone().unwrap_or_default();
        let fields = advice.strip_prefix("felt with ").unwrap_or_else(|| panic!("{}", feel::sentence(&found)));
        let fields = fields.trim_start_matches("a region of ");
        let followed = fields.split(", ").fold(layers.clone(), |layers, field| {
            let (name, _) = field.split_once(" = ").unwrap();
            follow(&layers, name, field)
        });
        assert_eq!(top(&followed).verdict, Verdict::Felt, "{followed}");
    }
}

/// A scene with a field in place of what its top layer has, or added. `a constant of` goes below the top layer.
fn follow(layers: &str, name: &str, field: &str) -> String {
    if name.starts_with("a constant") {
        let (below, top) = layers.split_at(layers.rfind("[[layer]]").unwrap());
        let region = top.lines().find(|line| line.starts_with("region = ")).unwrap();
        return format!("{below}[[layer]]\nkind = \"constant\"\nfriction_fraction = 0\n{region}\n{top}");
    }
    let Some(start) = layers.rfind(&format!("{name} = ")) else { return format!("{layers}{field}\n") };
    let length = layers[start..].find([',', '\n', ' ', '}'].as_slice()).unwrap();
    let end = start + length;
    let end = end + layers[end + 3..].find([',', '\n', ' ', '}'].as_slice()).unwrap() + 3;
    format!("{}{field}{}", &layers[..start], &layers[end..])
}

fn scenes() -> Vec<PathBuf> {
    let entries = fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/verdicts")).unwrap();
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    paths
}

/// The first comment of each scene states the common-sense verdicts: `# felt: NAME, NAME` for each verdict.
#[test]
fn the_judge_and_common_sense_agree() {
    let mut apart = Vec::new();
    for path in scenes() {
        let text = fs::read_to_string(&path).unwrap();
        let checked = judged_program(&program(&text), Advice::Omitted);
        let expected: Vec<(&str, &str)> = text
            .lines()
            .filter_map(|line| line.strip_prefix("# ")?.split_once(": "))
            .filter(|(word, _)| ["felt", "maybe", "not felt", "unknown"].contains(word))
            .flat_map(|(word, names)| names.split(", ").map(move |name| (word, name)))
            .collect();
        assert!(!expected.is_empty(), "{}", path.display());
        for found in &checked.layers {
            let expected = expected.iter().find(|(_, name)| found.layer.as_str().contains(&format!("\"{name}")));
            let (expected, _) = expected.unwrap_or_else(|| panic!("{}: {} is not named", path.display(), found.layer));
            if *expected != found.verdict.words() {
                let scene = path.file_stem().unwrap().display();
                apart.push(format!("{scene}: {}: {}; a person says {expected}", found.layer, feel::sentence(found)));
            }
        }
    }
    assert!(apart.is_empty(), "{apart:#?}");
}
