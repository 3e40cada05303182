//! A finger's empirical law is played as it is stated, and refused where it is none.
#![cfg(feature = "empirical")]
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "helpers of tests fail as tests do")]

use crate::support;

use frixel_layers::{FingerLaw, Header, LawPoint};
use frixel_model::InverseTable;
use frixel_testkit::constant as constant_of;
use frixel_wire::hello::feature;
use frixel_wire::message::{ConfigField, Refusal};
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

#[test]
fn a_law_is_played_as_it_is_stated() {
    for voltage_max_v_rms in [150.0, 120.0] {
        let header = Header { voltage_max_v_rms, ..header(2.0, &POINTS) };
        let law = header.law.unwrap().up_to(voltage_max_v_rms).unwrap();
        for friction_n in [1e-4_f32, 2e-3, 0.011, 0.03, 0.05] {
            let mut board = TestBoard::new();
            assert!(board.hello().features & feature::EMPIRICAL != 0);
            board.play(&scene(&header, &[constant_of(friction_n)]));
            board.slide(4000);
            let voltage_v_rms = f64::from(board.status().telemetry.voltage_v_rms);
            let found_n = law.electric_friction_n(voltage_v_rms);
            let error = (found_n / f64::from(friction_n) - 1.0).abs();
            assert!(error < f64::from(InverseTable::RELATIVE_ERROR), "{friction_n} N: {voltage_v_rms} V, {error:e}");
        }
    }
}

#[test]
fn what_is_no_law_is_refused() {
    let refused = |header: &Header| {
        let mut board = TestBoard::new();
        board.hello();
        board.load(&scene(header, &[constant_of(0.01)])).err()
    };
    assert_eq!(refused(&header(2.0, &POINTS)), None);
    let field = |header: &Header| match refused(header) {
        Some(Refusal::Config(refusal)) => (refusal.field, refusal.found, refusal.min, refusal.max),
        other => panic!("{other:?}"),
    };
    // Never above the highest voltage that was measured.
    let beyond = Header { voltage_max_v_rms: 150.1, ..header(2.0, &POINTS) };
    assert_eq!(field(&beyond), (ConfigField::VoltageRms, 150.1, 1.0, 150.0));
    assert_eq!(field(&header(0.4, &POINTS)), (ConfigField::LawExponent, 0.4, 0.5, 12.0));
    let falling = header(2.0, &[(50.0, 0.03), (150.0, 0.02)]);
    assert_eq!(field(&falling), (ConfigField::LawPoint, 150.0, 50.0, f32::INFINITY));
    let equal = header(2.0, &[(50.0, 0.03), (150.0, 0.06), (150.0, 0.07)]);
    assert_eq!(field(&equal).0, ConfigField::LawPoint);
    let steep = header(2.0, &[(50.0, 0.001), (55.0, 0.03), (150.0, 0.06)]);
    let (of, found, ..) = field(&steep);
    assert!(of == ConfigField::LawExponent && found > 12.0);
    // The fields of the contact model are zero.
    let both = Header { effective_gap_m: 1e-5, ..header(2.0, &POINTS) };
    assert_eq!(refused(&both), None, "the bytes have no gap");
    let mut bytes = scene(&header(2.0, &POINTS), &[]);
    for (count, len) in [(0, 56), (17, 56 + 17 * 8)] {
        bytes[16] = count;
        bytes.resize(len, 0);
        let mut board = TestBoard::new();
        board.hello();
        let points = SceneError::Points { record: SceneError::HEADER, first: 0, count };
        assert_eq!(board.load(&bytes).err(), Some(Refusal::Scene(points)));
    }
}
