//! The amplifier: DAC code in, electrode voltage out, with gain error, offset, saturation, a first-order lag and a
//! limit on its current.

use frixel_control::Drive;

use crate::error::{OutOfRange, above_zero, zero_to_ten};

/// Below this distance from its target, in volts, the voltage is set to the target. Otherwise the decay would reach
/// subnormal numbers, which are slow and never become zero.
const SETTLED_V: f64 = 1e-9;

/// Deviations of the amplifier from an ideal one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AmplifierConfig {
    /// True gain over the gain that the board assumes: 1 for an ideal amplifier. Above 0.
    pub gain: f64,
    /// Largest voltage that the output reaches in either direction, in volts, peak. Above 0.
    pub saturation_v_peak: f64,
    /// Time constant of the output, in seconds: 0 (no lag) to 10.
    pub time_constant_s: f64,
    /// Voltage that is added to the output while the amplifier is enabled, in volts: -10 to 10.
    pub offset_v: f64,
    /// Fastest change of the output, in V/s, above 0: the amplifier's current limit over the capacitance that it
    /// charges.
    pub slew_v_per_s: f64,
}

impl AmplifierConfig {
    /// Exact gain, no offset, no current limit, a time constant of 20 us, and 250 V: the simulated board's full scale,
    /// above any voltage that it allows.
    pub const IDEAL: Self = Self {
        gain: 1.0,
        saturation_v_peak: 250.0,
        time_constant_s: 20e-6,
        offset_v: 0.0,
        slew_v_per_s: f64::INFINITY,
    };

    /// An amplifier as `docs/hardware.md` demands it: an offset of 0.5 V (assumed: 25 mV at the input of a gain of 20),
    /// and a current limit of 5 mA into the simulated board's worst electrode, 0.53 nF.
    pub const REALISTIC: Self = Self { offset_v: 0.5, slew_v_per_s: 5e-3 / 0.53e-9, ..Self::IDEAL };
}

impl Default for AmplifierConfig {
    /// [`Self::IDEAL`].
    fn default() -> Self {
        Self::IDEAL
    }
}

/// The electrode voltage during a tick.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Output {
    /// Mean voltage over the tick, V.
    pub(crate) mean_v: f64,
    /// Variance of the voltage over the tick, V^2.
    pub(crate) variance_v2: f64,
    /// Mean of the squared voltage over the tick, V^2: the square of its mean plus its variance.
    pub(crate) mean_square_v2: f64,
    /// Voltage at the end of the tick, V.
    pub(crate) end_v: f64,
}

/// The amplifier and its output voltage.
#[derive(Clone, Debug)]
pub(crate) struct Amplifier {
    volts_per_code: f64,
    saturation_v_peak: f64,
    /// `e^(-T/tau)`: the share of the distance to the target that remains after a tick.
    remainder: f64,
    /// Mean of `e^(-t/tau)` over a tick.
    mean_remainder: f64,
    /// Variance of `e^(-t/tau)` over a tick.
    remainder_variance: f64,
    output_v: f64,
    time_constant_s: f64,
    offset_v: f64,
    slew_v_per_s: f64,
    /// Distance from the target above which the slew rate limits the output, V.
    slewing_above_v: f64,
    tick_period_s: f64,
}

impl Output {
    fn new(mean_v: f64, variance_v2: f64, end_v: f64) -> Self {
        Self { mean_v, variance_v2, mean_square_v2: mean_v * mean_v + variance_v2, end_v }
    }
}

impl Amplifier {
    /// An amplifier at rest at 0 V, behind a DAC whose code 32,767 stands for `full_scale_v_peak`.
    pub(crate) fn new(config: &AmplifierConfig, full_scale_v_peak: f64, tick_hz: u32) -> Result<Self, OutOfRange> {
        let gain = above_zero("amplifier gain", config.gain)?;
        let saturation_v_peak = above_zero("amplifier saturation_v_peak", config.saturation_v_peak)?;
        let time_constant_s = zero_to_ten("amplifier time_constant_s", config.time_constant_s)?;
        let slew_v_per_s = match config.slew_v_per_s {
            unlimited if unlimited == f64::INFINITY => unlimited,
            limited => above_zero("amplifier slew_v_per_s", limited)?,
        };
        let offset_v = config.offset_v;
        if !(-10.0..=10.0).contains(&offset_v) {
            return Err(OutOfRange { name: "amplifier offset_v", expected: "from -10 to 10", found: offset_v });
        }
        let volts_per_code = gain * above_zero("full_scale_v_peak", full_scale_v_peak)? / f64::from(i16::MAX);
        // Infinite without a lag, which leaves remainder, mean and variance at zero.
        let tick_over_tau = 1.0 / (f64::from(tick_hz) * time_constant_s);
        let mean_remainder = -libm::expm1(-tick_over_tau) / tick_over_tau;
        let mean_squared_remainder = -libm::expm1(-2.0 * tick_over_tau) / (2.0 * tick_over_tau);
        Ok(Self {
            volts_per_code,
            saturation_v_peak,
            remainder: libm::exp(-tick_over_tau),
            mean_remainder,
            remainder_variance: (mean_squared_remainder - mean_remainder * mean_remainder).max(0.0),
            output_v: 0.0,
            time_constant_s,
            offset_v,
            slew_v_per_s,
            // Infinity times zero: without a limit, nothing is above it.
            slewing_above_v: if slew_v_per_s.is_finite() { slew_v_per_s * time_constant_s } else { f64::INFINITY },
            tick_period_s: 1.0 / f64::from(tick_hz),
        })
    }

    /// Holds `drive` for one tick.
    ///
    /// With target `u`, start `v0` and `d = v0 - u` the output is `u + d e^(-t/tau)`; the mean of its square is the
    /// square of its mean plus its variance, which cannot cancel.
    pub(crate) fn tick(&mut self, drive: Drive) -> Output {
        let commanded_v = if drive.amplifier_enable {
            f64::from(drive.dac_code.bits()) * self.volts_per_code + self.offset_v
        } else {
            0.0
        };
        let target_v = commanded_v.clamp(-self.saturation_v_peak, self.saturation_v_peak);
        let distance_v = self.output_v - target_v;
        if distance_v.abs() < SETTLED_V {
            self.output_v = target_v;
            return Output::new(target_v, 0.0, target_v);
        }
        if distance_v.abs() > self.slewing_above_v {
            return self.slew(target_v, distance_v);
        }
        let mean_v = target_v + distance_v * self.mean_remainder;
        self.output_v = target_v + distance_v * self.remainder;
        Output::new(mean_v, distance_v * distance_v * self.remainder_variance, self.output_v)
    }

    /// A tick that begins too far from the target for the amplifier's current: a ramp, and the lag from its end on.
    fn slew(&mut self, target_v: f64, distance_v: f64) -> Output {
        let slope_v_per_s = self.slew_v_per_s.copysign(-distance_v);
        let ramp_s = (distance_v.abs() - self.slewing_above_v) / self.slew_v_per_s;
        let ramp = |time_s: f64| {
            let rise_v = slope_v_per_s * time_s;
            (self.output_v + 0.5 * rise_v, rise_v * rise_v / 12.0)
        };
        if ramp_s >= self.tick_period_s {
            let (mean_v, variance_v2) = ramp(self.tick_period_s);
            self.output_v += slope_v_per_s * self.tick_period_s;
            return Output::new(mean_v, variance_v2, self.output_v);
        }
        let (ramp_mean_v, ramp_variance_v2) = ramp(ramp_s);
        let lag_s = self.tick_period_s - ramp_s;
        // The amplifier without lag holds its target instead.
        let lags = lag_s / self.time_constant_s;
        let remaining_v = self.slewing_above_v.copysign(distance_v);
        let mean_remainder = -libm::expm1(-lags) / lags;
        let mean_squared_remainder = -libm::expm1(-2.0 * lags) / (2.0 * lags);
        let lag_mean_v = target_v + remaining_v * mean_remainder;
        let lag_variance_v2 =
            remaining_v * remaining_v * (mean_squared_remainder - mean_remainder * mean_remainder).max(0.0);
        let ramp_part = ramp_s / self.tick_period_s;
        let lag_part = 1.0 - ramp_part;
        let between_v = ramp_mean_v - lag_mean_v;
        self.output_v = target_v + remaining_v * libm::exp(-lags);
        Output::new(
            ramp_part * ramp_mean_v + lag_part * lag_mean_v,
            ramp_part * ramp_variance_v2 + lag_part * lag_variance_v2 + ramp_part * lag_part * between_v * between_v,
            self.output_v,
        )
    }

    /// Voltage on the electrode now, in volts.
    pub(crate) fn output_v(&self) -> f64 {
        self.output_v
    }
}

#[cfg(test)]
mod tests {
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
            let mut amplifier = amplifier(AmplifierConfig { time_constant_s, ..AmplifierConfig::default() });
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
            let mut amplifier = amplifier(AmplifierConfig { time_constant_s, ..AmplifierConfig::default() });
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
    fn a_step_rises_by_one_minus_e_to_the_minus_one_in_a_time_constant() {
        let time_constant_s = 100e-6;
        let mut amplifier = amplifier(AmplifierConfig { time_constant_s, ..AmplifierConfig::default() });
        let ticks = (time_constant_s * f64::from(TICK_HZ)) as usize;
        let end_v = (0..ticks).map(|_| amplifier.tick(drive(32_767)).end_v).last().unwrap();
        assert!((end_v / 200.0 - 0.632_120_558_828_557_7).abs() < 1e-12, "{end_v}");
    }

    #[test]
    fn without_lag_the_output_is_the_target_at_once() {
        let mut amplifier = amplifier(AmplifierConfig { time_constant_s: 0.0, ..AmplifierConfig::default() });
        for code in [32_767, -32_767, 0, 5] {
            let output = amplifier.tick(drive(code));
            let target_v = f64::from(code) * (200.0 / 32_767.0);
            assert_eq!((output.end_v, output.mean_square_v2), (target_v, target_v * target_v));
        }
    }

    #[test]
    fn gain_scales_and_saturation_holds_in_both_directions() {
        let config =
            AmplifierConfig { gain: 1.5, saturation_v_peak: 150.0, time_constant_s: 0.0, ..AmplifierConfig::IDEAL };
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
            let config = AmplifierConfig { time_constant_s, slew_v_per_s, ..AmplifierConfig::IDEAL };
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
                assert!(
                    (output.mean_square_v2 - mean_square_v2).abs() < 0.5,
                    "{} {mean_square_v2}",
                    output.mean_square_v2
                );
            }
        }
    }

    #[test]
    fn an_offset_is_there_while_the_amplifier_is_enabled() {
        let config = AmplifierConfig { offset_v: 0.5, time_constant_s: 0.0, ..AmplifierConfig::IDEAL };
        let mut amplifier = amplifier(config);
        assert_eq!(amplifier.tick(drive(0)).end_v, 0.5);
        assert_eq!(amplifier.tick(drive(32_767)).end_v, 200.5);
        assert_eq!(amplifier.tick(Drive { amplifier_enable: false, ..drive(0) }).end_v, 0.0);
    }

    #[test]
    fn disabled_it_decays_to_exactly_zero() {
        let mut amplifier = amplifier(AmplifierConfig::default());
        for _ in 0..100 {
            amplifier.tick(drive(32_767));
        }
        let off = Drive { dac_code: DacCode::MAX, amplifier_enable: false };
        let first_v = amplifier.tick(off).end_v;
        assert!((first_v - 200.0 * libm::exp(-1.25)).abs() < 1e-6, "{first_v}");
        let last = (0..40).map(|_| amplifier.tick(off)).last().unwrap();
        assert_eq!((last.end_v, last.mean_square_v2), (0.0, 0.0));
    }

    #[test]
    fn values_out_of_range_are_refused_by_name() {
        for (config, name) in [
            (AmplifierConfig { gain: 0.0, ..AmplifierConfig::default() }, "amplifier gain"),
            (
                AmplifierConfig { saturation_v_peak: f64::NAN, ..AmplifierConfig::default() },
                "amplifier saturation_v_peak",
            ),
            (AmplifierConfig { time_constant_s: -1e-6, ..AmplifierConfig::default() }, "amplifier time_constant_s"),
            (AmplifierConfig { offset_v: 11.0, ..AmplifierConfig::default() }, "amplifier offset_v"),
            (AmplifierConfig { slew_v_per_s: 0.0, ..AmplifierConfig::default() }, "amplifier slew_v_per_s"),
        ] {
            assert_eq!(Amplifier::new(&config, FULL_SCALE_V_PEAK, TICK_HZ).unwrap_err().name, name);
        }
        let error = Amplifier::new(&AmplifierConfig::default(), f64::INFINITY, TICK_HZ).unwrap_err();
        assert_eq!(error.to_string(), "full_scale_v_peak must be finite and above 0, found inf");
    }
}
