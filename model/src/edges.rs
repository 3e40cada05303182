//! What a carrier loses in its edges, behind the first-order lag of amplifier and series resistor.

use core::f64::consts::PI;

/// Peak that a square wave needs before a first-order lag for an rms of one after it.
///
/// With half period `T` and time constant `tau`, in seconds, the lag leaves `1 - (2 tau/T) tanh(T/(2 tau))` of the mean
/// square: the steady response goes from minus to plus its peak along `1 - 2 exp(-t/tau)/(1 + exp(-T/tau))`. No lag
/// (`tau` zero) loses nothing.
///
/// ```
/// // 20 us edges take 8 % of the mean square of a 1 kHz square wave.
/// let peak = frixel_model::square_peak_per_rms(500e-6, 20e-6);
/// assert!((peak * peak * 0.92 - 1.0).abs() < 1e-9);
/// ```
pub fn square_peak_per_rms(half_period_s: f64, edge_time_constant_s: f64) -> f64 {
    if !(edge_time_constant_s > 0.0) {
        return 1.0;
    }
    let ratio = half_period_s / (2.0 * edge_time_constant_s);
    1.0 / libm::sqrt(1.0 - libm::tanh(ratio) / ratio)
}

/// Peak that a sine needs before a first-order lag for an rms of one after it: `sqrt(2 (1 + (w tau)^2))` with
/// `w = pi/T`.
pub fn sine_peak_per_rms(half_period_s: f64, edge_time_constant_s: f64) -> f64 {
    let lag = PI / half_period_s * edge_time_constant_s;
    libm::sqrt(2.0 * (1.0 + lag * lag))
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
        let sine = |turns: f64| libm::sin(2.0 * PI * turns);
        for tau_s in [5e-6, 20e-6, 400e-6] {
            let peak = square_peak_per_rms(500e-6, tau_s);
            assert!((peak * peak * stepped(square, 500e-6, tau_s) - 1.0).abs() < 1e-3, "square {tau_s}");
            let peak = sine_peak_per_rms(500e-6, tau_s);
            assert!((peak * peak * stepped(sine, 500e-6, tau_s) - 1.0).abs() < 1e-3, "sine {tau_s}");
        }
        assert!(square_peak_per_rms(500e-6, 0.0) <= 1.0);
    }
}
