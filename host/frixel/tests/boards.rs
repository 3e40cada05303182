//! The scenes of the gallery that real boards take, as in `docs/board/pico.md`.
#![allow(clippy::unwrap_used, reason = "a test may fail")]

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::fs;

use frixel_hil_sim::Board;
use frixel_lab::input::SceneFolder;
use frixel_scene::{Scene, compile, compile_draft};
use frixel_testkit::golden;
use serde_json::Value;

use crate::gallery::scenes;
use crate::processes::{repository, succeed};

fn scene(text: &str) -> Scene {
    Scene::parse(text, "scene.toml", &SceneFolder(repository().join("scenes"))).unwrap()
}

/// Estimated cycles of a scene's longest tick on a board.
fn cycles(text: &str, board: &Board) -> u32 {
    let program = compile_draft(&scene(text), &board.limits, board.tick_hz).unwrap();
    program.worst_tick(board.limits.core).cycles(board.limits.core)
}

#[test]
fn the_page_says_which_scenes_the_picos_take() {
    let boards = [("Pico 2", Board::PICO_2), ("Pico", Board::PICO)];
    let heads = boards.map(|(name, board)| format!("{name}, of {}", board.limits.tick_cycles_max));
    let mut table = format!("| scene | {} |\n|---|---|---|\n", heads.join(" | "));
    for (name, text) in scenes() {
        let cells = boards.map(|(_, board)| {
            let cycles = cycles(&text, &board);
            if cycles <= board.limits.tick_cycles_max { cycles.to_string() } else { format!("{cycles}: refused") }
        });
        let _ = writeln!(table, "| {name} | {} |", cells.join(" | "));
    }
    golden::hold_part(&repository().join("docs/board/pico.md"), "<!-- scenes", &table);
}

/// The scene that the page of bring-up names drives the NUCLEO above the voltage from which its monitor is held against
/// the drive.
#[test]
fn the_first_scene_after_bring_up_is_taken_and_drives_what_the_monitor_sees() {
    let path = "hardware/first_voltage.toml";
    assert!(fs::read_to_string(repository().join("docs/board/hardware.md")).unwrap().contains(path));
    let said = succeed(&repository(), &["check", path, "--board", "nucleo-g474re"]);
    assert!(said.contains("NUCLEO-G474RE behind 68 kOhm accepts it"), "{said}");
    // A scene that asks for all that the drive gives has one target.
    let targets = said.lines().find_map(|line| line.trim().strip_prefix("targets")).unwrap();
    let [least_n, largest_n] = [0, 2].map(|word| targets.split_whitespace().nth(word).unwrap());
    assert_eq!(least_n, largest_n, "{targets}");
    let board = Board::NUCLEO_G474RE;
    let text = fs::read_to_string(repository().join(path)).unwrap();
    let header = compile(&scene(&text), &board.limits, board.tick_hz).unwrap().header;
    assert!(header.voltage_max_v_peak > 2.0 * 10.7 && header.voltage_max_v_peak < 25.0, "{header:?}");
}

/// A sine and a stream, the law of a finger, and what drifts: features that no scene of the gallery asks for.
const OTHERS: [&str; 3] = [
    "version = 1\n[carrier]\nshape = \"sine\"\n[[layer]]\nkind = \"stream\"\nlow_n = 0\nhigh_n = 0.01\n",
    "version = 1\nfinger = { friction_coefficient = 0.4, normal_load_n = 0.5, origin = \"empirical\", date = \
     \"2026-11-23\", method = \"load cell\", screen = \"example\", exponent = 2, points = [[150, 0.09]], intervals_n = \
     [[0.08, 0.1]] }\n[[layer]]\nkind = \"constant\"\nfriction_n = 0.21\n",
    "version = 1\n[[layer]]\nkind = \"rings\"\nx_mm = 50\ny_mm = 20\nwavelength_mm = 10\ndrift_mm_per_s = 20\n\
     low_n = 0\nhigh_n = 0.02\nabove = \"natural\"\n",
];

/// Everything that a scene can need is a feature in both manifests.
#[test]
fn the_smallest_firmware_has_what_the_scene_asks_for() {
    let folder = tempfile::tempdir().unwrap();
    let mut paths: Vec<String> = scenes().iter().map(|(name, _)| format!("scenes/{name}.toml")).collect();
    for (number, text) in OTHERS.iter().enumerate() {
        let path = folder.path().join(format!("{number}.toml"));
        fs::write(&path, text).unwrap();
        paths.push(path.display().to_string());
    }
    let mut found = BTreeSet::new();
    for path in paths {
        let json = succeed(&repository(), &["check", &path, "--json", "--image"]);
        let check: Value = serde_json::from_str(&json).unwrap();
        let names: Vec<String> = serde_json::from_value(check["board"]["features"].clone()).unwrap();
        let command = check["board"]["command"].as_str().unwrap();
        assert!(command.contains("--no-default-features") && command.ends_with(&names.join(",")), "{command}");
        found.extend(names);
    }
    for (manifest, others) in [
        ("firmware/session/Cargo.toml", [].as_slice()),
        ("firmware/board-nucleo-g474re/Cargo.toml", &["panic-message", "log", "self-test"]),
    ] {
        let text = fs::read_to_string(repository().join(manifest)).unwrap();
        let list = text.split("default = [").nth(1).unwrap().split(']').next().unwrap();
        let names = list.split(',').map(|name| name.trim().trim_matches('"'));
        let known = names.filter(|name| !name.is_empty() && !others.contains(name)).map(str::to_owned).collect();
        assert_eq!(found, known, "{manifest}");
    }
}
