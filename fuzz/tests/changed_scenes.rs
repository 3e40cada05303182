//! The fuzz targets on the scenes of the gallery and on changed copies of them: a sample of what libFuzzer does.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail")]

use frixel_fuzz::{TARGETS, compiled_scenes, scene_load};
use frixel_testkit::Random;

/// Changed copies of each input of a slow target.
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
fn changed_seeds_pass_every_target() {
    for target in TARGETS.into_iter().filter(|target| target.name != "scene_load") {
        let seeds = (target.seeds)();
        let copies = match target.name {
            "scene_text" | "scenario" => COPIES,
            _ => 20 * COPIES,
        };
        for (_, bytes) in seeds {
            (target.run)(&bytes);
            for seed in 0..copies {
                (target.run)(&changed(&bytes, &mut Random::new(seed)));
            }
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
