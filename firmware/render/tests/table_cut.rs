//! A table that is cut to what a scene can ask for plays the scene as the whole table does.
#![cfg(all(
    feature = "grating",
    feature = "bitmap",
    feature = "noise",
    feature = "edge",
    feature = "vibration",
    feature = "speed",
    feature = "stream",
    feature = "polygon",
    feature = "sine-carrier"
))]
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "helpers of tests fail as tests do")]

mod support;

use frixel_random_scenes::{Pace, RandomFinger, RandomScene, Report};
use frixel_render::{Active, Board, TableRows, Touch};
use frixel_wire::fault::Flags;
use frixel_wire::frame::FRAME_MAX_LEN;
use frixel_wire::message::{Command, Refusal};
use frixel_wire::payload::samples_frame;
use frixel_wire::scene::{Blend, Click, Header, Layer, Record, Region, Scene, bitmap_crc32};
use proptest::prelude::*;
use support::{Desk, HEADER, Memory, record, scene, scene_with_points};

const SAMPLES: [u8; 6] = [0, 255, 100, 150, 200, 250];
const TICKS: u32 = 3_000;
const STREAM_HZ: u32 = 10_000;

fn rows(scene: &[u8]) -> TableRows {
    Active::table_rows(&Scene::parse(scene).unwrap(), &Board::SIMULATOR).unwrap()
}

/// What a board made of a scene at one tick.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Played {
    asked_bits: u32,
    dac_code: i16,
    flags: Flags,
}

/// Plays a scene under the finger of a seed, with a stream if it has a layer for one.
fn played(header: &Header, random: &RandomScene, seed: u64) -> Vec<Played> {
    let mut memory = Memory::new();
    let mut desk = Desk::new(&mut memory);
    desk.greet();
    desk.upload_bitmap(3, 2, &SAMPLES).unwrap();
    desk.load(&scene_with_points(header, &random.records, &random.points)).unwrap();
    desk.command(Command::Arm).unwrap();
    desk.command(Command::Play).unwrap();
    let _ = desk.command(Command::StartStream { sample_hz: STREAM_HZ, start_level: 20 });
    let pace = if seed.is_multiple_of(4) { Pace::Hasty } else { Pace::Usual };
    let mut finger = RandomFinger::new(seed, header, pace);
    (0..TICKS)
        .map(|tick| {
            if tick.is_multiple_of(200) {
                let samples: [u16; 50] = std::array::from_fn(|at| if at % 3 == 0 { u16::MAX } else { 977 * at as u16 });
                let mut frame = [0; FRAME_MAX_LEN];
                let frame = samples_frame(tick / 4, &samples, &mut frame).unwrap().to_vec();
                desk.send(&frame);
                desk.command(Command::Ping).unwrap();
            }
            desk.touch = finger.tick().map(|report| match report {
                Report::Down { x_m, y_m, age_ticks } => Touch::Down { x_m, y_m, age_ticks },
                Report::Up => Touch::Up,
            });
            let dac_code = desk.tick().dac_code;
            let telemetry = desk.status().telemetry;
            Played { asked_bits: telemetry.asked_electric_friction_n.to_bits(), dac_code, flags: telemetry.flags }
        })
        .collect()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 128, ..ProptestConfig::default() })]

    /// The same codes and flags at every tick, so that no tick asks for more than the cut table has: it would be flagged.
    #[test]
    fn no_tick_sees_the_cut(seed in any::<u64>()) {
        let random = RandomScene::new(seed, bitmap_crc32(3, 2, &SAMPLES));
        let [cut, whole] = [true, false].map(|layers_fixed| {
            played(&Header { layers_fixed, ..random.header }, &random, seed)
        });
        for (tick, (cut, whole)) in cut.iter().zip(&whole).enumerate() {
            prop_assert_eq!(cut, whole, "tick {} of scene {}", tick, seed);
        }
    }
}

/// So that the test above has something to see.
#[test]
fn many_random_scenes_have_a_table_that_is_cut_and_drive() {
    let crc32 = bitmap_crc32(3, 2, &SAMPLES);
    let scenes: Vec<(u64, RandomScene)> = (0..400).map(|seed| (seed, RandomScene::new(seed, crc32))).collect();
    let cut: Vec<&(u64, RandomScene)> = scenes
        .iter()
        .filter(|(_, random)| {
            let header = Header { layers_fixed: true, ..random.header };
            let TableRows { filled, whole } = rows(&scene_with_points(&header, &random.records, &random.points));
            filled < whole
        })
        .collect();
    assert!(cut.len() > 40, "{}", cut.len());
    let driven = cut.iter().filter(|(seed, random)| {
        let header = Header { layers_fixed: true, ..random.header };
        played(&header, random, *seed).iter().any(|played| played.dac_code != 0)
    });
    let driven = driven.count();
    println!("{} of {} cut, {driven} of them drive", cut.len(), scenes.len());
    assert!(driven > 40);
}

const fn constant(electric_friction_n: f32) -> Record {
    Record { region: Region::Screen, blend: Blend::Replace, gain: 1.0, layer: Layer::Constant { electric_friction_n } }
}

#[test]
fn a_table_goes_as_far_as_the_scene() {
    let fixed = Header { layers_fixed: true, ..HEADER };
    let of = |header: &Header, records: &[Record]| rows(&scene(header, records));
    let whole = of(&HEADER, &[constant(0.001)]);
    assert_eq!(whole.filled, whole.whole, "a layer may be changed");
    assert_eq!(of(&fixed, &[constant(0.1)]), whole, "out of reach");
    // Four rows an octave.
    let asks = |records: &[Record]| of(&fixed, records).filled;
    assert_eq!(asks(&[constant(0.02)]), asks(&[constant(0.01)]) + 4);
    assert_eq!(asks(&[]), 1);
    assert_eq!(asks(&[constant(-0.02)]), 1);

    let over = |blend, gain, friction_n| Record { blend, gain, ..constant(friction_n) };
    for (above, sum_n) in [
        (over(Blend::Replace, 1.0, 0.004), 0.004),
        (over(Blend::Add, 1.0, 0.006), 0.016),
        (over(Blend::Add, -1.0, 0.006), 0.004),
        (over(Blend::Multiply, 0.5, 0.5), 0.0025),
        (over(Blend::Max, 2.0, 0.01), 0.02),
        (over(Blend::Max, 1.0, 0.001), 0.01),
    ] {
        assert_eq!(asks(&[constant(0.01), above]), asks(&[constant(sum_n)]), "{above:?}");
        let part = Record { region: Region::Rectangle { x_m: 0.0, y_m: 0.0, width_m: 0.01, height_m: 0.01 }, ..above };
        assert_eq!(
            asks(&[constant(0.01), part]),
            asks(&[constant(sum_n.max(0.01))]),
            "in a part of the screen: {above:?}"
        );
    }
    // What is added side by side is no sum.
    let beside = |x_m| Record {
        region: Region::Rectangle { x_m, y_m: 0.0, width_m: 0.01, height_m: 0.1 },
        ..over(Blend::Add, 1.0, 0.006)
    };
    assert_eq!(asks(&[beside(0.01), beside(0.03), beside(0.05)]), asks(&[constant(0.006)]));
    // An ellipse in a screen leaves its corners.
    let ellipse =
        Region::Ellipse { x_m: 0.0, y_m: 0.0, width_m: HEADER.screen_width_m, height_m: HEADER.screen_height_m };
    let smooth = Record { region: ellipse, ..constant(0.002) };
    assert_eq!(asks(&[constant(0.01), smooth]), asks(&[constant(0.01)]));
    // A click comes on top.
    let click = Click { height_n: 0.004, decay_s: 0.02 };
    let edge =
        Layer::Edge { x_m: 0.05, y_m: 0.05, angle_turns: 0.0, width_m: 0.01, level_n: 0.0, ridge_n: 0.006, click };
    assert_eq!(asks(&[record(edge)]), asks(&[constant(0.01)]));
    let button = Layer::Button { rim_width_m: 1e-3, rim_n: 0.006, face_n: 0.001, click };
    assert_eq!(asks(&[Record { region: ellipse, ..record(button) }]), asks(&[constant(0.01)]));
    // A stream asks for no more than its two numbers say, and may not be there.
    let stream = record(Layer::Stream { low_n: 0.002, high_n: 0.006 });
    assert_eq!(asks(&[constant(0.003), stream]), asks(&[constant(0.006)]));
    assert_eq!(asks(&[constant(0.01), stream]), asks(&[constant(0.01)]));
}

#[test]
fn a_scene_that_says_that_its_layers_stay_refuses_to_change_them() {
    let mut memory = Memory::new();
    let mut desk = Desk::new(&mut memory);
    desk.play(&scene(&Header { layers_fixed: true, ..HEADER }, &[constant(0.01)]));
    let change = Command::SetLayer { layer: 0, on: true, gain: 2.0 };
    assert_eq!(desk.command(change), Err(Refusal::LayersFixed));
    desk.load(&scene(&HEADER, &[constant(0.01)])).unwrap();
    assert!(desk.command(change).is_ok());
}
