//! A finger's empirical law is played as stated, and an invalid law is refused.
#![cfg(feature = "empirical")]
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "helpers of tests fail as tests do")]
#![allow(clippy::float_cmp, reason = "exact results are compared exactly")]

use crate::support;

use frixel_control::Board;
use frixel_layers::{FingerLaw, Header, LawPoint, Waveform};
use frixel_model::InverseTable;
use frixel_testkit::constant as constant_of;
use frixel_wire::dac_code::DacCode;
use frixel_wire::fault::{Flags, State};
use frixel_wire::hello::feature;
use frixel_wire::message::{Command, ConfigField, ConfigRefusal, Refusal, Telemetry};
use frixel_wire::scene::SceneError;
use support::{HEADER, TestBoard, scene};

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

/// Laws of one, three and sixteen points, up to the largest voltage that the rms limit or the peak limit allows.
#[test]
fn a_law_is_played_as_it_is_stated() {
    let waveforms =
        if cfg!(feature = "sine-carrier") { &[Waveform::Square, Waveform::Sine][..] } else { &[Waveform::Square] };
    let laws =
        [(header(3.0, &[(150.0, 0.09)]), 1), (header(2.0, &POINTS), 3), (frixel_testkit::empirical_header(), 16)];
    for ((law, points), &waveform) in laws.into_iter().flat_map(|law| waveforms.iter().map(move |form| (law, form))) {
        for (voltage_max_v_rms, voltage_max_v_peak) in [(150.0, 220.0), (120.0, 220.0), (150.0, 100.0)] {
            let header = Header { waveform, voltage_max_v_rms, voltage_max_v_peak, ..law };
            let up_to_v_rms = frixel_session::voltage_max_v_rms(&header, &Board::SIMULATOR).unwrap();
            let law = header.law.unwrap().up_to(up_to_v_rms).unwrap();
            let is_in_reach = |friction_n: &f32| f64::from(*friction_n) < law.electric_friction_n(up_to_v_rms.into());
            for friction_n in [1e-4_f32, 2e-3, 0.011, 0.03, 0.05].into_iter().filter(is_in_reach) {
                let bytes = scene(&header, &[constant_of(friction_n)]);
                assert_eq!(bytes.len(), 56 + 56 + 8 * points);
                let mut board = TestBoard::new();
                assert!(board.hello().features & feature::EMPIRICAL != 0);
                board.play(&bytes);
                board.slide(4000);
                let voltage_v_rms = f64::from(board.status().telemetry.voltage_v_rms);
                let error = (law.electric_friction_n(voltage_v_rms) / f64::from(friction_n) - 1.0).abs();
                let context = format!("{points} points, {waveform:?}, {friction_n} N: {voltage_v_rms} V, {error:e}");
                assert!(error < f64::from(InverseTable::RELATIVE_ERROR), "{context}");
            }
        }
    }
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

#[test]
fn invalid_laws_are_refused() {
    assert_eq!(refused(&scene(&header(2.0, &POINTS), &[constant_of(0.01)])), None);
    // The voltage never exceeds the largest measured one.
    let beyond = Header { voltage_max_v_rms: 150.1, ..header(2.0, &POINTS) };
    assert_eq!(field(&beyond), (ConfigField::VoltageRms, 150.1, 1.0, 150.0));
    for exponent in [0.4, 12.1, f32::NAN, f32::INFINITY, -2.0, f32::from_bits(1)] {
        let (of, found, min, max) = field(&header(exponent, &POINTS));
        assert_eq!((of, found.to_bits(), min, max), (ConfigField::LawExponent, exponent.to_bits(), 0.5, 12.0));
    }
    // First voltages, then frictions, must rise from above zero.
    let least = f32::from_bits(1);
    for (points, expected) in [
        ([(50.0, 0.03), (150.0, 0.02)], (ConfigField::LawFriction, 0.02, 0.03)),
        ([(50.0, 0.03), (150.0, 0.03)], (ConfigField::LawFriction, 0.03, 0.03)),
        ([(150.0, 0.03), (150.0, 0.07)], (ConfigField::LawPoint, 150.0, 150.0)),
        ([(160.0, 0.03), (150.0, 0.02)], (ConfigField::LawPoint, 150.0, 160.0)),
        ([(50.0, 0.03), (150.0, f32::NAN)], (ConfigField::LawFriction, f32::NAN, 0.03)),
        ([(50.0, 0.03), (150.0, f32::INFINITY)], (ConfigField::LawFriction, f32::INFINITY, 0.03)),
        ([(f32::NAN, 0.03), (150.0, 0.09)], (ConfigField::LawPoint, f32::NAN, 0.0)),
        ([(0.0, 0.03), (150.0, 0.09)], (ConfigField::LawPoint, 0.0, 0.0)),
        ([(-1.0, 0.03), (150.0, 0.09)], (ConfigField::LawPoint, -1.0, 0.0)),
        ([(50.0, 0.0), (150.0, 0.09)], (ConfigField::LawFriction, 0.0, 0.0)),
        ([(50.0, -least), (150.0, 0.09)], (ConfigField::LawFriction, -least, 0.0)),
    ] {
        let (of, found, min, max) = field(&header(2.0, &points));
        let (expected_field, expected_found, above): (_, f32, f32) = expected;
        assert_eq!((of, found.to_bits()), (expected_field, expected_found.to_bits()), "{points:?}");
        assert_eq!((min, max), (above.next_up(), f32::MAX), "{points:?}");
    }
    // No voltage is above NaN or infinity.
    for last_v_rms in [f32::NAN, f32::INFINITY] {
        let (of, found, ..) = field(&header(2.0, &[(50.0, 0.03), (last_v_rms, 0.09)]));
        assert!(matches!(of, ConfigField::VoltageRms | ConfigField::LawPoint), "{of:?} {found}");
    }
    // From a tiny first point, friction grows with far too small a power.
    let (of, found, ..) = field(&header(2.0, &[(least, least), (150.0, 0.09)]));
    assert!(of == ConfigField::LawExponent && !(0.5..=12.0).contains(&found), "{of:?} {found}");
    let (of, found, ..) = field(&header(2.0, &[(50.0, 0.001), (55.0, 0.03), (150.0, 0.06)]));
    assert!(of == ConfigField::LawExponent && found > 12.0);
    for friction_n in [1e-7, least, 1e13] {
        let (of, found, min, max) = field(&header(2.0, &[(150.0, friction_n)]));
        assert_eq!((of, min, max), (ConfigField::LawFriction, 1e-6, 1e12));
        assert!((found / friction_n - 1.0).abs() < 1e-6, "{found:e}");
    }
    // A header has a law or the numbers of the contact model.
    let limits = Board::SIMULATOR.limits;
    for both in [
        Header { effective_gap_m: 1e-5, ..header(2.0, &POINTS) },
        Header { stiffness_pa_per_m: 1e7, ..header(2.0, &POINTS) },
    ] {
        assert!(both.check(&limits, Board::SIMULATOR.tick_hz).is_err());
    }
}

#[test]
fn malformed_laws_are_refused() {
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
    for wrong in [header(0.4, &POINTS), header(2.0, &[(50.0, 0.03), (150.0, 0.02)]), header(2.0, &[(150.0, 1e-9)])] {
        assert!(board.load(&scene(&wrong, &[constant_of(0.02)])).is_err());
        board.slide(2000);
        assert_eq!(board.status().telemetry.state, State::Active);
        assert_eq!(board.status().telemetry.voltage_v_rms.to_bits(), before.to_bits());
    }
    // A law takes its place while it plays.
    board.load(&scene(&header(2.0, &POINTS), &[constant_of(0.01)])).unwrap();
    board.slide(4000);
    let after = board.status().telemetry.voltage_v_rms;
    assert!(after > 0.0 && after.to_bits() != before.to_bits());
}

#[test]
fn a_gain_beyond_the_law_gives_its_largest_voltage() {
    let mut board = TestBoard::new();
    board.play(&scene(&header(2.0, &POINTS), &[constant_of(0.01)]));
    board.slide(4000);
    assert!(!board.status().telemetry.flags.contains(Flags::SATURATED));
    for (gain, voltage_v_rms) in [(9.1, 150.0_f32), (100.0, 150.0), (-100.0, 0.0)] {
        board.command(Command::SetLayer { layer: 0, on: true, gain }).unwrap();
        board.slide(4000);
        let Telemetry { voltage_v_rms: found, flags, .. } = board.status().telemetry;
        assert_eq!(found.to_bits(), voltage_v_rms.to_bits(), "{gain}");
        assert_eq!(flags.contains(Flags::SATURATED), gain != 0.0);
    }
}

/// Friction that rises through the table's least makes the drive step from zero to a part of the largest voltage; when
/// it falls, the drive steps back. Both steps take place at the slew limit, without overshoot.
#[test]
fn the_least_friction_of_a_law_is_a_step_at_the_slew_limit() {
    const SLEW_V_PER_S: f32 = 2e5;
    let step_v = SLEW_V_PER_S * 25e-6;
    for (exponent, part) in [(6.0_f32, 0.162), (12.0, 0.402)] {
        let header = Header { slew_v_per_s: SLEW_V_PER_S, ..header(exponent, &[(150.0, 0.09)]) };
        let least_n = 0.09 * 2.0_f32.powf(-15.75);
        let mut board = TestBoard::new();
        board.play(&scene(&header, &[constant_of(0.97 * least_n)]));
        let below = board.slide(4000);
        assert_eq!(board.status().telemetry.voltage_v_rms.to_bits(), 0);
        assert!(below[3000..].iter().all(|drive| drive.dac_code == DacCode::ZERO));
        for (gain, end_v) in [(1.06, part * 150.0), (1.0, 0.0)] {
            let mut before_v = board.status().telemetry.voltage_v_rms;
            let mut steps = 0;
            board.command(Command::SetLayer { layer: 0, on: true, gain }).unwrap();
            for _ in 0..200 {
                board.slide(1);
                let voltage_v = board.status().telemetry.voltage_v_rms;
                assert!((voltage_v - before_v).abs() <= 1.0001 * step_v, "{before_v} to {voltage_v}");
                assert!((0.0..=1.01 * part * 150.0).contains(&voltage_v), "{voltage_v}");
                steps += u32::from(voltage_v.to_bits() != before_v.to_bits());
                before_v = voltage_v;
            }
            assert!((before_v - end_v).abs() < 0.01 * 150.0, "{exponent}: {before_v} for {end_v}");
            assert_eq!(steps, (part * 150.0 / step_v).ceil() as u32, "{exponent}");
        }
    }
}
