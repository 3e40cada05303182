//! Compiles arbitrary text as a scene file. It is rejected, or becomes a program that a board accepts, with ticks in
//! time.
#![no_main]

use std::collections::BTreeMap;

use frixel::check::SceneCheck;
use frixel_hil_sim::RigConfig;
use frixel_scene::{Scene, compile};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|text: &str| {
    let rig = RigConfig::default();
    // There are no pictures, because only the text is tested.
    let Ok(scene) = Scene::parse(text, "fuzz.toml", &BTreeMap::new()) else { return };
    let Ok(program) = compile(&scene, &rig.board.limits, rig.board.tick_hz) else { return };
    assert!(program.worst_tick().cycles() <= rig.board.limits.tick_cycles_max);
    if let Err(error) = SceneCheck::of(&program, &rig) {
        panic!("it compiles, and the board does not take it: {error}");
    }
});
