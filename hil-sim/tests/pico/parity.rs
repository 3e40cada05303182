//! The codes of the DAC are those of the in-process rig, bit for bit: table, envelope and carrier.
//!
//! The two rigs hear their host at different ticks, because a line, a main loop and a queue lie between the host and the
//! Pico's tick. So the scene is one whose friction does not depend on the place, and the carrier's phase is looked for.
//! Tracks and layers under a moving finger are not compared here.

use std::time::Duration;

use frixel_hil_sim::{Point, RigConfig, Stroke, WorldConfig};
use frixel_wire::message::Command;

use super::bench::{BOARD, Bench, CONSTANT, program};
use crate::emulator;
use crate::script::Script;

/// Ticks that are compared, from the first code on that is not zero.
const TICKS: usize = 2_400;
/// Ticks by which the finger comes later after the command to play: more than a period of the carrier, whose phase begins
/// there.
const PHASES: u64 = 24;
/// Ticks between two pings.
const PING_TICKS: usize = 500;

/// The codes from the first on that is not zero.
fn driven(codes: impl IntoIterator<Item = i16>) -> Vec<i16> {
    codes.into_iter().skip_while(|code| *code == 0).take(TICKS).collect()
}

/// What the in-process rig drives when the finger comes so many ticks after the command to play.
fn in_process(finger_after_ticks: u64) -> Vec<i16> {
    let [left, right] = [0.01, 0.11].map(|x_m| Point { x_m, y_m: 0.03 });
    let stroke = Stroke::constant_speed(left, right, 0.1).unwrap();
    let config = RigConfig { board: BOARD, world: WorldConfig::of(&BOARD), baud: 2_000_000 };
    let mut script = Script::new(&config, stroke, 1);
    script.play(&program(CONSTANT).scene_bytes());
    script.rig.world_mut().lift_finger();
    script.run(finger_after_ticks);
    script.rig.world_mut().start_stroke();
    let codes = (0..TICKS + 1_000).map(|tick| {
        if tick.is_multiple_of(PING_TICKS) {
            script.send(Command::Ping);
        }
        script.step().status.telemetry.dac_code
    });
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
    let is_driven = found.len() == TICKS && found.iter().all(|code| *code != 0);
    assert!(is_driven && found.iter().any(|code| *code < 0), "it drives an alternating voltage all the time");
    let same = |codes: &Vec<i16>| codes.iter().zip(&found).take_while(|(one, other)| one == other).count();
    let longest = (0..PHASES).map(|ticks| same(&in_process(ticks))).max().unwrap();
    assert_eq!(longest, TICKS, "the first {longest} codes are the same");
}
