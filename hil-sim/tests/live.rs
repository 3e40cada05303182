//! Changes while a scene plays, tick by tick: a layer's gain, and the replacement of the scene.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail")]

use crate::script;

use frixel_hil_sim::{Point, RigConfig, RigTick, Status, Stroke, TouchConfig};
use frixel_layers::{Blend, Grating, Header, Layer, Record, Wave};
use frixel_wire::frame::FRAME_MAX_LEN;
use frixel_wire::message::Command;
use frixel_wire::payload::{self, CHUNK_LEN};
use script::{HEADER, Script, constant, record, scene};

/// A touch source that reports in every fifth tick, so that orders and reports meet in one tick now and then.
fn config() -> RigConfig {
    let mut config = RigConfig::default();
    config.world.touch =
        TouchConfig { rate_hz: 8_000.0, latency_s: 0.0, noise_rms_m: 0.0, jitter_rms_s: 0.0, ..TouchConfig::IDEAL };
    config
}

fn slide() -> Stroke {
    Stroke::constant_speed(Point { x_m: 0.01, y_m: 0.03 }, Point { x_m: 0.11, y_m: 0.05 }, 0.1).unwrap()
}

fn stripes(crest_n: f32, cycles_per_m_x: f32) -> Record {
    let wave = Wave::Sine;
    let layer = Layer::Grating(Grating {
        wave,
        cycles_per_m_x,
        cycles_per_m_y: 40.0,
        phase_turns: 0.1,
        trough_n: 0.001,
        crest_n,
        drift_hz: 0.0,
    });
    Record { blend: Blend::Add, ..record(layer) }
}

/// Plays `scene` from power-on for 1,000 ticks, and hands the board over.
fn play(scene: &[u8]) -> Script {
    let mut script = Script::new(&config(), slide(), 1);
    script.play(scene);
    for _ in 0..1_000 {
        script.step();
    }
    script
}

fn amplitude(record: &RigTick<Status>) -> u16 {
    record.status.telemetry.dac_code.unsigned_abs()
}

/// Ticks from the last byte of the command until the DAC has the requested code, over all phases of the touch source.
/// Half the friction needs less voltage, but no less than half.
fn ticks_to_dac(bulk_frames: usize) -> u64 {
    let mut most = 0;
    for phase in 0..10 {
        let mut script = play(&scene(&HEADER, &[constant(0.02)]));
        for _ in 0..phase {
            script.step();
        }
        let before = amplitude(&script.step());
        let chunks = |script: &mut Script, count: usize| {
            for number in 0..count {
                let mut frame = [0; FRAME_MAX_LEN];
                script.rig.send(payload::chunk_frame(number as u16, &[7; CHUNK_LEN], &mut frame).unwrap());
            }
        };
        chunks(&mut script, bulk_frames / 2);
        script.send(Command::SetLayer { layer: 0, on: true, gain: 0.5 });
        let line = script.rig.line_to_board_mut();
        let last_byte = line.delivered() + line.queued() as u64;
        chunks(&mut script, bulk_frames - bulk_frames / 2);
        let mut last_byte_tick = None;
        loop {
            let record = script.step();
            assert!(record.tick < 20_000, "the gain never reached the DAC");
            if script.rig.line_to_board_mut().delivered() >= last_byte && last_byte_tick.is_none() {
                last_byte_tick = Some(record.tick);
            }
            if amplitude(&record) != before {
                let now = f64::from(amplitude(&record));
                assert!((0.5..0.8).contains(&(now / f64::from(before))), "{now} after {before}");
                most = most.max(record.tick + 1 - last_byte_tick.unwrap_or(record.tick));
                break;
            }
        }
    }
    most
}

#[test]
fn a_gain_is_at_the_dac_within_a_millisecond_on_an_idle_line_and_two_during_an_upload() {
    let (idle, busy) = (ticks_to_dac(0), ticks_to_dac(40));
    println!("from the last byte to the DAC: {idle} ticks on an idle line, {busy} during an upload; 40 are 1 ms");
    assert!(idle <= 40, "{idle} ticks");
    assert!(busy <= 80, "{busy} ticks");
}

/// Three boards under the same finger: one plays `before`, one plays `after` from the start, and one swaps `before` for
/// `after` while it plays. Has the tick of the swap, and the three boards at each tick.
struct Swap {
    swap: usize,
    before: Vec<RigTick<Status>>,
    after: Vec<RigTick<Status>>,
    swapped: Vec<RigTick<Status>>,
}

const SWAP_TICKS: usize = 3_000;

fn run(first: &[u8], second: Option<(&[u8], usize)>) -> Vec<RigTick<Status>> {
    let mut script = play(first);
    let mut records = Vec::new();
    let mut commit = None;
    for tick in 0..SWAP_TICKS {
        if let Some((second, delay)) = second {
            if tick == 0 {
                let crc32 = frixel_wire::frame::crc32(second);
                script.send(Command::UploadScene { len: second.len() as u32, crc32 });
                for (number, chunk) in second.chunks(CHUNK_LEN).enumerate() {
                    let mut frame = [0; FRAME_MAX_LEN];
                    script.rig.send(payload::chunk_frame(number as u16, chunk, &mut frame).unwrap());
                }
                script.send(Command::UploadEnd);
                commit = Some(Command::Commit { crc32 });
            }
            if tick == 1_000 + delay {
                script.send(commit.unwrap());
            }
        }
        if tick.is_multiple_of(1_500) {
            script.send(Command::Ping);
        }
        records.push(script.step());
    }
    records
}

fn swap(before: &[u8], after: &[u8], delay: usize) -> Swap {
    let swapped = run(before, Some((after, delay)));
    let orders = swapped[0].status.orders_applied;
    let swap = swapped.iter().position(|record| record.status.orders_applied != orders).unwrap();
    Swap { swap, before: run(before, None), after: run(after, None), swapped }
}

fn commanded_bits(records: &[RigTick<Status>]) -> Vec<u32> {
    records.iter().map(|record| record.status.telemetry.commanded_electric_friction_n.to_bits()).collect()
}

fn amplitudes(records: &[RigTick<Status>]) -> Vec<u16> {
    records.iter().map(amplitude).collect()
}

/// Carrier edges keep their spacing, too.
#[test]
fn a_scene_takes_anothers_place_between_two_ticks() {
    let before = scene(&HEADER, &[constant(0.004), stripes(0.012, 450.0)]);
    let after = scene(&HEADER, &[constant(0.015), stripes(0.007, 130.0)]);
    // Every phase of the touch source: the tick of the swap may take a report, too.
    for delay in 0..5 {
        let Swap { swap, before, after, swapped } = swap(&before, &after, delay);
        // The commit advances by a step a tick: 75 to 80 for these scenes.
        assert!((1_000..1_085).contains(&swap), "{swap}");
        assert_eq!(commanded_bits(&swapped[..swap]), commanded_bits(&before[..swap]), "delay {delay}");
        assert_eq!(amplitudes(&swapped[..swap]), amplitudes(&before[..swap]), "delay {delay}");
        let commanded_n = |record: &RigTick<Status>| record.status.telemetry.commanded_electric_friction_n;
        for tick in swap..SWAP_TICKS {
            let (found_n, expected_n) = (commanded_n(&swapped[tick]), commanded_n(&after[tick]));
            // A tick applies one order: the tick that swaps the scene may apply a new track one tick late.
            let tolerance_n = if tick == swap { 1e-6 } else { 0.0 };
            assert!((found_n - expected_n).abs() <= tolerance_n, "{delay}, {tick}: {found_n} N is not {expected_n} N");
            let (found, expected) = (amplitude(&swapped[tick]), amplitude(&after[tick]));
            assert!(found.abs_diff(expected) < 40, "{delay}, {tick}: code {found} is not {expected}");
            if tick < swap + 4 {
                assert!((found_n - commanded_n(&before[tick])).abs() > 5e-4, "the two differ");
                assert!(found.abs_diff(amplitude(&before[tick])) > 400, "the two differ");
            }
        }
        assert!(swapped.iter().all(|record| record.status.telemetry.dac_code != 0), "delay {delay}: never zero");
        let signs: Vec<bool> = swapped.iter().map(|record| record.status.telemetry.dac_code > 0).collect();
        let edges: Vec<usize> = (1..signs.len()).filter(|tick| signs[*tick] != signs[tick - 1]).collect();
        assert!(edges.windows(2).all(|pair| pair[1] - pair[0] == 20), "delay {delay}: {edges:?}");
    }
}

/// The world's finger is the committed scene's, even once the next upload has begun: it waits for the commit.
#[test]
fn a_commit_and_the_next_upload_in_one_tick_leave_no_old_finger() {
    let config = RigConfig { baud: 20_000_000, ..config() };
    let mut script = Script::new(&config, slide(), 1);
    script.play(&scene(&HEADER, &[constant(0.01)]));
    let heavy = Header { normal_load_n: 1.0, ..HEADER };
    let commit = script.upload(&scene(&heavy, &[constant(0.01)]));
    script.send(commit);
    script.send(Command::UploadScene { len: 112, crc32: 1 });
    script.step();
    assert_eq!(script.rig.line_to_board_mut().queued(), 0, "both came in one tick");
    for _ in 0..400 {
        script.step();
    }
    assert_eq!(script.rig.scene(), Some(&heavy));
    let felt_n = script.step().felt.friction_n;
    assert!((felt_n - 0.51).abs() < 1e-3, "{felt_n} N");
}
