//! The fuzz targets on the scenes of the gallery and on changed copies of them: a sample of what libFuzzer does.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail")]

use std::fs;

use frixel_fuzz::{
    PLAN, compiled_scenes, parquet, plan, recording_file, scenario, scene_bytes, scene_files, scene_load, scene_text,
};
use frixel_testkit::Random;

const SCENARIO: &str = "scenario = 1\nscene = \"brick.toml\"\nseconds = 1\n[[command]]\nat_ms = 0\ndo = \"play\"\n\
    [[fault]]\nname = \"cut\"\nat_ms = 300\ncause = \"cable-cut\"\n[[expect]]\nafter = \"cut\"\noutput = \"off\"\n";
/// Changed copies of each scene.
const COPIES: u64 = 200;

/// A copy with one to four bytes changed.
fn changed(bytes: &[u8], random: &mut Random) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    for _ in 0..=random.below(4) {
        let at = random.below(bytes.len() as u32) as usize;
        bytes[at] = if random.once_in(2) { random.byte() } else { bytes[at] ^ (1 << random.below(8)) };
    }
    bytes
}

#[test]
fn changed_texts_are_refused_or_become_programs_that_a_board_accepts() {
    for path in scene_files() {
        let text = fs::read(&path).unwrap();
        scene_text(&String::from_utf8_lossy(&text));
        for seed in 0..COPIES {
            scene_text(&String::from_utf8_lossy(&changed(&text, &mut Random::new(seed))));
        }
    }
}

#[test]
fn changed_recordings_scenarios_and_plans_are_refused_or_read() {
    let recording = recording_file();
    parquet(&recording);
    for seed in 0..20 * COPIES {
        parquet(&changed(&recording, &mut Random::new(seed)));
        plan(&String::from_utf8_lossy(&changed(PLAN.as_bytes(), &mut Random::new(seed))));
        scenario(&String::from_utf8_lossy(&changed(SCENARIO.as_bytes(), &mut Random::new(seed))));
    }
}

#[test]
fn changed_bytes_are_refused_or_can_be_written_back() {
    for (_, scene) in compiled_scenes() {
        scene_bytes(&scene);
        for seed in 0..20 * COPIES {
            scene_bytes(&changed(&scene, &mut Random::new(seed)));
        }
    }
}

#[test]
fn changed_bytes_are_refused_by_the_board_or_play_without_a_fault() {
    let mut played = 0;
    for (_, scene) in compiled_scenes() {
        assert!(scene_load(&scene));
        played += (0..COPIES).filter(|seed| scene_load(&changed(&scene, &mut Random::new(*seed)))).count();
    }
    assert!(played > 100, "only {played} changed scenes were played");
}
