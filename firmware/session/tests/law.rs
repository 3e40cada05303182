//! An invalid empirical law of a finger is refused. `frixel-hil-sim` (`rig`) tests that boards play valid ones.
#![cfg(feature = "empirical")]

use crate::support::{HEADER, TestBoard, scene};
use frixel_control::Board;
use frixel_layers::{FingerLaw, Header, LawPoint};
use frixel_testkit::constant as constant_of;
use frixel_wire::fault::State;
use frixel_wire::message::{ConfigField, ConfigRefusal, Refusal};
use frixel_wire::scene::SceneError;

const POINTS: [(f32, f32); 3] = [(50.0, 2e-3), (90.0, 0.03), (150.0, 0.09)];

fn header(exponent: f32, points: &[(f32, f32)]) -> Header {
    let points: Vec<LawPoint> = points
        .iter()
        .map(|&(voltage_v_rms, electric_friction_n)| LawPoint { voltage_v_rms, electric_friction_n })
        .collect();
    let law = FingerLaw::new(exponent, &points);
    assert!(law.is_some());
    Header { finger_radius_m: 0.0, stiffness_pa_per_m: 0.0, effective_gap_m: 0.0, law, ..HEADER }
}

/// The refusal of a scene at the commit.
fn refused(scene: &[u8]) -> Option<Refusal> {
    TestBoard::connected().load(scene).err()
}

/// Field, number and range of the refusal of a header. The number is outside of the range.
fn field(header: &Header) -> (ConfigField, f32, f32, f32) {
    match refused(&scene(header, &[constant_of(0.01)])) {
        Some(Refusal::Config(ConfigRefusal { field, found, min, max, .. })) => {
            assert!(!(min..=max).contains(&found), "{field:?}: {found} is in {min} to {max}");
            (field, found, min, max)
        }
        other => panic!("{other:?}"),
    }
}

/// Every reason of `frixel-model` becomes a number of the header and its range.
#[test]
fn what_is_no_law_is_refused() {
    // Never above the highest voltage that was measured.
    let beyond = Header { voltage_max_v_rms: 150.1, ..header(2.0, &POINTS) };
    assert_eq!(field(&beyond), (ConfigField::VoltageRms, 150.1, 1.0, 150.0));
    for exponent in [0.4, 12.1, f32::NAN, f32::INFINITY, -2.0, f32::from_bits(1)] {
        let (of, found, min, max) = field(&header(exponent, &POINTS));
        assert_eq!((of, found.to_bits(), min, max), (ConfigField::LawExponent, exponent.to_bits(), 0.5, 12.0));
    }
    // Voltages, and then frictions, rise from above zero.
    for (points, expected) in [
        ([(50.0, 0.03), (150.0, 0.03)], (ConfigField::LawFriction, 0.03, 0.03)),
        ([(50.0, 0.03), (150.0, f32::NAN)], (ConfigField::LawFriction, f32::NAN, 0.03)),
        ([(50.0, -0.1), (150.0, 0.09)], (ConfigField::LawFriction, -0.1, 0.0)),
        ([(160.0, 0.03), (150.0, 0.02)], (ConfigField::LawPoint, 150.0, 160.0)),
        ([(f32::NAN, 0.03), (150.0, 0.09)], (ConfigField::LawPoint, f32::NAN, 0.0)),
    ] {
        let (of, found, min, max) = field(&header(2.0, &points));
        let (expected_field, expected_found, above): (_, f32, f32) = expected;
        assert_eq!((of, found.to_bits()), (expected_field, expected_found.to_bits()), "{points:?}");
        assert_eq!((min, max), (above.next_up(), f32::MAX), "{points:?}");
    }
    // Nothing lies above a voltage that is not a number or infinite.
    for last_v_rms in [f32::NAN, f32::INFINITY] {
        let (of, found, ..) = field(&header(2.0, &[(50.0, 0.03), (last_v_rms, 0.09)]));
        assert!(matches!(of, ConfigField::VoltageRms | ConfigField::LawPoint), "{of:?} {found}");
    }
    let (of, found, ..) = field(&header(2.0, &[(50.0, 0.001), (55.0, 0.03), (150.0, 0.06)]));
    assert!(of == ConfigField::LawExponent && found > 12.0);
    for friction_n in [1e-7, 1e13] {
        let (of, found, min, max) = field(&header(2.0, &[(150.0, friction_n)]));
        assert_eq!((of, min, max), (ConfigField::LawFriction, 1e-6, 1e12));
        assert!((found / friction_n - 1.0).abs() < 1e-6, "{found:e}");
    }
    // A header has a law or the numbers of the contact model.
    for both in [
        Header { effective_gap_m: 1e-5, ..header(2.0, &POINTS) },
        Header { stiffness_pa_per_m: 1e7, ..header(2.0, &POINTS) },
    ] {
        assert!(both.check(&Board::SIMULATOR.limits, Board::SIMULATOR.tick_hz).is_err());
    }
}

#[test]
fn bytes_that_are_no_law_are_refused() {
    let good = scene(&header(2.0, &POINTS), &[]);
    assert_eq!((good.len(), refused(&good)), (56 + 3 * 8, None));
    for offset in [17, 18, 19, 28, 31] {
        let mut bytes = good.clone();
        bytes[offset] = 1;
        let not_zero = SceneError::NotZero { record: SceneError::HEADER, offset: offset as u8 };
        assert_eq!(refused(&bytes), Some(Refusal::Scene(not_zero)));
    }
    for (count, len) in [(0, 56), (17, 56 + 17 * 8), (255, 56 + 16 * 8)] {
        let mut bytes = good.clone();
        bytes[16] = count;
        bytes.resize(len, 0);
        let points = SceneError::Points { record: SceneError::HEADER, first: 0, count };
        assert_eq!(refused(&bytes), Some(Refusal::Scene(points)));
    }
    let expected = good.len() as u32;
    for found in [expected - 8, expected - 1, expected + 1, expected + 8] {
        let mut bytes = good.clone();
        bytes.resize(found as usize, 0);
        assert_eq!(refused(&bytes), Some(Refusal::Scene(SceneError::Length { found, expected })));
    }
}

#[test]
fn a_refused_law_leaves_the_scene_before_it_playing() {
    let mut board = TestBoard::new();
    board.play(&scene(&HEADER, &[constant_of(0.01)]));
    board.slide(4000);
    let before = board.status().telemetry.voltage_v_rms;
    assert!(before > 0.0);
    assert!(board.load(&scene(&header(2.0, &[(150.0, 1e-9)]), &[constant_of(0.02)])).is_err());
    board.slide(2000);
    assert_eq!(board.status().telemetry.state, State::Active);
    assert_eq!(board.status().telemetry.voltage_v_rms.to_bits(), before.to_bits());
    // A law takes its place while it plays.
    board.load(&scene(&header(2.0, &POINTS), &[constant_of(0.01)])).unwrap();
    board.slide(4000);
    let after = board.status().telemetry.voltage_v_rms;
    assert!(after > 0.0 && after.to_bits() != before.to_bits());
}
