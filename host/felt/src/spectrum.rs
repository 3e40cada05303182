//! Spectra of signals.

use std::f64::consts::TAU;
use std::ops::Range;

use rustfft::FftPlannerScalar;
use rustfft::num_complex::Complex;

/// The spectrum of a signal, with its mean taken off, under a Hann window.
#[derive(Clone, Debug)]
pub(crate) struct Spectrum {
    /// One value for each frequency from zero to below half of the sampling frequency. Its squared magnitude is the
    /// mean square of the signal at that frequency.
    pub(crate) bins: Vec<Complex<f64>>,
    /// Distance of two frequencies, Hz.
    pub(crate) bin_hz: f64,
}

impl Spectrum {
    /// The spectrum of samples at a sampling frequency in Hz.
    pub(crate) fn of(samples: &[f64], sample_hz: f64) -> Self {
        let count = samples.len();
        let mean = samples.iter().sum::<f64>() / count.max(1) as f64;
        let window = |number: usize| 0.5 - 0.5 * libm::cos(TAU * number as f64 / count as f64);
        let windowed = samples.iter().enumerate();
        let windowed = windowed.map(|(number, sample)| Complex::new(window(number) * (sample - mean), 0.0));
        let mut bins: Vec<Complex<f64>> = windowed.collect();
        FftPlannerScalar::new().plan_fft_forward(count).process(&mut bins);
        bins.truncate(count / 2);
        // The squares of a Hann window sum to 3/8 of its length; each frequency has a negative twin.
        let scale = (2.0 / 0.375_f64).sqrt() / count.max(1) as f64;
        for bin in &mut bins {
            *bin *= scale;
        }
        Self { bins, bin_hz: sample_hz / count.max(1) as f64 }
    }

    /// Mean square at each frequency.
    pub(crate) fn power(&self) -> Vec<f64> {
        self.bins.iter().map(Complex::norm_sqr).collect()
    }
}

/// Root mean square of a signal between two frequencies in Hz, without its mean and under a Hann window; 0 without
/// samples.
pub fn band_rms(samples: &[f64], sample_hz: u32, band_hz: Range<f64>) -> f64 {
    let spectrum = Spectrum::of(samples, f64::from(sample_hz));
    let power = spectrum.power().into_iter().enumerate();
    let inside = power.filter(|(bin, _)| band_hz.contains(&(*bin as f64 * spectrum.bin_hz)));
    inside.map(|(_, power)| power).sum::<f64>().sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sine_is_in_its_band_alone() {
        let sine: Vec<f64> = (0..1 << 14).map(|tick| libm::sin(TAU * 100.3 * f64::from(tick) / 8000.0)).collect();
        assert!((band_rms(&sine, 8000, 90.0..110.0) - 0.5_f64.sqrt()).abs() < 1e-3);
        assert!(band_rms(&sine, 8000, 130.0..4000.0) < 1e-4);
        assert_eq!(band_rms(&[], 8000, 0.0..4000.0).abs().to_bits(), 0.0_f64.to_bits());
    }

    #[test]
    fn the_powers_sum_to_the_mean_square() {
        let sample = |number: u32| 3.0 + 0.5 * libm::sin(0.7 * f64::from(number)) + libm::cos(0.11 * f64::from(number));
        let samples: Vec<f64> = (0..3000).map(sample).collect();
        let sum: f64 = Spectrum::of(&samples, 1000.0).power().iter().sum();
        assert!((sum / (0.125 + 0.5) - 1.0).abs() < 0.01, "{sum}");
    }
}
