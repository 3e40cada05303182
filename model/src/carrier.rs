//! The carrier between the DAC and the electrode: the loss of rms voltage at its edges, and the electrode current.

use core::f32::consts::FRAC_PI_2;

use crate::Real;
use crate::double_single::square_root;

/// Shape of a carrier.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Waveform {
    /// A square wave between plus and minus its peak: its square has no ripple.
    #[default]
    Square,
    /// A sine wave.
    Sine,
}

/// A carrier that the DAC outputs tick by tick, followed by the first-order lag of amplifier and series resistor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Carrier {
    /// Shape of the carrier.
    pub waveform: Waveform,
    /// Half a period `T`, in seconds.
    pub half_period_s: f32,
    /// Half a period, in ticks: at least 2.
    pub half_period_ticks: u32,
    /// Time constant `tau` of the lag, in seconds; zero if there is no lag.
    ///
    /// An amplifier's lag `a` followed by a series resistor's lag `b` reduces a square wave's mean square like a single
    /// lag of `a + b - a b/(a + b)`: within 0.5 % of the mean square for half periods of 6 `tau` or more.
    pub edge_time_constant_s: f32,
}

/// Current through an electrode.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ElectrodeCurrent {
    /// Root mean square over a period, in amperes.
    pub a_rms: f32,
    /// Peak, in amperes.
    pub a_peak: f32,
}

impl Carrier {
    /// The carrier of a board with `tick_hz` ticks a second.
    pub fn new(waveform: Waveform, half_period_ticks: u32, tick_hz: u32, edge_time_constant_s: f32) -> Self {
        let half_period_s = half_period_ticks as f32 * (1.0 / tick_hz as f32);
        Self { waveform, half_period_s, half_period_ticks, edge_time_constant_s }
    }

    /// Ratio of the peak at the DAC to the rms on the electrode: the crest factor, corrected for the loss in the edges.
    ///
    /// The lag leaves `1 - (2 tau/T) tanh(T/(2 tau))` of a square wave's mean square: the steady response goes from
    /// minus to plus its peak along `1 - 2 exp(-t/tau)/(1 + exp(-T/tau))`.
    ///
    /// A sine is held for one tick at a time, and thus has harmonics. The lag leaves `1 - (1 - cos w) sinh(x)/(x (cosh
    /// x - cos w))` of its mean square, with `x` the time constants in a tick, and `w = pi/H` the angle of a tick for a
    /// half period of `H` ticks. This equals `(h^2 + t^2 (1 - h/(x/2)))/(h^2 + t^2)` with `h = tanh(x/2)` and `t =
    /// tan(w/2)`. For many ticks it becomes the `1/(1 + (pi tau/T)^2)` of a smooth sine.
    ///
    /// ```
    /// use frixel_model::{Carrier, Waveform};
    ///
    /// // 20 us edges take 8 % of the mean square of a 1 kHz square wave.
    /// let carrier = Carrier::new(Waveform::Square, 20, 40_000, 20e-6);
    /// let peak = carrier.peak_per_rms();
    /// assert!((peak * peak * 0.92 - 1.0).abs() < 2e-7);
    /// ```
    pub fn peak_per_rms(&self) -> f32 {
        let has_lag = self.edge_time_constant_s > 0.0;
        let lags = 0.5 * self.half_period_s / self.edge_time_constant_s;
        let ticks = self.half_period_ticks as f32;
        square_root(match self.waveform {
            Waveform::Square if has_lag => 1.0 / tangent_deficit(lags, lags * lags),
            Waveform::Square => 1.0,
            Waveform::Sine if has_lag => 2.0 / held_sine_fraction(lags / ticks, ticks),
            Waveform::Sine => 2.0,
        })
    }

    /// The frequency in Hz.
    pub fn carrier_hz(&self) -> f32 {
        0.5 / self.half_period_s
    }

    /// Largest current into a capacitance of `capacitance_f` farads at a peak `U` of `drive_v_peak` volts at the DAC,
    /// for any scene. Infinite without lag.
    ///
    /// A full swing moves the charge `2 U C` along an exponential: the peak is `2 U C/tau` and, with two swings per
    /// period, the rms is `2 U C sqrt(f/tau)`. These are the values of a square wave at full voltage. They also bound a
    /// sine: it is smooth only while its envelope is, and edges in a texture, or early carrier edges that prevent
    /// direct current, make it jump.
    pub fn electrode_current(&self, capacitance_f: f32, drive_v_peak: f32) -> ElectrodeCurrent {
        let swing_c = 2.0 * capacitance_f * drive_v_peak;
        let carrier_hz = self.carrier_hz();
        ElectrodeCurrent {
            a_rms: swing_c * square_root(carrier_hz / self.edge_time_constant_s),
            a_peak: swing_c / self.edge_time_constant_s,
        }
    }
}

/// Fraction of its mean square that a sine of `half_period_ticks` ticks, each `2 r` time constants long, keeps after a
/// lag.
fn held_sine_fraction(r: f32, half_period_ticks: f32) -> f32 {
    let half_angle = FRAC_PI_2 / half_period_ticks;
    let tan = half_angle * (1.0 - tangent_deficit(half_angle, -(half_angle * half_angle)));
    let kept = tangent_deficit(r, r * r);
    let tanh = r * (1.0 - kept);
    let (tan_squared, tanh_squared) = (tan * tan, tanh * tanh);
    (tanh_squared + tan_squared * kept) / (tanh_squared + tan_squared)
}

/// `1 - tanh(r)/r` if `square` is `r^2`; `1 - tan(r)/r` if it is `-r^2` and `r` is at most pi/4.
///
/// Lambert's continued fraction `tanh(r) = r/(1 + r^2/(3 + r^2/(5 + ...)))` keeps its precision for small `r`, and
/// takes a tenth of the code of `tanh`.
pub(crate) fn tangent_deficit<T: Real>(r: T, square: T) -> T {
    /// Argument from which `tanh` is 1 to the last bit of `f64`.
    const STEEP: f32 = 20.0;
    /// Number of terms after which the remainder is below the last bit, for arguments up to [`STEEP`].
    const TERMS: u16 = 32;
    if r > T::from(STEEP) {
        return T::ONE - T::ONE / r;
    }
    let odd = |term: u16| T::from(f32::from(2 * term + 1));
    let tail = (1..TERMS).rev().fold(odd(TERMS), |tail, term| odd(term) + square / tail);
    square / (tail + square)
}

#[cfg(test)]
mod tests {
    use core::f64::consts::PI;

    use super::*;

    #[test]
    fn the_remaining_mean_square_is_exact() {
        for i in 0..=4000 {
            let r = libm::pow(10.0, f64::from(i) / 1000.0 - 1.0);
            let expected = 1.0 - libm::tanh(r) / r;
            // The reference expression loses digits for small r.
            let tolerance = 4.0 * f64::EPSILON * (1.0 + 1.0 / expected);
            assert!((tangent_deficit(r, r * r) / expected - 1.0).abs() < tolerance, "{r}");
        }
        for r in [1e-3, 1e-6, 1e-9] {
            let series = r * r * (1.0 / 3.0 - r * r * (2.0 / 15.0 - 17.0 / 315.0 * r * r));
            assert!((tangent_deficit(r, r * r) / series - 1.0).abs() < 4.0 * f64::EPSILON, "{r}");
        }
    }

    /// Mean square over the last of twenty periods, integrated step by step.
    fn stepped(wave: impl Fn(f64) -> f64, half_period_s: f64, tau_s: f64) -> f64 {
        let steps = 100_000;
        let step_s = 2.0 * half_period_s / f64::from(steps);
        let followed = -libm::expm1(-step_s / tau_s);
        let (mut v, mut sum) = (0.0_f64, 0.0);
        for i in 0..20 * steps {
            let turns = (f64::from(i) + 0.5) / f64::from(steps);
            v += (wave(turns) - v) * followed;
            if i >= 19 * steps {
                sum += v * v;
            }
        }
        sum / f64::from(steps)
    }

    fn carrier(waveform: Waveform, edge_time_constant_s: f64) -> Carrier {
        let edge_time_constant_s = edge_time_constant_s as f32;
        Carrier { waveform, half_period_s: 500e-6, half_period_ticks: 20, edge_time_constant_s }
    }

    #[test]
    fn peaks_agree_with_waves_integrated_step_by_step() {
        let square = |turns: f64| if turns - libm::floor(turns) < 0.5 { 1.0 } else { -1.0 };
        for tau_s in [5e-6, 20e-6, 400e-6] {
            let peak = f64::from(carrier(Waveform::Square, tau_s).peak_per_rms());
            let found = peak * peak * stepped(square, 500e-6, tau_s);
            assert!((found - 1.0).abs() < 1e-6, "square {tau_s}: {found}");
            for half_period_ticks in [4, 5, 20, 1000] {
                let ticks = f64::from(half_period_ticks);
                let sine = |turns: f64| libm::sin(PI / ticks * libm::floor(2.0 * ticks * turns));
                let carrier = Carrier { half_period_ticks, ..carrier(Waveform::Sine, tau_s) };
                let peak = f64::from(carrier.peak_per_rms());
                let found = peak * peak * stepped(sine, 500e-6, tau_s);
                assert!((found - 1.0).abs() < 1e-6, "sine of {half_period_ticks} ticks, {tau_s}: {found}");
            }
        }
        assert!(carrier(Waveform::Square, 0.0).peak_per_rms() <= 1.0);
        assert!((carrier(Waveform::Sine, 0.0).peak_per_rms() - core::f32::consts::SQRT_2).abs() < 1e-7);
    }

    /// The example of `PROTOCOL.md`.
    #[test]
    fn a_peak_of_60_v_leaves_the_rms_voltages_of_the_protocol() {
        for (waveform, carrier_hz, expected_v_rms) in
            [(Waveform::Square, 1e3, 57.55), (Waveform::Square, 5e3, 46.68), (Waveform::Sine, 5e3, 35.04)]
        {
            let half_period_s = 0.5 / carrier_hz;
            let half_period_ticks = libm::roundf(40e3 * half_period_s) as u32;
            let carrier = Carrier { waveform, half_period_s, half_period_ticks, edge_time_constant_s: 20e-6 };
            let found_v_rms = 60.0 / carrier.peak_per_rms();
            assert!((found_v_rms - expected_v_rms).abs() < 0.005, "{waveform:?} {carrier_hz}: {found_v_rms}");
        }
    }

    /// Rms and peak of the current into a capacitance whose voltage follows a wave of ticks with a lag, integrated step
    /// by step.
    fn stepped_current(wave: impl Fn(i32) -> f64, capacitance_f: f64, tau_s: f64) -> (f64, f64) {
        const STEPS_PER_TICK: i32 = 1000;
        let step_s = 25e-6 / f64::from(STEPS_PER_TICK);
        let (mut v, mut sum, mut peak) = (0.0_f64, 0.0, 0.0_f64);
        for i in 0..200 * STEPS_PER_TICK {
            let current_a = capacitance_f * (wave(i / STEPS_PER_TICK) - v) / tau_s;
            v += current_a * step_s / capacitance_f;
            if i >= 160 * STEPS_PER_TICK {
                sum += current_a * current_a;
                peak = peak.max(current_a.abs());
            }
        }
        (libm::sqrt(sum / f64::from(40 * STEPS_PER_TICK)), peak)
    }

    #[test]
    fn currents_match_an_integrated_square_wave_and_exceed_a_sines() {
        let (capacitance_f, v_peak) = (0.5e-9, 200.0);
        let square = |tick: i32| if tick % 40 < 20 { v_peak } else { -v_peak };
        let sine = |tick: i32| v_peak * libm::sin(2.0 * PI * f64::from(tick) / 40.0);
        for tau_s in [5e-6, 20e-6, 60e-6] {
            let found = carrier(Waveform::Square, tau_s).electrode_current(capacitance_f as f32, v_peak as f32);
            let (found_a_rms, found_a_peak) = (f64::from(found.a_rms), f64::from(found.a_peak));
            let (rms, peak) = stepped_current(square, capacitance_f, tau_s);
            assert!(found_a_rms >= 0.99 * rms && found_a_rms <= 1.02 * rms, "{tau_s}: {found:?}, {rms}");
            assert!(found_a_peak >= 0.99 * peak && found_a_peak <= 1.02 * peak, "{tau_s}: {found:?}, {peak}");
            let (rms, peak) = stepped_current(sine, capacitance_f, tau_s);
            assert!(found_a_rms > rms && found_a_peak > peak, "{tau_s}: {found:?}, {rms}, {peak}");
        }
    }
}
