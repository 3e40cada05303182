//! The codes of the DAC are those of the in-process rig, bit for bit.

use std::time::Duration;

use frixel_hil_sim::{RigConfig, Stroke, WorldConfig};

use super::bench::{BOARD, Bench, CONSTANT, program};
use crate::emulator;
use crate::script::Script;

/// Ticks that are compared, from the first code on that is not zero.
const TICKS: usize = 3_000;
/// Ticks by which the finger comes later after the command to play: more than a period of the carrier. Its phase there
/// depends on when the host's commands arrive, which is not the same on both lines.
const PHASES: u64 = 24;

/// The codes from the first on that is not zero.
fn driven(codes: impl IntoIterator<Item = i16>) -> Vec<i16> {
    codes.into_iter().skip_while(|code| *code == 0).take(TICKS).collect()
}

/// What the in-process rig drives when the finger comes so many ticks after the command to play.
fn in_process(finger_after_ticks: u64) -> Vec<i16> {
    let world = WorldConfig::of(&BOARD);
    let config = RigConfig { board: BOARD, world, baud: 1_000_000 };
    let mut script = Script::new(&config, Stroke::sweep(0.12, 0.08, 600.0).unwrap(), 1);
    script.play(&program(CONSTANT).scene_bytes());
    script.rig.world_mut().lift_finger();
    script.run(finger_after_ticks);
    script.rig.world_mut().start_stroke();
    let mut codes = Vec::new();
    for tick in 0..TICKS + 1_000 {
        if tick.is_multiple_of(500) {
            script.send(frixel_wire::message::Command::Ping);
        }
        codes.push(script.step().status.telemetry.dac_code);
    }
    driven(codes)
}

#[test]
fn a_play_has_the_codes_of_the_in_process_rig() {
    let Some(image) = emulator::pico_image() else { return };
    let bench = Bench::new(&image);
    let mut host = bench.connect();
    bench.take_records();
    bench.start(&mut host, CONSTANT);
    host.wait(Duration::from_millis(320), &mut |_| ()).unwrap();
    let found = driven(bench.take_records().iter().map(|record| record.drive.dac_code.bits()));
    assert_eq!(found.len(), TICKS);
    assert!(
        found.iter().all(|code| *code != 0) && found.iter().any(|code| *code < 0),
        "it drives an alternating voltage"
    );
    let same = |codes: &Vec<i16>| codes.iter().zip(&found).take_while(|(one, other)| one == other).count();
    let longest = (0..PHASES).map(|ticks| same(&in_process(ticks))).max().unwrap();
    assert_eq!(longest, TICKS, "the first {longest} codes are the same");
}
