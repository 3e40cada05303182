//! Tests of the changes that a host may make while a scene plays, and of the refusals of all others.

use crate::support::{HEADER, TestBoard, constant, constant_scene, scene};
use frixel_control::{Board, Drive};
use frixel_layers::{Blend, Header, Leader, Record};
use frixel_wire::fault::{Fault, Flags, State};
use frixel_wire::message::{Accepted, Command, ConfigField, Refusal};

const HALF: Command = Command::SetLayer { layer: 0, on: true, gain: 0.5 };

#[test]
fn a_layer_is_changed_only_while_it_plays() {
    let mut board = TestBoard::connected();
    assert_eq!(board.command(HALF), Err(Refusal::WrongState(State::Disarmed)));
    board.load(&constant_scene(0.01)).unwrap();
    board.command(Command::Arm).unwrap();
    assert_eq!(board.command(HALF), Err(Refusal::WrongState(State::Armed)));
    board.command(Command::Play).unwrap();
    assert_eq!(board.command(HALF), Ok(Accepted::Done));
    board.sense.amplifier_fault = true;
    board.ticks(2);
    assert_eq!(board.command(HALF), Err(Refusal::Faulted(Fault::Amplifier)));
}

#[test]
fn a_missing_layer_and_a_gain_out_of_range_are_refused_by_number() {
    let mut board = TestBoard::new();
    let layer = constant(0.01);
    let both = scene(&HEADER, &[layer, Record { blend: Blend::Add, ..layer }]);
    board.play(&both);
    board.slide(1_000);
    for layer in [2, 63, 64, 255] {
        let refused = board.command(Command::SetLayer { layer, on: false, gain: 1.0 });
        assert_eq!(refused, Err(Refusal::NoSuchLayer { layer, layers: 2 }));
    }
    for gain in [100.1, -100.1, f32::INFINITY, f32::NAN] {
        let Err(Refusal::Config(refusal)) = board.command(Command::SetLayer { layer: 1, on: true, gain }) else {
            panic!("{gain} was taken")
        };
        assert_eq!((refusal.field, refusal.min, refusal.max), (ConfigField::Gain, -100.0, 100.0));
        assert_eq!((refusal.found.to_bits(), refusal.layer), (gain.to_bits(), 1));
    }
    board.slide(100);
    let commanded_n = board.status().telemetry.commanded_electric_friction_n;
    assert!((commanded_n - 0.02).abs() < 1e-7, "what was refused changed nothing: {commanded_n}");
    board.command(Command::SetLayer { layer: 0, on: false, gain: 1.0 }).unwrap();
    board.command(Command::SetLayer { layer: 1, on: true, gain: 0.3 }).unwrap();
    board.slide(100);
    let commanded_n = board.status().telemetry.commanded_electric_friction_n;
    assert!((commanded_n - 0.003).abs() < 1e-7, "{commanded_n}");
    board.load(&both).unwrap();
    board.slide(100);
    let commanded_n = board.status().telemetry.commanded_electric_friction_n;
    assert!((commanded_n - 0.02).abs() < 1e-7, "a commit gives each layer what its record says: {commanded_n}");
}

#[test]
fn layer_numbers_refer_to_the_committed_scene() {
    let mut board = TestBoard::new();
    board.play(&constant_scene(0.01));
    let layer = constant(0.002);
    board.upload_scene(&scene(&HEADER, &[layer, layer, layer])).unwrap();
    let last = Command::SetLayer { layer: 2, on: true, gain: 1.0 };
    assert_eq!(board.command(last), Err(Refusal::NoSuchLayer { layer: 2, layers: 1 }), "uploaded, not committed");
    board.load(&scene(&HEADER, &[layer, layer, layer])).unwrap();
    assert_eq!(board.command(last), Ok(Accepted::Done));
    // A new upload overwrites the bytes of the committed scene, which still plays.
    board.command(Command::UploadScene { len: 112, crc32: 7 }).unwrap();
    assert_eq!(board.command(last), Ok(Accepted::Done));
    assert_eq!(board.session.scene_header(), Some(&HEADER));
}

#[test]
fn a_scene_with_fixed_layers_refuses_changes() {
    let mut board = TestBoard::new();
    board.play(&scene(&Header { layers_fixed: true, ..HEADER }, &[constant(0.01)]));
    assert_eq!(board.command(HALF), Err(Refusal::LayersFixed));
    board.load(&constant_scene(0.01)).unwrap();
    assert_eq!(board.command(HALF), Ok(Accepted::Done));
}

#[cfg(feature = "stream")]
mod streams {
    use super::*;
    use frixel_wire::hello::feature;

    #[test]
    fn a_board_without_a_stream_buffer_refuses_streams() {
        let mut board = TestBoard::without_stream(Board::SIMULATOR);
        assert_eq!(board.hello().features & feature::STREAM, 0);
        board.play(&constant_scene(0.01));
        for command in [Command::StartStream { sample_hz: 1_000, start_level: 1 }, Command::EndStream] {
            assert_eq!(board.command(command), Err(Refusal::UnknownCommand));
        }
    }

    #[test]
    fn a_scene_without_a_stream_layer_refuses_streams() {
        let mut board = TestBoard::new();
        assert_ne!(board.hello().features & feature::STREAM, 0);
        let start = Command::StartStream { sample_hz: 1_000, start_level: 1 };
        assert_eq!(board.command(start), Err(Refusal::WrongState(State::Disarmed)));
        board.play(&constant_scene(0.01));
        assert_eq!(board.command(start), Err(Refusal::NoStreamLayer));
        assert_eq!(board.command(Command::EndStream), Ok(Accepted::Done), "there is none to end");
    }
}

/// The host's touchscreen reports two fingers at a time; the committed scene determines which one is followed.
#[test]
fn the_scene_selects_which_of_two_fingers_is_followed() {
    for (leader, second_leads) in [(Leader::First, false), (Leader::Latest, true)] {
        let board = Board { touch_from_host: true, ..Board::SIMULATOR };
        let mut board = TestBoard::of(board);
        board.play(&scene(&Header { leader, ..HEADER }, &[constant(0.01)]));
        for (finger, y_m) in [(4, 0.01), (9, 0.05)] {
            board.command(Command::TouchFinger { finger, x_m: 0.02, y_m, age_ticks: 0 }).unwrap();
            board.ticks(10);
        }
        let followed_m = if second_leads { 0.05 } else { 0.01 };
        let found_m = board.status().telemetry.finger_y_m;
        assert!((found_m - followed_m).abs() < 1e-4, "{leader:?}: {found_m}");
        board.command(Command::LiftFinger { finger: if second_leads { 9 } else { 4 } }).unwrap();
        assert_eq!(board.tick(), Drive::default());
        assert!(board.status().telemetry.flags.contains(Flags::NO_FINGER));
    }
}
