//! A table that ends at the header's largest friction plays the scene like the whole table.
#![cfg(all(feature = "bitmap", feature = "stream", feature = "sine-carrier"))]
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "helpers of tests fail as tests do")]

use crate::support;

use frixel_control::Board;
use frixel_layers::{Header, Scene, electric_friction_max_n};
use frixel_session::{TableRows, table_rows};
use frixel_testkit::{Pace, RandomFinger, RandomScene};
use frixel_wire::fault::Flags;
use frixel_wire::frame::FRAME_MAX_LEN;
use frixel_wire::message::{Command, ConfigField, Refusal};
use frixel_wire::payload::samples_frame;
use frixel_wire::scene::bitmap_crc32;
use proptest::prelude::*;
use support::{HEADER, TestBoard, constant, scene, scene_with_points};

const SAMPLES: [u8; 6] = [0, 255, 100, 150, 200, 250];
const TICKS: u32 = 3_000;
const STREAM_HZ: u32 = 10_000;

fn rows(scene: &[u8]) -> TableRows {
    table_rows(&Scene::parse(scene).unwrap(), &Board::SIMULATOR).unwrap()
}

/// The largest friction in the header of a scene with fixed layers.
fn largest_n(random: &RandomScene) -> Option<f32> {
    electric_friction_max_n(&random.header, &random.records, &random.points)
}

fn cut_header(random: &RandomScene) -> Header {
    Header { electric_friction_max_n: largest_n(random), ..random.header }
}

/// A board's commanded friction, DAC code and flags at one tick.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Played {
    commanded_bits: u32,
    dac_code: i16,
    flags: Flags,
}

/// Plays a scene under the finger of a seed, with a stream if it has a layer for one.
fn played(header: &Header, random: &RandomScene, seed: u64) -> Vec<Played> {
    let mut board = TestBoard::connected();
    board.upload_bitmap(3, 2, &SAMPLES).unwrap();
    board.load(&scene_with_points(header, &random.records, &random.points)).unwrap();
    board.command(Command::Arm).unwrap();
    board.command(Command::Play).unwrap();
    let _ = board.command(Command::StartStream { sample_hz: STREAM_HZ, start_level: 20 });
    let pace = if seed.is_multiple_of(4) { Pace::Fast } else { Pace::Usual };
    let mut finger = RandomFinger::new(seed, header, pace);
    (0..TICKS)
        .map(|tick| {
            if tick.is_multiple_of(200) {
                let samples: [u16; 50] = std::array::from_fn(|at| if at % 3 == 0 { u16::MAX } else { 977 * at as u16 });
                let mut frame = [0; FRAME_MAX_LEN];
                let frame = samples_frame(tick / 4, &samples, &mut frame).unwrap().to_vec();
                board.send(&frame);
                board.command(Command::Ping).unwrap();
            }
            board.touch = finger.tick();
            let dac_code = board.tick().dac_code.bits();
            let telemetry = board.status().telemetry;
            Played {
                commanded_bits: telemetry.commanded_electric_friction_n.to_bits(),
                dac_code,
                flags: telemetry.flags,
            }
        })
        .collect()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 128, ..ProptestConfig::default() })]

    /// Codes and flags are the same at every tick. A tick beyond the end of the truncated table would set a flag.
    #[test]
    fn no_tick_is_affected_by_the_truncation(seed in any::<u64>()) {
        let random = RandomScene::new(seed, bitmap_crc32(3, 2, &SAMPLES));
        let [cut, whole] = [largest_n(&random), None].map(|electric_friction_max_n| {
            played(&Header { electric_friction_max_n, ..random.header }, &random, seed)
        });
        for (tick, (cut, whole)) in cut.iter().zip(&whole).enumerate() {
            prop_assert_eq!(cut, whole, "tick {} of scene {}", tick, seed);
        }
    }
}

/// Ensures that the test above is not vacuous.
#[test]
fn many_random_scenes_drive_with_a_truncated_table() {
    let crc32 = bitmap_crc32(3, 2, &SAMPLES);
    let scenes: Vec<(u64, RandomScene)> = (0..500).map(|seed| (seed, RandomScene::new(seed, crc32))).collect();
    let cut: Vec<&(u64, RandomScene)> = scenes
        .iter()
        .filter(|(_, random)| {
            let TableRows { filled, whole } =
                rows(&scene_with_points(&cut_header(random), &random.records, &random.points));
            filled < whole
        })
        .collect();
    assert!(cut.len() > 40, "{}", cut.len());
    let driven = cut
        .iter()
        .filter(|(seed, random)| played(&cut_header(random), random, *seed).iter().any(|played| played.dac_code != 0));
    let driven = driven.count();
    println!("{} of {} cut, {driven} of them drive", cut.len(), scenes.len());
    assert!(driven > 40);
}

#[test]
fn a_table_ends_at_the_headers_largest_friction() {
    let of = |electric_friction_max_n| rows(&scene(&Header { electric_friction_max_n, ..HEADER }, &[constant(0.001)]));
    let whole = of(None);
    assert_eq!(whole.filled, whole.whole);
    assert_eq!(of(Some(f32::MAX)), whole, "out of reach");
    // Four rows an octave.
    assert_eq!(of(Some(0.02)).filled, of(Some(0.01)).filled + 4);
    assert_eq!(of(Some(0.0)).filled, 1);
}

/// Above the last row of the table, friction is out of reach, and the board counts it as saturated.
#[test]
fn friction_above_the_end_of_the_table_is_counted_as_saturated() {
    for (electric_friction_max_n, saturated) in [(None, false), (Some(0.02), false), (Some(0.005), true)] {
        let mut board = TestBoard::new();
        board.play(&scene(&Header { electric_friction_max_n, ..HEADER }, &[constant(0.02)]));
        board.slide(2_000);
        let counted = board.status().counters.saturated_ticks > 0;
        assert_eq!(counted, saturated, "{electric_friction_max_n:?}");
    }
}

#[test]
fn a_largest_friction_of_nan_is_refused() {
    for electric_friction_max_n in [f32::NAN, f32::INFINITY, -0.01] {
        let header = Header { electric_friction_max_n: Some(electric_friction_max_n), ..HEADER };
        let mut board = TestBoard::connected();
        let refused = board.load(&scene(&header, &[constant(0.01)])).unwrap_err();
        assert!(
            matches!(refused, Refusal::Config(refusal) if refusal.field == ConfigField::ElectricFrictionMax),
            "{refused:?}"
        );
    }
}
