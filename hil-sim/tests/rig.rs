//! The whole path in one process: frames over a virtual line into the firmware, its voltage onto a simulated finger.
#![allow(clippy::unwrap_used, clippy::panic, reason = "a test may fail")]

use crate::script::{Script, constant, scene};
use frixel_hil_sim::{Point, RigConfig, Stroke};
use frixel_layers::{Header, Waveform};

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

/// The drive has the commanded voltage, and the world the law that the board computes with.
///
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
            script.steps(8_000);
            // A period of the carrier.
            let mean_square_v2 = (0..40).map(|_| script.step().felt.mean_square_v2).sum::<f64>() / 40.0;
            let voltage_v_rms = f64::from(script.status().telemetry.voltage_v_rms);
            let driven = mean_square_v2.sqrt() / voltage_v_rms;
            assert!((driven - 1.0).abs() < 1e-3, "{waveform:?}, {friction_n} N: driven {driven}");
            let error_of = |found_n: f64| (found_n / f64::from(friction_n) - 1.0).abs();
            let error = error_of(script.rig.world_mut().finger_law().electric_friction_n(voltage_v_rms));
            assert!(error < 1e-5, "{waveform:?}, {voltage_max_v_peak} V peak, {friction_n} N: {error:e}");
            differs_from_rms_limit |=
                error_of(header.friction_law().unwrap().electric_friction_n(voltage_v_rms)) > 1e-4;
        }
        assert!(differs_from_rms_limit, "{waveform:?}, {voltage_max_v_peak} V peak");
    }
}
