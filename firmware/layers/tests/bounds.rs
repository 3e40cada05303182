//! Scenes without a largest electric friction; `frixel-scene` compares that of others with the reference (`bounds`).
#![allow(clippy::float_cmp, reason = "exact results are compared exactly")]

use frixel_layers::{Blend, Grating, Layer, Record, Wave, electric_friction_max_n};
use frixel_testkit::{HEADER, constant, record};

#[test]
fn a_scene_without_positive_friction_has_the_bound_zero() {
    assert_eq!(electric_friction_max_n(&HEADER, &[], &[]), Some(0.0));
    assert_eq!(electric_friction_max_n(&HEADER, &[constant(-0.02)], &[]), Some(0.0));
}

#[test]
fn unbounded_parameters_give_no_bound() {
    let grating = Grating {
        wave: Wave::Sine,
        cycles_per_m_x: 0.0,
        cycles_per_m_y: 0.0,
        phase_turns: 0.0,
        trough_n: f32::NEG_INFINITY,
        crest_n: f32::INFINITY,
        drift_hz: 0.0,
    };
    let endless = record(Layer::Grating(grating));
    assert_eq!(electric_friction_max_n(&HEADER, &[endless], &[]), None);
    let huge = constant(f32::MAX);
    assert_eq!(electric_friction_max_n(&HEADER, &[huge, Record { blend: Blend::Add, ..huge }], &[]), None);
}
