//! First-order lags over one tick.

use super::Output;

/// Distance in volts below which a voltage is set to its target. Otherwise the decay would reach subnormal numbers,
/// which are slow and never become zero.
const SETTLED_V: f64 = 1e-9;

/// Exponential decay `e^(-t/tau)` over a time: its remainder at the end, its mean, and its variance.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lag {
    pub(super) remainder: f64,
    pub(super) mean: f64,
    pub(super) variance: f64,
}

impl Lag {
    pub(super) fn new(time_constant_s: f64, time_s: f64) -> Self {
        // Infinite without a lag, which leaves remainder, mean and variance at zero.
        let lags = time_s / time_constant_s;
        let followed = -libm::expm1(-lags);
        let (remainder, mean) = (1.0 - followed, followed / lags);
        let mean_square = 0.5 * mean * (1.0 + remainder);
        Self { remainder, mean, variance: (mean_square - mean * mean).max(0.0) }
    }
}

/// Voltages at the amplifier's output and at the electrode behind it, V.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Voltages {
    pub(super) output_v: f64,
    pub(super) electrode_v: f64,
}

/// The output follows its target with one lag, and the electrode follows the output with another.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cascade {
    output: Lag,
    electrode: Lag,
    /// Weight of the output's exponential in the electrode's distance, relative to the output's distance.
    coupling: f64,
    /// Covariance of the two exponentials over a tick.
    covariance: f64,
}

impl Cascade {
    pub(super) fn new(output_tau_s: f64, electrode_tau_s: f64, tick_period_s: f64) -> Self {
        // Equal time constants have no partial fractions; a relative difference of 1e-4 is accurate enough.
        let is_equal = (output_tau_s - electrode_tau_s).abs() < 1e-4 * electrode_tau_s;
        let output_tau_s = if is_equal { electrode_tau_s * (1.0 + 1e-4) } else { output_tau_s };
        let (output, electrode) = (Lag::new(output_tau_s, tick_period_s), Lag::new(electrode_tau_s, tick_period_s));
        let product = Lag::new(1.0 / (1.0 / output_tau_s + 1.0 / electrode_tau_s), tick_period_s);
        let coupling = if output_tau_s > 0.0 { output_tau_s / (output_tau_s - electrode_tau_s) } else { 0.0 };
        Self { output, electrode, coupling, covariance: product.mean - output.mean * electrode.mean }
    }

    /// A tick towards `target_v`.
    ///
    /// The output is `u + a e^(-t/ta)`, and the electrode `u + c e^(-t/te) + d e^(-t/ta)` with `d = a ta / (ta - te)`.
    /// The mean of its square is the square of its mean plus its variance, which cannot cancel.
    pub(super) fn tick(&self, voltages: &mut Voltages, target_v: f64) -> Output {
        let a_v = voltages.output_v - target_v;
        let distance_v = voltages.electrode_v - target_v;
        if distance_v.abs() < SETTLED_V && a_v.abs() < SETTLED_V {
            *voltages = Voltages { output_v: target_v, electrode_v: target_v };
            return Output::new(target_v, 0.0, target_v);
        }
        let d_v = a_v * self.coupling;
        let c_v = distance_v - d_v;
        let mean_v = target_v + c_v * self.electrode.mean + d_v * self.output.mean;
        let variance_v2 =
            c_v * c_v * self.electrode.variance + d_v * d_v * self.output.variance + 2.0 * c_v * d_v * self.covariance;
        voltages.output_v = target_v + a_v * self.output.remainder;
        voltages.electrode_v = target_v + c_v * self.electrode.remainder + d_v * self.output.remainder;
        Output::new(mean_v, variance_v2.max(0.0), voltages.electrode_v)
    }
}
