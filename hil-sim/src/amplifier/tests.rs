#![allow(clippy::float_cmp, reason = "what has to be exact is tested as exact")]

use frixel_control::Drive;
use frixel_wire::dac_code::DacCode;
use proptest::prelude::*;

use super::{Amplifier, AmplifierConfig};

const FULL_SCALE_V_PEAK: f64 = 200.0;
const TICK_HZ: u32 = 40_000;

fn amplifier(config: AmplifierConfig) -> Amplifier {
    Amplifier::new(&config, FULL_SCALE_V_PEAK, TICK_HZ).unwrap()
}

fn drive(dac_code: i16) -> Drive {
    Drive { dac_code: DacCode::from_bits(dac_code), amplifier_enable: true }
}

/// Voltage and mean square by Simpson's rule over the lag's differential equation, solved from its definition.
fn by_small_steps(start_v: f64, target_v: f64, time_constant_s: f64) -> (f64, f64) {
    const STEPS: u32 = 2000;
    let tick_s = 1.0 / f64::from(TICK_HZ);
    let voltage_at = |step: u32| {
        let t_s = tick_s * f64::from(step) / f64::from(STEPS);
        target_v + (start_v - target_v) * libm::exp(-t_s / time_constant_s)
    };
    let sum: f64 = (0..=STEPS)
        .map(|step| {
            let weight = if step == 0 || step == STEPS { 1.0 } else { 2.0 + 2.0 * f64::from(step % 2) };
            weight * voltage_at(step) * voltage_at(step)
        })
        .sum();
    (sum / (3.0 * f64::from(STEPS)), voltage_at(STEPS))
}

proptest! {
    #[test]
    fn mean_square_and_end_are_those_of_small_steps(
        codes in prop::collection::vec(-32_767_i16..=32_767, 1..20),
        time_constant_s in 2e-6..1e-3_f64,
    ) {
        let mut amplifier = amplifier(AmplifierConfig { electrode_time_constant_s: time_constant_s, ..AmplifierConfig::default() });
        let mut voltage_v = 0.0;
        for code in codes {
            let target_v = f64::from(code) * FULL_SCALE_V_PEAK / 32_767.0;
            let (mean_square_v2, end_v) = by_small_steps(voltage_v, target_v, time_constant_s);
            let output = amplifier.tick(drive(code));
            prop_assert!((output.end_v - end_v).abs() < 1e-9, "{} {end_v}", output.end_v);
            prop_assert!(
                (output.mean_square_v2 - mean_square_v2).abs() < 1e-6,
                "{} {mean_square_v2}",
                output.mean_square_v2
            );
            voltage_v = end_v;
        }
    }

    #[test]
    fn mean_square_is_never_negative_and_never_above_the_peak(
        codes in prop::collection::vec(any::<i16>(), 1..50),
        time_constant_s in prop_oneof![Just(0.0), Just(1e-300), 1e-9..10.0_f64],
    ) {
        let mut amplifier = amplifier(AmplifierConfig { electrode_time_constant_s: time_constant_s, ..AmplifierConfig::default() });
        // The most negative code is a step beyond full scale.
        let peak_v = FULL_SCALE_V_PEAK * 32_768.0 / 32_767.0;
        for code in codes {
            let output = amplifier.tick(drive(code));
            prop_assert!(output.mean_square_v2 >= 0.0 && output.mean_square_v2 <= peak_v * peak_v * (1.0 + 1e-12));
            prop_assert!(output.end_v.abs() <= peak_v * (1.0 + 1e-12));
        }
    }
}

#[test]
fn without_lag_the_output_is_the_target_at_once() {
    let mut amplifier = amplifier(AmplifierConfig { electrode_time_constant_s: 0.0, ..AmplifierConfig::default() });
    for code in [32_767, -32_767, 0, 5] {
        let output = amplifier.tick(drive(code));
        let target_v = f64::from(code) * (200.0 / 32_767.0);
        assert_eq!((output.end_v, output.mean_square_v2), (target_v, target_v * target_v));
    }
}

#[test]
fn gain_scales_and_saturation_holds_in_both_directions() {
    let config = AmplifierConfig {
        gain: 1.5,
        saturation_v_peak: 150.0,
        electrode_time_constant_s: 0.0,
        ..AmplifierConfig::IDEAL
    };
    let mut amplifier = amplifier(config);
    assert!((amplifier.tick(drive(1000)).end_v - 1.5 * 200.0 * 1000.0 / 32_767.0).abs() < 1e-12);
    assert_eq!(amplifier.tick(drive(32_767)).end_v, 150.0);
    let output = amplifier.tick(drive(-32_767));
    assert_eq!((output.end_v, output.mean_square_v2), (-150.0, 22_500.0));
}

/// The lag's differential equation with a limited slope, in many small steps.
#[test]
fn a_limited_current_makes_a_ramp_and_then_the_lag() {
    for (slew_v_per_s, time_constant_s) in [(9.4e6, 20e-6), (1e6, 5e-6), (9.4e6, 0.0), (20e6, 1e-3)] {
        let config =
            AmplifierConfig { electrode_time_constant_s: time_constant_s, slew_v_per_s, ..AmplifierConfig::IDEAL };
        let mut amplifier = amplifier(config);
        let mut voltage_v = 0.0;
        for code in [20_000, -20_000, -20_000, 15_000, 15_100, 0, -32_767, 32_767] {
            let target_v = f64::from(code) * FULL_SCALE_V_PEAK / 32_767.0;
            let (mut sum_v, mut sum_v2) = (0.0, 0.0);
            let steps = 200_000;
            let step_s = 1.0 / f64::from(TICK_HZ) / f64::from(steps);
            for _ in 0..steps {
                let free_v_per_s = (target_v - voltage_v) / time_constant_s.max(step_s);
                let before_v = voltage_v;
                voltage_v += step_s * free_v_per_s.clamp(-slew_v_per_s, slew_v_per_s);
                let middle_v = 0.5 * (before_v + voltage_v);
                (sum_v, sum_v2) = (sum_v + middle_v, sum_v2 + middle_v * middle_v);
            }
            let output = amplifier.tick(drive(code));
            let (mean_v, mean_square_v2) = (sum_v / f64::from(steps), sum_v2 / f64::from(steps));
            assert!((output.end_v - voltage_v).abs() < 2e-3, "{} {voltage_v}", output.end_v);
            assert!((output.mean_v - mean_v).abs() < 2e-3, "{} {mean_v}", output.mean_v);
            assert!((output.mean_square_v2 - mean_square_v2).abs() < 0.5, "{} {mean_square_v2}", output.mean_square_v2);
        }
    }
}

#[test]
fn an_offset_is_there_while_the_amplifier_is_enabled() {
    let config = AmplifierConfig { offset_v: 0.5, electrode_time_constant_s: 0.0, ..AmplifierConfig::IDEAL };
    let mut amplifier = amplifier(config);
    assert_eq!(amplifier.tick(drive(0)).end_v, 0.5);
    assert_eq!(amplifier.tick(drive(32_767)).end_v, 200.5);
    assert_eq!(amplifier.tick(Drive { amplifier_enable: false, ..drive(0) }).end_v, 0.0);
}

#[test]
fn values_out_of_range_are_refused_by_name() {
    for (config, name) in [
        (AmplifierConfig { gain: 0.0, ..AmplifierConfig::default() }, "amplifier gain"),
        (AmplifierConfig { saturation_v_peak: f64::NAN, ..AmplifierConfig::default() }, "amplifier saturation_v_peak"),
        (
            AmplifierConfig { electrode_time_constant_s: -1e-6, ..AmplifierConfig::default() },
            "amplifier electrode_time_constant_s",
        ),
        (AmplifierConfig { offset_v: 11.0, ..AmplifierConfig::default() }, "amplifier offset_v"),
        (AmplifierConfig { slew_v_per_s: 0.0, ..AmplifierConfig::default() }, "amplifier slew_v_per_s"),
    ] {
        assert_eq!(Amplifier::new(&config, FULL_SCALE_V_PEAK, TICK_HZ).unwrap_err().name, name);
    }
    let error = Amplifier::new(&AmplifierConfig::default(), f64::INFINITY, TICK_HZ).unwrap_err();
    assert_eq!(error.to_string(), "full_scale_v_peak must be finite and above 0, found inf");
}

const OFF: Drive = Drive { dac_code: DacCode::ZERO, amplifier_enable: false };

/// An amplifier that has output a constant voltage for a long time.
fn driven_long(config: AmplifierConfig, dac_code: i16) -> Amplifier {
    let mut amplifier = amplifier(config);
    for _ in 0..4_000 {
        amplifier.tick(drive(dac_code));
    }
    amplifier
}

/// The monitor's voltages at the beginnings of the ticks after a drive.
fn monitored_v(amplifier: &mut Amplifier, drive: Drive, ticks: usize) -> Vec<f64> {
    (0..ticks)
        .map(|_| {
            amplifier.tick(drive);
            amplifier.monitor_v()
        })
        .collect()
}

/// Two lags one behind the other, in many small steps.
#[test]
fn the_electrode_follows_the_output_that_follows_the_dac() {
    for (output_time_constant_s, electrode_time_constant_s) in
        [(8e-6, 36e-6), (36e-6, 8e-6), (20e-6, 20e-6), (8e-6, 0.0), (0.0, 36e-6), (1e-3, 36e-6)]
    {
        let config = AmplifierConfig { output_time_constant_s, electrode_time_constant_s, ..AmplifierConfig::IDEAL };
        let mut amplifier = amplifier(config);
        let (mut output_v, mut electrode_v) = (0.0, 0.0);
        for code in [20_000, -20_000, -20_000, 15_000, 15_100, 0, -32_767, 32_767] {
            let target_v = f64::from(code) * FULL_SCALE_V_PEAK / 32_767.0;
            let steps = 100_000;
            let step_s = 1.0 / f64::from(TICK_HZ) / f64::from(steps);
            let (mut sum_v, mut sum_v2) = (0.0, 0.0);
            for _ in 0..steps {
                let (output_before_v, electrode_before_v): (f64, f64) = (output_v, electrode_v);
                output_v += (target_v - output_v) * -libm::expm1(-step_s / output_time_constant_s);
                let middle_v = 0.5 * (output_before_v + output_v);
                electrode_v += (middle_v - electrode_v) * -libm::expm1(-step_s / electrode_time_constant_s);
                let middle_v = 0.5 * (electrode_before_v + electrode_v);
                (sum_v, sum_v2) = (sum_v + middle_v, sum_v2 + middle_v * middle_v);
            }
            let output = amplifier.tick(drive(code));
            let (mean_v, mean_square_v2) = (sum_v / f64::from(steps), sum_v2 / f64::from(steps));
            // Equal time constants are taken a ten-thousandth apart.
            assert!((output.end_v - electrode_v).abs() < 2e-2, "{} {electrode_v}", output.end_v);
            assert!((output.mean_v - mean_v).abs() < 2e-2, "{} {mean_v}", output.mean_v);
            assert!((output.mean_square_v2 - mean_square_v2).abs() < 2.0, "{} {mean_square_v2}", output.mean_square_v2);
            assert!((amplifier.voltages.output_v - output_v).abs() < 2e-2);
        }
    }
}

#[test]
fn a_disabled_output_waits_and_falls() {
    let config = AmplifierConfig { turn_off_delay_s: 90e-6, ..AmplifierConfig::IDEAL };
    let mut amplifier = driven_long(config, 32_767);
    // The first reading is older than the fall of the enable; then four ticks of delay, of the 3.6 asked for.
    let expected_v = [200.0, 200.0, 200.0, 200.0, 200.0, 0.0, 0.0];
    for (monitor_v, expected_v) in monitored_v(&mut amplifier, OFF, 7).into_iter().zip(expected_v) {
        assert!((monitor_v - expected_v).abs() < 1e-9, "{monitor_v} {expected_v}");
    }
    assert!((monitored_v(&mut amplifier, drive(-32_767), 2)[1] + 200.0).abs() < 1e-9, "it follows at once");
}

#[test]
fn a_broken_output_stage_keeps_its_voltage_until_it_is_repaired() {
    let stuck = AmplifierConfig { is_stuck_on: true, ..AmplifierConfig::IDEAL };
    let mut amplifier = driven_long(stuck, -16_384);
    let last_v = *monitored_v(&mut amplifier, OFF, 400).last().unwrap();
    assert!((last_v + 100.0).abs() < 0.01, "{last_v}");
    let mut repaired = amplifier.reconfigured(&AmplifierConfig::IDEAL, FULL_SCALE_V_PEAK, TICK_HZ).unwrap();
    assert_eq!(monitored_v(&mut repaired, OFF, 2)[1], 0.0);
}

#[test]
fn the_simulators_own_board_has_the_ideal_amplifier() {
    assert_eq!(AmplifierConfig::of(&frixel_control::Board::SIMULATOR), AmplifierConfig::IDEAL);
}
