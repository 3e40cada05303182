//! Charge leakage through the skin.

use core::f64::consts::TAU;

use crate::amplifier::Output;

/// Difference in volts below which the leaked charge is set to its target. Otherwise the decay would reach subnormal
/// numbers.
const SETTLED_V: f64 = 1e-9;

/// A first-order high-pass from the electrode voltage to the gap voltage: the skin side charges to the electrode
/// voltage with the leakage's time constant.
#[derive(Clone, Debug)]
pub(super) struct Leakage {
    /// Fraction of the difference that leaks in a tick; 0 without leakage.
    share: f64,
    leaked_v: f64,
}

impl Leakage {
    pub(super) fn new(corner_hz: f64, tick_hz: u32) -> Self {
        Self { share: -libm::expm1(-TAU * corner_hz / f64::from(tick_hz)), leaked_v: 0.0 }
    }

    /// Returns the mean squared voltage across the gap over a tick, in V^2.
    ///
    /// Leakage uses the mean electrode voltage; its variation within the tick stays in the mean square.
    pub(super) fn tick(&mut self, output: &Output) -> f64 {
        if self.share <= 0.0 {
            return output.mean_square_v2;
        }
        let before_v = self.leaked_v;
        let distance_v = output.mean_v - before_v;
        self.leaked_v = if distance_v.abs() < SETTLED_V { output.mean_v } else { before_v + self.share * distance_v };
        let across_v = output.mean_v - 0.5 * (before_v + self.leaked_v);
        across_v * across_v + output.variance_v2
    }

    /// Resets the charge when the finger leaves.
    pub(super) fn lift(&mut self) {
        self.leaked_v = 0.0;
    }
}

#[cfg(test)]
mod tests {
    use super::Leakage;
    use crate::amplifier::Output;

    const TICK_HZ: u32 = 40_000;

    fn held(voltage_v: f64) -> Output {
        Output { mean_v: voltage_v, variance_v2: 0.0, mean_square_v2: voltage_v * voltage_v, end_v: voltage_v }
    }

    /// Fraction of the mean square that remains of a square wave in steady state.
    fn part_kept(half_period_ticks: u32) -> f64 {
        let mut leakage = Leakage::new(250.0, TICK_HZ);
        let ticks = 40 * half_period_ticks.max(400);
        let counted = 2 * half_period_ticks;
        let squares = (0..ticks)
            .map(|tick| leakage.tick(&held(if (tick / half_period_ticks).is_multiple_of(2) { 100.0 } else { -100.0 })));
        squares.skip((ticks - counted) as usize).sum::<f64>() / f64::from(counted) / 1e4
    }

    #[test]
    fn a_slow_carrier_loses_force_and_a_fast_one_barely() {
        // A square wave of half period H behind a high-pass of time constant tau keeps (2 tau/H) tanh(H / (2 tau)).
        for (carrier_hz, kept) in [(25.0, 0.064), (125.0, 0.317), (250.0, 0.584), (1000.0, 0.952), (5000.0, 0.998)] {
            let half_s: f64 = 0.5 / carrier_hz;
            let tau_s = 1.0 / (core::f64::consts::TAU * 250.0);
            let expected = 2.0 * tau_s / half_s * (0.5 * half_s / tau_s).tanh();
            assert!((expected - kept).abs() < 1e-3, "{carrier_hz} Hz: {expected}");
            let found = part_kept((half_s * f64::from(TICK_HZ)).round() as u32);
            assert!((found / expected - 1.0).abs() < 5e-3, "{carrier_hz} Hz: {found}, expected {expected}");
        }
    }

    #[test]
    fn a_constant_voltage_leaks_away_until_the_finger_lifts() {
        let mut leakage = Leakage::new(250.0, TICK_HZ);
        let after_a_second = (0..TICK_HZ).map(|_| leakage.tick(&held(100.0))).last().unwrap();
        assert!(after_a_second < 1e-12, "{after_a_second}");
        leakage.lift();
        assert!(leakage.tick(&held(100.0)) > 9.6e3);
    }
}
