//! The whole path in one process: frames over a virtual line into the firmware, its voltage onto a simulated finger.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail")]

use crate::script::{Script, constant, scene};
use frixel_hil_sim::{Point, RigConfig, RigTick, Status, Stroke};
use frixel_layers::{FingerLaw, Header, LawPoint, Waveform};

/// A scene whose host may be silent for a second.
const HEADER: Header = Header { voltage_max_v_peak: 220.0, host_timeout_s: 1.0, ..frixel_testkit::HEADER };

/// Plays a constant under the finger's stroke.
fn playing(header: &Header, electric_friction_n: f32) -> Script {
    let mut script = Script::new(&RigConfig::default(), slide(), 1);
    script.play(&scene(header, &[constant(electric_friction_n)]));
    script
}

fn slide() -> Stroke {
    let point = |x_m| Point { x_m, y_m: 0.05 };
    Stroke::constant_speed(point(0.005), point(0.105), 0.1).unwrap()
}

/// Means of the friction felt over whole carrier periods, once the finger is known to the board.
fn felt_means_n(records: &[RigTick<Status>]) -> Vec<f64> {
    records[4000..]
        .chunks_exact(40)
        .map(|period| period.iter().map(|record| record.felt.friction_n).sum::<f64>() / 40.0)
        .collect()
}

#[test]
fn a_constant_friction_is_felt_within_one_per_cent_of_what_can_be_reached() {
    let points = [(50.0, 4e-3), (100.0, 0.03), (150.0, 0.09)]
        .map(|(voltage_v_rms, electric_friction_n)| LawPoint { voltage_v_rms, electric_friction_n });
    let law = FingerLaw::new(2.0, &points);
    assert!(law.is_some());
    let empirical = Header { finger_radius_m: 0.0, stiffness_pa_per_m: 0.0, effective_gap_m: 0.0, law, ..HEADER };
    for header in [HEADER, Header { waveform: Waveform::Sine, ..HEADER }, empirical] {
        let Header { waveform, law, .. } = header;
        let contact = header.friction_law().unwrap();
        let reach_n = contact.electric_friction_n(150.0);
        for part in [0.1, 0.5, 0.95] {
            let reference_n = contact.natural_friction_n() + part * reach_n;
            let mut script = playing(&header, (part * reach_n) as f32);
            let records: Vec<RigTick<Status>> = (0..39_000).map(|_| script.step()).collect();
            // A sine's pressure swings about its mean, and friction grows a little faster than pressure; under this law
            // much faster, so that the edges of a square count, too.
            let is_even = waveform == Waveform::Square && law.is_none();
            let bound = if is_even { 0.01 } else { 0.03 };
            for felt_n in felt_means_n(&records) {
                let error = (felt_n - reference_n) / reach_n;
                assert!(error.abs() <= bound, "{waveform:?} at {part} of the range: {error}");
            }
        }
    }
}

/// The knots of a law follow the largest voltage: here that of the peak limit, and the law's bends lie between knots.
#[test]
fn the_plant_has_the_boards_law_where_the_peak_limit_binds() {
    let whole = frixel_testkit::empirical_header();
    for (waveform, voltage_max_v_peak) in
        [(Waveform::Square, 141.0), (Waveform::Square, 100.3), (Waveform::Sine, 170.0)]
    {
        let header = Header { waveform, voltage_max_v_peak, host_timeout_s: 1.0, ..whole };
        let mut differs_from_rms_limit = false;
        // At the bends, and between them.
        for friction_n in [2.47e-3_f32, 5.52e-3, 6.07e-3, 0.01, 0.0135, 0.0159] {
            let mut script = playing(&header, friction_n);
            for _ in 0..8_000 {
                script.step();
            }
            let voltage_v_rms = f64::from(script.status().telemetry.voltage_v_rms);
            let error_of = |found_n: f64| (found_n / f64::from(friction_n) - 1.0).abs();
            let error = error_of(script.rig.world_mut().finger_law().electric_friction_n(voltage_v_rms));
            assert!(error < 1e-5, "{waveform:?}, {voltage_max_v_peak} V peak, {friction_n} N: {error:e}");
            differs_from_rms_limit |=
                error_of(header.friction_law().unwrap().electric_friction_n(voltage_v_rms)) > 1e-4;
        }
        assert!(differs_from_rms_limit, "{waveform:?}, {voltage_max_v_peak} V peak");
    }
}
