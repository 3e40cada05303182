//! Drafts: scenes that a board refuses, drawn by `frixel preview` and played by the simulator, clamped, and
//! marked in every output.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail")]

use std::fs;
use std::path::Path;

use serde_json::Value;
use tempfile::TempDir;

use crate::processes::run;

const OUT_OF_REACH: &str = "version = 1\n[[layer]]\nname = \"hot\"\nkind = \"constant\"\nfriction_n = 0.9\n";
const IN_REACH: &str = "version = 1\n[[layer]]\nname = \"warm\"\nkind = \"constant\"\nfriction_n = 0.3\n";
const REFUSAL: &str =
    "5:14: layer 1 \"hot\" asks for up to 0.9 N in total, and at 150 V rms this finger feels at most 0.3799 N";

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

fn folder_with(scene: &str) -> TempDir {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("scene.toml"), scene).unwrap();
    folder
}

#[test]
fn a_scene_out_of_reach_is_previewed_and_hatched_and_checked_as_before() {
    let folder = folder_with(OUT_OF_REACH);
    let preview = run(folder.path(), &["preview", "scene.toml", "-o", "map.png"]);
    let (said, noted) = (text(&preview.stdout), text(&preview.stderr));
    assert_eq!(preview.status.code(), Some(0), "{noted}");
    assert!(
        said.starts_with(
            "  draft            a board refuses this scene, for 1 reason; what is out of reach is clamped here\n"
        ),
        "{said}"
    );
    assert!(
        noted.starts_with("draft: a board refuses scene.toml:\n") && noted.contains(&format!("scene.toml:{REFUSAL}")),
        "{noted}"
    );
    assert!(fs::metadata(folder.path().join("map.png")).unwrap().len() > 10_000);
    let check = run(folder.path(), &["check", "scene.toml"]);
    assert_eq!(check.status.code(), Some(1));
    assert!(text(&check.stderr).contains(REFUSAL), "{}", text(&check.stderr));
}

#[test]
fn every_output_of_a_draft_says_so() {
    let folder = folder_with(OUT_OF_REACH);
    let play = run(folder.path(), &["play", "scene.toml", "--seconds", "0.3", "--json"]);
    assert_eq!(play.status.code(), Some(0), "{}", text(&play.stderr));
    let printed: Value = serde_json::from_slice(&play.stdout).unwrap();
    let out = folder.path().join("frixel-out");
    let written: Value = serde_json::from_slice(&fs::read(out.join("summary.json")).unwrap()).unwrap();
    for report in [&printed, &written] {
        assert_eq!(report["draft"], true);
        let refusal = report["board_refuses"][0].as_str().unwrap();
        assert!(refusal.starts_with(&format!("scene.toml:{REFUSAL}")), "{report}");
    }
    assert!(printed["saturated_ticks"].as_u64().unwrap() > 1000, "the board clamps: {printed}");
    let svg = fs::read_to_string(out.join("felt.svg")).unwrap();
    assert!(svg.contains("scene.toml, draft, simulated"));
    let summary = run(folder.path(), &["play", "scene.toml", "--seconds", "0.3"]);
    assert!(text(&summary.stdout).contains("\n  draft "), "{}", text(&summary.stdout));

    fs::write(folder.path().join("scene.toml"), IN_REACH).unwrap();
    let play = run(folder.path(), &["play", "scene.toml", "--seconds", "0.3"]);
    assert!(!text(&play.stdout).contains("draft"), "{}", text(&play.stdout));
    let written: Value = serde_json::from_slice(&fs::read(out.join("summary.json")).unwrap()).unwrap();
    assert_eq!((&written["draft"], &written["board_refuses"]), (&Value::Bool(false), &Value::Array(Vec::new())));
    assert!(!fs::read_to_string(out.join("felt.svg")).unwrap().contains("draft"));
}

/// Five layers of noise take longer than a board has time for; a picture at a fine pitch takes more bytes than it has.
#[test]
fn what_a_board_has_no_time_or_room_for_plays_as_a_draft() {
    let noise = "[[layer]]\nkind = \"noise\"\nblend = \"add\"\nwavelength_min_mm = 1\nwavelength_max_mm = 4\nlow_n = 0\nhigh_n = 0.01\n";
    let folder = folder_with(&format!("version = 1\n{}", noise.repeat(5)));
    let play = run(folder.path(), &["play", "scene.toml", "--seconds", "0.3"]);
    assert_eq!(play.status.code(), Some(0), "{}", text(&play.stderr));
    assert!(text(&play.stderr).contains("and the board has time for 2550"), "{}", text(&play.stderr));

    let brick = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/textures/brick.png");
    fs::copy(brick, folder.path().join("brick.png")).unwrap();
    let picture = "version = 1\n[[layer]]\nkind = \"bitmap\"\npicture = \"brick.png\"\nx_mm = 0\ny_mm = 0\nwidth_mm = 100\npitch_mm = 0.1\n";
    fs::write(folder.path().join("scene.toml"), picture).unwrap();
    let play = run(folder.path(), &["play", "scene.toml", "--seconds", "0.3"]);
    assert_eq!(play.status.code(), Some(0), "{}", text(&play.stderr));
    assert!(text(&play.stderr).contains("and the board has 65536"), "{}", text(&play.stderr));
}
