//! How faithfully a finger felt the friction that a scene defines.
//!
//! The input is a record of a touch: the friction that the finger felt, and the reference: the friction that a display
//! without any fault would have given the same finger under the same load, with the same noise. The output is a number
//! for each property that a person notices. Bands are separated at 40 Hz: below, a person feels friction as it changes
//! along the way; above, as vibration, whose phase nobody feels.
//!
//! All of them compare the electric parts of the two: natural friction is the same in both, and would make any display
//! look faithful. For contrast, which is relative to the total friction, the mean natural friction takes the place of
//! the natural friction of each moment, whose own changes are no contrast of the scene.

use rustfft::num_complex::Complex;
use serde::Serialize;

use crate::percentile::percentiles;
use crate::perception::{WEBER_FRACTION, weber_steps};
use crate::recorder::FeltRow;
use crate::spectrum::Spectrum;

/// Samples a second.
pub const SAMPLE_HZ: f64 = 4000.0;
/// The border between what is felt as friction and what is felt as vibration, Hz.
pub const BAND_BORDER_HZ: f64 = 40.0;
/// Upper end of the band of vibrations, Hz.
pub const BAND_END_HZ: f64 = 400.0;
/// A shorter stretch of touch is not scored, in samples.
const STRETCH_MIN: usize = 1000;
/// Delays that are tried, in samples: from 10 ms early to 100 ms late.
const DELAYS: std::ops::RangeInclusive<i32> = -40..=400;
/// Correlation at a delay below which it says nothing.
const CORRELATION_MIN: f64 = 0.1;
/// Samples of the mean from which rates are taken: a quarter of a period at [`BAND_END_HZ`].
const RATE_SAMPLES: usize = 10;

/// One sample of a record.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FidelitySample {
    /// Sliding speed in m/s, while the finger is on the screen and the board has had a report of it. Friction before the
    /// first report cannot be right and is not scored.
    pub speed_m_per_s: Option<f64>,
    /// Total friction of the reference, N.
    pub reference_n: f64,
    /// Total friction that the finger felt, N.
    pub felt_n: f64,
    /// Natural friction, which both have, N.
    pub natural_n: f64,
}

impl From<&FeltRow> for FidelitySample {
    /// A row of a record with [`SAMPLE_HZ`] rows a second, whose reference goes through the simulated finger.
    fn from(row: &FeltRow) -> Self {
        Self {
            speed_m_per_s: row.speed_mm_s.filter(|_| row.is_tracked).map(|speed_mm_s| 1e-3 * speed_mm_s),
            reference_n: row.wanted_n.unwrap_or(0.0),
            felt_n: row.felt_n.unwrap_or(0.0),
            natural_n: row.natural_n.unwrap_or(0.0),
        }
    }
}

impl FidelitySample {
    /// Electric part of the reference, N.
    fn reference_electric_n(&self) -> f64 {
        self.reference_n - self.natural_n
    }

    /// Electric part of what the finger felt, N.
    fn felt_electric_n(&self) -> f64 {
        self.felt_n - self.natural_n
    }
}

/// How faithfully friction was felt.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Fidelity {
    /// Rms error below 40 Hz over the rms of the reference, both without their means.
    pub error_below_40_hz: f64,
    /// Correlation of felt and reference below 40 Hz.
    pub correlation_below_40_hz: f64,
    /// Rms error below 40 Hz, its mean included, in Weber fractions of the mean reference.
    pub error_weber: f64,
    /// Power of the reference over that of the error below 40 Hz, dB.
    pub snr_below_40_hz_db: f64,
    /// Power of the reference over that of the error from 40 to 400 Hz, dB.
    pub snr_above_40_hz_db: f64,
    /// Felt contrast, 5th to 95th percentile of electric friction above the mean natural friction, in Weber steps.
    pub contrast_weber_steps: f64,
    /// The felt contrast over that of the reference, both in Weber steps.
    pub contrast_kept: f64,
    /// Delay of the felt friction, at which it is most like the reference, ms.
    pub delay_ms: f64,
    /// The same as a distance at the mean speed, mm.
    pub delay_mm: f64,
    /// 99th percentile of the rate of change of the felt friction over that of the reference.
    pub peak_rate_kept: f64,
    /// What the felt friction has beyond the reference from 40 to 400 Hz, N: the root of the difference of the two
    /// powers, 0 if it has less. A texture that is out of phase, which nobody feels, is not spurious.
    pub spurious_40_to_400_hz_n: f64,
}

impl Fidelity {
    /// Scores a record of [`SAMPLE_HZ`] samples a second; `None` without a touch of a quarter of a second.
    pub fn of(samples: &[FidelitySample]) -> Option<Self> {
        let touches = samples.split(|sample| sample.speed_m_per_s.is_none());
        let touches: Vec<&[FidelitySample]> = touches.filter(|touch| touch.len() >= STRETCH_MIN).collect();
        let mut powers = Powers::default();
        for touch in &touches {
            powers.add(touch);
        }
        let scored = touches.concat();
        let mean = |value: fn(&FidelitySample) -> f64| scored.iter().map(value).sum::<f64>() / scored.len() as f64;
        let mean_n = mean(|sample| sample.reference_n);
        let speed_m_per_s = mean(|sample| sample.speed_m_per_s.unwrap_or(0.0));
        let natural_n = mean(|sample| sample.natural_n);
        let contrast = |electric_n: fn(&FidelitySample) -> f64| {
            let [low_n, high_n] = percentiles(scored.iter().map(electric_n).collect(), [5, 95])?;
            Some(weber_steps(natural_n + low_n, natural_n + high_n))
        };
        let felt_steps = contrast(FidelitySample::felt_electric_n)?;
        let reference_steps = contrast(FidelitySample::reference_electric_n)?;
        let delay_s = powers.delay() / SAMPLE_HZ;
        Some(Self {
            error_below_40_hz: (powers.error_low / powers.reference_low).sqrt(),
            correlation_below_40_hz: powers.correlation_low(),
            error_weber: ((powers.error_low + powers.error_mean) / powers.weight).sqrt() / (WEBER_FRACTION * mean_n),
            snr_below_40_hz_db: 10.0 * libm::log10(powers.reference_low / powers.error_low),
            snr_above_40_hz_db: 10.0 * libm::log10(powers.reference_high / powers.error_high),
            contrast_weber_steps: felt_steps,
            contrast_kept: felt_steps / reference_steps,
            delay_ms: 1e3 * delay_s,
            delay_mm: 1e3 * delay_s * speed_m_per_s,
            peak_rate_kept: peak_rate(&touches, FidelitySample::felt_electric_n)?
                / peak_rate(&touches, FidelitySample::reference_electric_n)?,
            spurious_40_to_400_hz_n: ((powers.felt_high - powers.reference_high).max(0.0) / powers.weight).sqrt(),
        })
    }
}

/// Sums over touches, weighted by their length.
#[derive(Clone, Debug, Default)]
struct Powers {
    weight: f64,
    reference_low: f64,
    reference_high: f64,
    felt_low: f64,
    felt_high: f64,
    error_low: f64,
    /// Square of the mean error, which the spectrum leaves out.
    error_mean: f64,
    error_high: f64,
    /// Covariance of felt and reference.
    cross_low: f64,
    /// Covariance at each of [`DELAYS`].
    covariance_by_delay: Vec<f64>,
}

impl Powers {
    fn add(&mut self, touch: &[FidelitySample]) {
        let spectrum =
            |value: fn(&FidelitySample) -> f64| Spectrum::of(&touch.iter().map(value).collect::<Vec<f64>>(), SAMPLE_HZ);
        let reference = spectrum(FidelitySample::reference_electric_n);
        let felt = spectrum(FidelitySample::felt_electric_n);
        let error = spectrum(|sample| sample.felt_n - sample.reference_n);
        let weight = touch.len() as f64;
        let border = (BAND_BORDER_HZ / reference.bin_hz) as usize;
        let end = (BAND_END_HZ / reference.bin_hz) as usize;
        let sum = |spectrum: &Spectrum, from: usize, to: usize| {
            weight * spectrum.bins.get(from..to).unwrap_or_default().iter().map(Complex::norm_sqr).sum::<f64>()
        };
        self.weight += weight;
        self.reference_low += sum(&reference, 0, border);
        self.reference_high += sum(&reference, border, end);
        self.felt_low += sum(&felt, 0, border);
        self.felt_high += sum(&felt, border, end);
        self.error_low += sum(&error, 0, border);
        let mean_n = touch.iter().map(|sample| sample.felt_n - sample.reference_n).sum::<f64>() / weight;
        self.error_mean += weight * mean_n * mean_n;
        self.error_high += sum(&error, border, end);
        let pairs = reference.bins.iter().zip(&felt.bins).take(border);
        let cross: Vec<_> = pairs.map(|(reference, felt)| felt * reference.conj()).collect();
        self.cross_low += weight * cross.iter().map(|cross| cross.re).sum::<f64>();
        self.covariance_by_delay.resize(DELAYS.count(), 0.0);
        for (covariance, delay) in self.covariance_by_delay.iter_mut().zip(DELAYS) {
            let turn = std::f64::consts::TAU * reference.bin_hz * f64::from(delay) / SAMPLE_HZ;
            let at = |(bin, cross): (usize, &Complex<f64>)| {
                let angle = turn * bin as f64;
                cross.re * libm::cos(angle) - cross.im * libm::sin(angle)
            };
            *covariance += weight * cross.iter().enumerate().map(at).sum::<f64>();
        }
    }

    /// Correlation of felt and reference; 0 for a display that adds nothing, so that it does not drop out of a mean.
    fn correlation_low(&self) -> f64 {
        let scale = (self.reference_low * self.felt_low).sqrt();
        if scale > 0.0 { self.cross_low / scale } else { 0.0 }
    }

    /// The delay of the largest covariance, in samples; not-a-number where felt and reference have nothing in common.
    fn delay(&self) -> f64 {
        let likeness = CORRELATION_MIN * (self.reference_low * self.felt_low).sqrt();
        let delays = self.covariance_by_delay.iter().zip(DELAYS).filter(|(covariance, _)| **covariance > likeness);
        delays.max_by(|(one, _), (other, _)| one.total_cmp(other)).map_or(f64::NAN, |(_, delay)| f64::from(delay))
    }
}

/// 99th percentile of the magnitude of the rate of change of a mean over [`RATE_SAMPLES`].
fn peak_rate(touches: &[&[FidelitySample]], value: fn(&FidelitySample) -> f64) -> Option<f64> {
    let rates = touches.iter().flat_map(|touch| {
        let sums: Vec<f64> = touch.windows(RATE_SAMPLES).map(|window| window.iter().map(value).sum()).collect();
        let later = sums.iter().skip(RATE_SAMPLES);
        sums.iter().zip(later).map(|(from, to)| (to - from).abs()).collect::<Vec<f64>>()
    });
    percentiles(rates.collect(), [99]).map(|[rate]| rate)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    const SPEED_M_PER_S: f64 = 0.1;

    /// A finger over a grating of 10 Hz and 20 mN; `felt_n` makes the felt friction from the time.
    fn scored(felt_n: impl Fn(f64) -> f64) -> Fidelity {
        let sample = |number: u32| {
            let t_s = f64::from(number) / SAMPLE_HZ;
            FidelitySample {
                speed_m_per_s: Some(SPEED_M_PER_S),
                reference_n: grating_n(t_s),
                felt_n: felt_n(t_s),
                natural_n: 0.3,
            }
        };
        Fidelity::of(&(0..8000).map(sample).collect::<Vec<_>>()).unwrap()
    }

    fn grating_n(t_s: f64) -> f64 {
        0.3 + 0.02 * libm::sin(TAU * 10.0 * t_s)
    }

    #[test]
    fn a_display_without_fault_is_perfect() {
        let fidelity = scored(grating_n);
        assert_eq!(fidelity.error_below_40_hz.to_bits(), 0.0_f64.to_bits());
        assert_eq!(fidelity.delay_ms.to_bits(), 0.0_f64.to_bits());
        for one in [fidelity.correlation_below_40_hz, fidelity.contrast_kept, fidelity.peak_rate_kept] {
            assert!((one - 1.0).abs() < 1e-12, "{fidelity:?}");
        }
    }

    #[test]
    fn a_delay_is_found_in_ms_and_mm() {
        let fidelity = scored(|t_s| grating_n(t_s - 0.015));
        assert!((fidelity.delay_ms - 15.0).abs() <= 0.25, "{fidelity:?}");
        assert!((fidelity.delay_mm - 1.5).abs() <= 0.03, "{fidelity:?}");
        // |1 - e^(i w T)| = 2 sin(w T / 2), against the sine itself.
        let expected = 2.0 * libm::sin(std::f64::consts::PI * 10.0 * 0.015);
        assert!((fidelity.error_below_40_hz / expected - 1.0).abs() < 0.02, "{fidelity:?}");
        assert!((fidelity.correlation_below_40_hz - libm::cos(TAU * 10.0 * 0.015)).abs() < 0.01, "{fidelity:?}");
    }

    #[test]
    fn half_of_the_contrast_is_half() {
        let fidelity = scored(|t_s| 0.3 + 0.5 * (grating_n(t_s) - 0.3));
        assert!((fidelity.contrast_kept - 0.5).abs() < 0.01, "{fidelity:?}");
        assert!((fidelity.peak_rate_kept - 0.5).abs() < 1e-6, "{fidelity:?}");
        assert!((fidelity.snr_below_40_hz_db - 6.02).abs() < 0.1, "{fidelity:?}");
        // An rms of 10 mN / sqrt(2) is 0.214 fractions of 0.11 times 0.3 N.
        assert!((fidelity.error_weber - 0.01 / 2.0_f64.sqrt() / 0.033).abs() < 0.01, "{fidelity:?}");
    }

    #[test]
    fn force_that_the_scene_does_not_have_is_spurious() {
        let fidelity = scored(|t_s| grating_n(t_s) + 0.004 * libm::sin(TAU * 150.0 * t_s));
        assert!((fidelity.spurious_40_to_400_hz_n / (0.004 / 2.0_f64.sqrt()) - 1.0).abs() < 0.01, "{fidelity:?}");
        assert!(fidelity.error_below_40_hz < 1e-3, "{fidelity:?}");
    }

    /// The same texture of 150 Hz, a quarter of a period late: nobody feels its phase.
    #[test]
    fn a_texture_out_of_phase_is_an_error_and_not_spurious() {
        let texture = |number: u32, late: f64| 0.004 * libm::sin(TAU * (150.0 * f64::from(number) / SAMPLE_HZ - late));
        let sample = |number: u32| FidelitySample {
            speed_m_per_s: Some(SPEED_M_PER_S),
            reference_n: 0.3 + texture(number, 0.0),
            felt_n: 0.3 + texture(number, 0.25),
            natural_n: 0.3,
        };
        let fidelity = Fidelity::of(&(0..8000).map(sample).collect::<Vec<_>>()).unwrap();
        assert!(fidelity.spurious_40_to_400_hz_n < 1e-4, "{fidelity:?}");
        assert!((fidelity.snr_above_40_hz_db + 3.01).abs() < 0.1, "{fidelity:?}");
    }

    /// Natural friction that changes by more than the grating, which a display without output does not take part in.
    #[test]
    fn natural_friction_makes_no_display_look_faithful() {
        let sample = |number: u32| {
            let t_s = f64::from(number) / SAMPLE_HZ;
            let natural_n = 0.3 + 0.1 * libm::sin(TAU * 3.0 * t_s);
            let reference_n = natural_n + grating_n(t_s) - 0.3;
            FidelitySample { speed_m_per_s: Some(SPEED_M_PER_S), reference_n, felt_n: natural_n, natural_n }
        };
        let fidelity = Fidelity::of(&(0..8000).map(sample).collect::<Vec<_>>()).unwrap();
        assert!((fidelity.error_below_40_hz - 1.0).abs() < 1e-9, "{fidelity:?}");
        assert!(fidelity.correlation_below_40_hz.abs() < 1e-12, "{fidelity:?}");
        assert!(fidelity.contrast_weber_steps.abs() < 1e-12, "{fidelity:?}");
        assert!(fidelity.contrast_kept.abs() < 1e-12, "{fidelity:?}");
    }

    #[test]
    fn a_flat_output_keeps_no_contrast_and_a_short_touch_has_no_score() {
        let flat = scored(|_| 0.25);
        assert!(flat.contrast_kept.abs() < 1e-12 && flat.error_below_40_hz > 0.99, "{flat:?}");
        assert!(flat.delay_ms.is_nan(), "{flat:?}");
        // 50 mN too little, and the rms of the grating.
        let rms_n = 0.05_f64.hypot(0.02 / 2.0_f64.sqrt());
        assert!((flat.error_weber / (rms_n / 0.033) - 1.0).abs() < 0.01, "{flat:?}");
        assert_eq!(Fidelity::of(&[FidelitySample::default(); 100]), None);
    }
}
