//! A finger feels a grating as faithfully as the goal asks, and nearly as faithfully as on the in-process rig.

use std::slice;
use std::time::Duration;

use frixel_driver::ignore_progress;
use frixel_felt::fidelity::{Fidelity, FidelityMean, FidelitySample, Goal, SAMPLE_HZ};
use frixel_felt::recorder::{FeltRow, Observation, Recorder};
use frixel_hil_sim::emulated::Image;
use frixel_hil_sim::{Felt, HUMAN_TEST_SEEDS, RigConfig, Stroke, TouchConfig, WorldConfig, WorldOptions};
use frixel_wire::message::Command;

use super::bench::{BOARD, Bench, GRATING, program};
use crate::emulator;
use crate::script::Script;

/// Largest error beyond that of the in-process rig: line and main loop take a report some ticks later.
const LINE_ERROR_MAX: f64 = 0.02;
/// Ticks between two pings of the in-process rig's host: less than its timeout of 250 ms.
const PING_TICKS: u64 = 800;
/// Number of strokes.
const STROKES: usize = 4;
/// Duration of a stroke.
const STROKE_S: f64 = 8.5;
/// Median speed of the touches, in m/s.
const SPEED_M_PER_S: f64 = 0.05;

/// Every effect of the plant, and the touch source that a grating of 10 mm is made for.
fn world() -> WorldConfig {
    let options = WorldOptions { touch: TouchConfig::bundled("100"), ..WorldOptions::default() };
    WorldConfig::of(&BOARD).with(&options)
}

fn stroke(seconds: f64, seed: u64) -> Stroke {
    Stroke::human(0.12, 0.08, seconds, Some(SPEED_M_PER_S), seed).unwrap()
}

/// The fidelity of what was felt tick by tick, with the code that went to the DAC.
fn fidelity(ticks: impl IntoIterator<Item = (Felt, i16)>) -> Fidelity {
    let ticks_per_row = (f64::from(BOARD.tick_hz) / SAMPLE_HZ) as u32;
    let recorder = Recorder::new(&program(GRATING), &BOARD.limits, BOARD.tick_hz, u64::MAX, ticks_per_row);
    let mut recorder = recorder.unwrap().through_finger();
    recorder.start(0);
    for (tick, (felt, code)) in (1..).zip(ticks) {
        recorder.record(&Observation::of_world(tick, &felt, code));
    }
    let mut is_tracked = false;
    let sample = |row: &FeltRow| {
        let is_driven = row.dac_code != Some(0);
        is_tracked = row.speed_mm_s.is_some() && (is_tracked || is_driven);
        let speed_m_per_s = row.speed_mm_s.filter(|_| is_tracked).map(|speed_mm_s| 1e-3 * speed_mm_s);
        FidelitySample { speed_m_per_s, is_driven, ..FidelitySample::of_row(row, 0.0) }
    };
    Fidelity::of(&recorder.rows().iter().map(sample).collect::<Vec<_>>()).unwrap()
}

/// The fidelity of a stroke on the Pico, and the tick of the world at which the stroke begins.
fn on_the_pico(image: &Image, seconds: f64, seed: u64) -> (Fidelity, u64) {
    let bench = Bench::in_world_with_frame(image, &world(), stroke(seconds, seed), seed);
    let mut host = bench.connect();
    frixel_play::start(&mut host, &program(GRATING), &mut ignore_progress).unwrap();
    bench.take_records();
    let start_tick = bench.with(|rig| {
        rig.world_mut().start_stroke();
        rig.world().tick()
    });
    host.wait(Duration::from_secs_f64(seconds), &mut |_| ()).unwrap();
    let ticks = bench.take_records().into_iter().map(|record| (record.felt, record.drive.dac_code.bits()));
    (fidelity(ticks), start_tick)
}

/// The same on the in-process rig. From the same tick on, the same reports are lost and late.
fn in_process(seconds: f64, seed: u64, start_tick: u64) -> Fidelity {
    let config = RigConfig { board: BOARD, world: world(), baud: 2_000_000 };
    let mut script = Script::new(&config, stroke(seconds, seed), seed);
    script.play(&program(GRATING).scene_bytes());
    script.rig.world_mut().lift_finger();
    let step = |script: &mut Script| {
        if script.rig.tick().is_multiple_of(PING_TICKS) {
            script.send(Command::Ping);
        }
        script.step()
    };
    while script.rig.tick() < start_tick {
        step(&mut script);
    }
    script.rig.world_mut().start_stroke();
    fidelity((0..(seconds * f64::from(BOARD.tick_hz)) as u32).map(|_| {
        let record = step(&mut script);
        (record.felt, record.drive.dac_code.bits())
    }))
}

#[test]
#[ignore = "takes minutes: `cargo xtask soak pico`"]
fn a_grating_is_felt_within_the_goal_under_a_finger_that_a_touch_frame_sees() {
    let Some(image) = emulator::pico_image_with_frame() else { return };
    let stroke = |seed| {
        let (found, start_tick) = on_the_pico(&image, STROKE_S, seed);
        let beside = in_process(STROKE_S, seed, start_tick);
        for (rig, felt) in [("Pico", &found), ("in-process", &beside)] {
            println!("{rig}, seed {seed}: {:.3?}", FidelityMean::of(slice::from_ref(felt)));
        }
        assert!(found.error.unwrap() <= beside.error.unwrap() + LINE_ERROR_MAX, "{found:?}, in-process {beside:?}");
        found
    };
    let mean = FidelityMean::of(&HUMAN_TEST_SEEDS.take(STROKES).map(stroke).collect::<Vec<_>>()).unwrap();
    println!("{mean:.3?}");
    assert!(Goal::SLOW.is_met_by(&mean), "{mean:?}");
}
