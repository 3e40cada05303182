use super::*;

const CARRIERS_HZ: [f64; 12] =
    [125.0, 160.0, 200.0, 250.0, 333.0, 500.0, 700.0, 1_000.0, 1_300.0, 2_000.0, 3_333.0, 5_000.0];

fn close(found: f64, expected: f64, part: f64) {
    assert!((found / expected - 1.0).abs() < part, "{found} is not {expected}");
}

/// Margin of the firmware's bound for one series resistance: the ratio of 0.7 mA to the largest current at the bound,
/// over all coatings.
fn margin(series_ohm: f64, carrier_hz: f64) -> f64 {
    let worst = TouchPath::worst_coating(series_ohm, carrier_hz);
    let bound_v_peak = f64::from(TouchBound::behind(series_ohm as f32).voltage_max_v_peak(carrier_hz as f32));
    TOUCH_CURRENT_MAX_A_PEAK / worst.any_envelope_a_peak(bound_v_peak, carrier_hz)
}

#[test]
fn at_the_bound_the_worst_coating_and_envelope_stay_below_the_limit() {
    for series_ohm in [34e3, 68e3, 136e3, 390e3, 1e6] {
        for carrier_hz in CARRIERS_HZ {
            let margin = margin(series_ohm, carrier_hz);
            assert!(margin >= f64::from(TouchBound::MARGIN), "{margin} at {carrier_hz} Hz behind {series_ohm} Ohm");
        }
    }
}

/// A bound that is needlessly low costs friction.
#[test]
fn the_bound_is_within_an_eighth_of_the_allowed_voltage() {
    for carrier_hz in CARRIERS_HZ {
        let margin = margin(68e3, carrier_hz);
        assert!(margin < 1.125 * f64::from(TouchBound::MARGIN) || carrier_hz > 3e3, "{margin} at {carrier_hz} Hz");
    }
}

#[test]
fn a_scratch_lets_less_through_than_the_worst_coating() {
    for carrier_hz in [125.0, 1_000.0, 5_000.0] {
        let most_a = TouchPath::worst_coating(68e3, carrier_hz).any_envelope_a_peak(1.0, carrier_hz);
        for leak_ohm in [1e3, 10e3, 100e3, 1e6] {
            for capacitance_f in [0.53e-9, 6.9e-9, 50e-9] {
                let path = TouchPath { series_ohm: 68e3, coating: Coating::Scratched { capacitance_f, leak_ohm } };
                let found_a = path.any_envelope_a_peak(1.0, carrier_hz);
                assert!(found_a <= 1.005 * most_a, "{leak_ohm} Ohm, {capacitance_f} F: {found_a} of {most_a}");
            }
        }
    }
}

#[test]
fn a_slow_carrier_through_no_coating_is_ohms_law() {
    let path = TouchPath { series_ohm: 68e3, coating: Coating::Bridged };
    let found = path.steady(50.0, 10.0);
    let expected_a = 50.0 / 70e3;
    close(found.weighted_a_peak, expected_a, 1e-3);
    close(found.a_rms, expected_a, 1e-2);
    close(path.any_envelope_a_peak(50.0, 10.0), expected_a, 1e-3);
}

#[test]
fn a_fast_carrier_through_no_coating_is_weighted_by_a_low_pass() {
    // Far above the skin's frequency, the body is 500 Ohm beside 10 kOhm, and the filter sees a triangle.
    let path = TouchPath { series_ohm: 1e6, coating: Coating::Bridged };
    let found = path.steady(100.0, 5_000.0);
    let lag_s = (WEIGHTING_OHM + BODY_OHM) * WEIGHTING_F;
    close(found.weighted_a_peak, 1e-4 * libm::tanh(100e-6 / (2.0 * lag_s)), 1e-2);
}

#[test]
fn through_a_thick_coating_the_current_itself_is_that_of_the_carriers_budget() {
    let (capacitance_f, series_ohm) = (0.53e-9, 68e3);
    let found = TouchPath { series_ohm, coating: Coating::Intact { capacitance_f } }.steady(50.0, 1_000.0);
    // 2 U/R, and 2 U C sqrt(f/tau).
    close(found.a_peak, 100.0 / (series_ohm + 476.0), 1e-3);
    close(found.a_rms, 100.0 * capacitance_f * libm::sqrt(1e3 / (series_ohm * capacitance_f)), 2e-2);
}

/// Random envelopes on the firmware's carrier: half periods of one length, ended early by the balance of volt-seconds,
/// and restarts a quarter period before an edge, towards zero.
#[test]
fn no_random_envelope_exceeds_the_worst_one_and_some_come_near() {
    for (carrier_hz, capacitance_f, least) in [(125.0, 30e-9, 0.8), (1_000.0, 25e-9, 0.75), (5_000.0, 25e-9, 0.55)] {
        let path = TouchPath { series_ohm: 68e3, coating: Coating::Intact { capacitance_f } };
        let bound_a = path.any_envelope_a_peak(1.0, carrier_hz);
        let mut seed = 1_u64;
        let mut random = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 40) as f64 / f64::from(1 << 24)
        };
        let step_s = 0.5 / carrier_hz / 40.0;
        let (mut state, mut sign, mut left, mut integral, mut amplitude) = ([0.0; 3], 1.0, 20, 0.0_f64, 1.0);
        let mut most_a: f64 = 0.0;
        for _ in 0..400_000 {
            if random() < 0.02 {
                amplitude = [0.0, 1.0, 1.0, random()][(4.0 * random()) as usize];
            }
            if random() < 0.002 {
                (sign, left) = (if integral > 0.0 { -1.0 } else { 1.0 }, 20);
            }
            if (integral + sign * amplitude).abs() > 40.0 && integral * sign > 0.0 {
                (sign, left) = (-sign, 40);
            }
            integral += sign * amplitude;
            state = path.stepped(&state, sign * amplitude, step_s);
            most_a = most_a.max(weighted_a(&state).abs());
            left -= 1;
            if left == 0 {
                (sign, left) = (-sign, 40);
            }
        }
        assert!(most_a <= 1.002 * bound_a, "{most_a} of {bound_a} at {carrier_hz} Hz");
        assert!(most_a >= least * bound_a, "{most_a} of {bound_a} at {carrier_hz} Hz");
    }
}

#[test]
fn an_untouchable_electrode_has_no_bound() {
    assert!(TouchBound::behind(f32::INFINITY).voltage_max_v_peak(125.0).is_infinite());
}

/// A scene replaces one with a slower carrier, whose integral is at its limit. The firmware drives towards zero with a
/// sixteenth of the voltage until the integral is within the new limit (`firmware/control/src/carrier.rs`). At the full
/// voltage, 0.90 mA would flow once; at an eighth, no margin would be left for amplifier and resistor.
#[test]
fn a_fast_scene_in_place_of_a_slow_one_stays_within_the_limit() {
    let bound = TouchBound::behind(68e3);
    // The board's largest voltage counts where it is below the bound.
    let voltage_v = |carrier_hz: f64| f64::from(bound.voltage_max_v_peak(carrier_hz as f32)).min(50.0);
    let most_ma = |slow_hz: f64, fast_hz: f64, part: f64| {
        let (slow_v, fast_v) = (voltage_v(slow_hz), voltage_v(fast_hz));
        let step_s = 0.01 / fast_hz;
        let most_ma = |capacitance_f: f64| {
            let path = TouchPath { series_ohm: 68e3, coating: Coating::Intact { capacitance_f } };
            let (mut state, mut integral_v_s, mut most) = ([0.0; 3], 0.5 * slow_v / slow_hz, 0.0);
            let mut drive = |drive_v: f64, until_v_s: f64| {
                while (until_v_s - integral_v_s) * drive_v > 0.0 {
                    state = path.stepped(&state, drive_v, step_s);
                    integral_v_s += drive_v * step_s;
                    most = f64::max(most, 1e3 * weighted_a(&state).abs());
                }
            };
            let limit_v_s = 0.5 * fast_v / fast_hz;
            drive(-slow_v, -0.5 * slow_v / slow_hz);
            drive(part * fast_v, -limit_v_s);
            for half_period in 0..8 {
                let sign = if half_period % 2 == 0 { 1.0 } else { -1.0 };
                drive(sign * fast_v, sign * limit_v_s);
            }
            most
        };
        (0..30).map(|step| most_ma(1e-9 * libm::pow(10.0, 0.1 * f64::from(step)))).fold(0.0, f64::max)
    };
    for slow_hz in [125.0, 250.0, 500.0, 1_000.0] {
        for fast_hz in [250.0, 500.0, 800.0, 1_000.0, 1_500.0, 2_500.0, 5_000.0] {
            if fast_hz > slow_hz {
                let found_ma = f64::from(TouchBound::MARGIN) * most_ma(slow_hz, fast_hz, 1.0 / 16.0);
                assert!(found_ma < 1e3 * TOUCH_CURRENT_MAX_A_PEAK, "{found_ma} mA from {slow_hz} to {fast_hz} Hz");
            }
        }
    }
    close(most_ma(125.0, 5_000.0, 1.0), 0.90, 0.01);
}
