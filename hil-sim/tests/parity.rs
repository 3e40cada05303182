//! The emulated boards match the in-process board bit for bit: drives, and bytes on the serial line.
#![cfg(unix)]
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail")]
#![allow(clippy::disallowed_types, clippy::disallowed_methods, reason = "the test runs an emulator")]

use std::iter;

use crate::emulator;
use crate::script;

use frixel_control::Board;
use frixel_exchange::BOARD;
use frixel_hil_sim::emulated::{ReplayError, replay};
use frixel_hil_sim::{Journal, NoiseConfig, Point, RigConfig, Stroke, WorldFault};
use frixel_layers::{
    Bitmap, Blend, Constant, Grating, Header, Layer, Point as Corner, Record, Region, Stream, Wave, Waveform,
};
use frixel_testkit::empirical_header;
use frixel_testkit::samples::{POINTS, sample_records, with_bitmap_crc32};
use frixel_wire::fault::State;
use frixel_wire::message::Command;
use script::{HEADER, Script, constant, record, samples, scene, scene_with_points};

const TICKS: u64 = 110_000;

/// The journal of a board from power-on, with the actions of `play`.
fn journal(board: Board, stroke: Stroke, seed: u64, play: impl FnOnce(&mut Script)) -> Journal {
    let mut script = Script::new(&RigConfig { board, ..RigConfig::default() }, stroke, seed);
    script.rig.start_journal();
    play(&mut script);
    let journal = script.rig.take_journal().unwrap();
    let driven = journal.iter().filter(|(_, output)| output.drive.dac_code.bits() != 0).count();
    assert!(driven > journal.len() / 2, "the board drove at {driven} of {} ticks", journal.len());
    journal
}

/// Asserts that a Cortex-M4F and a Cortex-M33 give the outputs of the journal.
fn assert_same(journal: &Journal) {
    assert!(journal.len() as u64 >= TICKS);
    for image in emulator::lockstep_images() {
        if let Err(error) = replay(&image, journal) {
            panic!("{image:?}: {error}");
        }
    }
}

/// Sine stripes in a region on a constant, under a stroke like a person's.
fn stripes(board: Board) -> Journal {
    let stroke = Stroke::sweep(0.12, 0.08, 3.0).unwrap();
    journal(board, stroke, 1, |script| {
        let stripes = Record {
            region: Region::Rectangle { x_m: 0.02, y_m: 0.0, width_m: 0.08, height_m: 0.08 },
            blend: Blend::Add,
            gain: 1.5,
            layer: Layer::Grating(Grating {
                wave: Wave::Sine,
                cycles_per_m_x: 450.0,
                cycles_per_m_y: 130.0,
                phase_turns: 0.3,
                trough_n: 0.001,
                crest_n: 0.014,
                drift_hz: 0.0,
            }),
        };
        // No hello, whose bytes would tell of a changed limit before any drive does.
        script.play(&scene(&HEADER, &[constant(0.004), stripes]));
        script.run(TICKS);
    })
}

#[test]
fn stripes_are_the_same() {
    assert_same(&stripes(BOARD));
}

#[test]
fn a_picture_on_a_sine_carrier_is_the_same() {
    let stroke = Stroke::minimum_jerk(Point { x_m: 0.0, y_m: 0.01 }, Point { x_m: 0.1, y_m: 0.07 }, 0.8).unwrap();
    let journal = journal(BOARD, stroke.looped(0.05).unwrap(), 2, |script| {
        script.hello();
        let picture = samples(200 * 150, 7);
        let crc32 = script.upload_bitmap(200, 150, &picture);
        let layer = Layer::Bitmap(Bitmap {
            crc32,
            x_m: 0.01,
            y_m: 0.0,
            pitch_m: 4e-4,
            black_n: 0.0005,
            white_n: 0.03,
            pitch_y_m: 4e-4,
            angle_turns: 0.0,
            tiled: false,
        });
        let header = Header { waveform: Waveform::Sine, slew_v_per_s: 3e5, ..HEADER };
        script.play(&scene(&header, &[record(layer)]));
        script.run(TICKS);
    });
    assert_same(&journal);
}

/// Everything at once: every kind of layer, some changed while they play, no prediction, telemetry, a bad line, a fault
/// and its end, a second scene.
#[test]
fn a_bad_day_is_the_same() {
    let path = Stroke::constant_speed(Point { x_m: 0.01, y_m: 0.02 }, Point { x_m: 0.11, y_m: 0.06 }, 0.12).unwrap();
    let journal = journal(BOARD, path.looped(0.02).unwrap(), 3, |script| {
        script.hello();
        let picture = samples(64 * 64, 9);
        let crc32 = script.upload_bitmap(64, 64, &picture);
        let layers = [
            Layer::Constant(Constant { electric_friction_n: 0.002 }),
            Layer::Grating(Grating {
                wave: Wave::Square { duty: 0.5 },
                cycles_per_m_x: 90.0,
                cycles_per_m_y: -250.0,
                phase_turns: -3.2,
                trough_n: 0.0,
                crest_n: 0.006,
                drift_hz: 0.0,
            }),
            Layer::Bitmap(Bitmap {
                crc32,
                x_m: 0.02,
                y_m: 0.01,
                pitch_m: 1e-3,
                black_n: 0.004,
                white_n: -0.002,
                pitch_y_m: 1e-3,
                angle_turns: 0.0,
                tiled: false,
            }),
            Layer::Grating(Grating {
                wave: Wave::Sine,
                cycles_per_m_x: 1000.0,
                cycles_per_m_y: 0.0,
                phase_turns: 0.0,
                trough_n: 0.0,
                crest_n: 0.02,
                drift_hz: 0.0,
            }),
            Layer::Stream(Stream { low_n: -0.002, high_n: 0.008 }),
        ];
        // From left to right, so that not too many are under the finger at once: the stream takes time everywhere.
        let band = |x_m, width_m| Region::Rectangle { x_m, y_m: 0.0, width_m, height_m: 0.08 };
        let regions =
            [band(0.0, 0.0745), band(0.002, 0.018), band(0.0755, 0.0445), band(0.0235, 0.0125), band(0.05, 0.024)];
        let records: Vec<Record> = layers
            .into_iter()
            .zip(regions)
            .map(|(layer, region)| Record { region, blend: Blend::Add, ..record(layer) })
            .collect();
        let header = Header { prediction: false, carrier_hz: 700.0, normal_load_n: 0.0, ..HEADER };
        script.play(&scene(&header, &records));
        script.command(Command::Subscribe { period_ticks: 400 });
        script.noise.set(NoiseConfig { bit_error_rate: 0.05, ..NoiseConfig::default() }).unwrap();
        script.command(Command::Subscribe { period_ticks: 800 });
        script.noise.set(NoiseConfig::default()).unwrap();
        script.command(Command::StartStream { sample_hz: 4_000, start_level: 100 });
        for frame in [0, 1, 3, 2, 3, 6] {
            script.samples(90 * frame, &[7_000, 60_000, 30_000].repeat(30));
        }
        script.run(10_000);
        assert_eq!((script.status().counters.stream_underruns, script.status().counters.stream_gaps), (1, 1));
        script.command(Command::SetLayer { layer: 1, on: false, gain: 1.0 });
        script.command(Command::SetLayer { layer: 3, on: true, gain: -0.3 });
        script.run(20_000);
        let now = script.rig.tick();
        script.rig.world_mut().schedule_fault(now..now + 3, WorldFault::AmplifierNotReady).unwrap();
        script.run(5_000);
        assert_eq!(script.status().telemetry.state, State::Faulted);
        script.command(Command::ClearFault);
        // Within the credit: what is beyond it would be lost, and the client with it.
        script.rig.send(&samples(500, 4));
        script.run(1_000);
        script.play(&scene(&HEADER, &records));
        script.run(TICKS);
    });
    assert_same(&journal);
}

/// One layer of each kind, each region and each blend, under a finger that crosses them.
#[test]
fn every_kind_of_layer_is_the_same() {
    let path = Stroke::minimum_jerk(Point { x_m: 0.005, y_m: 0.02 }, Point { x_m: 0.115, y_m: 0.06 }, 0.9).unwrap();
    let journal = journal(BOARD, path.looped(0.02).unwrap(), 4, |script| {
        script.hello();
        let picture = samples(40 * 30, 11);
        let crc32 = script.upload_bitmap(40, 30, &picture);
        let (records, points) = every_kind(crc32);
        // One after another on the first: all of them at once are refused, for what a tick would take.
        for record in &records[1..] {
            script.play(&scene_with_points(&HEADER, &[records[0], *record], &points));
            script.run(TICKS / 13);
        }
    });
    assert_same(&journal);
}

/// A ground, and the samples of all kinds with each region and each blend.
fn every_kind(crc32: u32) -> (Vec<Record>, Vec<Corner>) {
    let rectangle = Region::Rectangle { x_m: 0.03, y_m: 0.025, width_m: 0.03, height_m: 0.03 };
    let ellipse = Region::Ellipse { x_m: 0.06, y_m: 0.02, width_m: 0.05, height_m: 0.05 };
    // After the points of the samples.
    let polygon = Region::Polygon { first: POINTS.len() as u8, count: 5 };
    let corners = [(0.01, 0.01), (0.11, 0.015), (0.06, 0.04), (0.1, 0.07), (0.02, 0.06)];
    let points = POINTS.into_iter().chain(corners.map(|(x, y)| Corner { x, y })).collect();
    let regions = [Region::Screen, polygon, rectangle, ellipse];
    let blends = [Blend::Add, Blend::Max, Blend::Add, Blend::Multiply, Blend::Replace];
    let layers = sample_records().zip(regions.into_iter().cycle()).zip(blends.into_iter().cycle());
    let records = layers.map(|((sample, region), blend)| {
        let Record { layer, gain, .. } = sample.record;
        let region = if matches!(layer, Layer::Button(_)) { ellipse } else { region };
        let blend = if matches!(layer, Layer::Speed(_)) { Blend::Multiply } else { blend };
        Record { region, blend, gain, layer: with_bitmap_crc32(layer, crc32) }
    });
    (iter::once(constant(0.003)).chain(records).collect(), points)
}

/// The board computes the table of an empirical law of 16 points in `f32` pairs, as the in-process board does.
#[test]
fn the_law_of_a_finger_is_the_same() {
    let path = Stroke::minimum_jerk(Point { x_m: 0.005, y_m: 0.02 }, Point { x_m: 0.115, y_m: 0.06 }, 0.9).unwrap();
    let journal = journal(BOARD, path.looped(0.02).unwrap(), 5, |script| {
        script.hello();
        for (waveform, voltage_max_v_rms) in [(Waveform::Square, 150.0), (Waveform::Sine, 97.0)] {
            let header = Header { waveform, voltage_max_v_rms, ..empirical_header() };
            // From rows far below the least bend up to the largest friction.
            let stripes = |trough_n, crest_n| {
                Layer::Grating(Grating {
                    wave: Wave::Saw,
                    cycles_per_m_x: 60.0,
                    cycles_per_m_y: 20.0,
                    phase_turns: 0.0,
                    trough_n,
                    crest_n,
                    drift_hz: 0.0,
                })
            };
            for (trough_n, crest_n) in [(0.0, 2e-4), (1e-4, 0.03), (0.02, 0.1)] {
                script.play(&scene(&header, &[record(stripes(trough_n, crest_n))]));
                script.run(TICKS / 5);
            }
        }
    });
    assert_same(&journal);
}

#[test]
fn one_changed_constant_is_seen() {
    let mut board = BOARD;
    board.limits.edge_time_constant_s *= 1.0 + 1e-4;
    let journal = stripes(board);
    for image in emulator::lockstep_images() {
        match replay(&image, &journal) {
            Err(ReplayError::Mismatch(mismatch)) => {
                assert_eq!(mismatch.expected.tick, mismatch.found.tick);
                assert_ne!(mismatch.expected.drive, mismatch.found.drive);
            }
            other => panic!("{image:?}: a changed edge time constant was not seen: {other:?}"),
        }
    }
}
