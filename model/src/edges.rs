//! What a carrier loses in its edges: the mean square of a wave behind a first-order lag.

use core::f64::consts::PI;

/// Part of the mean square voltage that a square wave keeps behind a first-order lag, from 0 to 1.
///
/// With half period `T` and time constant `tau`, in seconds, `1 - (2 tau/T) tanh(T/(2 tau))`: the steady response goes
/// from minus to plus its peak along `1 - 2 exp(-t/tau)/(1 + exp(-T/tau))`. No lag (`tau` zero) loses nothing.
///
/// ```
/// // 20 us edges take 8 % of the mean square of a 1 kHz square wave.
/// let left = frixel_model::square_mean_square_left(500e-6, 20e-6);
/// assert!((left - 0.92).abs() < 1e-9);
/// ```
pub fn square_mean_square_left(half_period_s: f64, edge_time_constant_s: f64) -> f64 {
    if !(edge_time_constant_s > 0.0) {
        return 1.0;
    }
    let ratio = half_period_s / (2.0 * edge_time_constant_s);
    1.0 - libm::tanh(ratio) / ratio
}

/// Part of the mean square voltage that a sine keeps behind a first-order lag, from 0 to 1: `1/(1 + (w tau)^2)` with
/// `w = pi/T`.
pub fn sine_mean_square_left(half_period_s: f64, edge_time_constant_s: f64) -> f64 {
    let lag = PI / half_period_s * edge_time_constant_s;
    1.0 / (1.0 + lag * lag)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Mean square over the last of twenty periods, stepped through.
    fn stepped(wave: impl Fn(f64) -> f64, half_period_s: f64, tau_s: f64) -> f64 {
        let steps = 100_000;
        let step_s = 2.0 * half_period_s / f64::from(steps);
        let (mut v, mut sum) = (0.0_f64, 0.0);
        for i in 0..20 * steps {
            let turns = (f64::from(i) + 0.5) / f64::from(steps);
            v += (wave(turns) - v) * step_s / tau_s;
            if i >= 19 * steps {
                sum += v * v;
            }
        }
        sum / f64::from(steps)
    }

    #[test]
    fn both_agree_with_a_wave_integrated_step_by_step() {
        let square = |turns: f64| if turns - libm::floor(turns) < 0.5 { 1.0 } else { -1.0 };
        let sine = |turns: f64| libm::sqrt(2.0) * libm::sin(2.0 * PI * turns);
        for tau_s in [5e-6, 20e-6, 400e-6] {
            let found = square_mean_square_left(500e-6, tau_s);
            assert!((found - stepped(square, 500e-6, tau_s)).abs() < 1e-3, "square {tau_s}");
            let found = sine_mean_square_left(500e-6, tau_s);
            assert!((found - stepped(sine, 500e-6, tau_s)).abs() < 1e-3, "sine {tau_s}");
        }
        assert!(square_mean_square_left(500e-6, 0.0) >= 1.0);
    }
}
