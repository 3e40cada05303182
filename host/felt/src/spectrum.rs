//! Spectra of signals.

use std::f64::consts::TAU;
use std::ops::Range;
use std::sync::Arc;

use rustfft::algorithm::{BluesteinsAlgorithm, Radix4};
use rustfft::num_complex::Complex;
use rustfft::{Fft, FftDirection};

/// The spectrum of a signal.
#[derive(Clone, Debug)]
pub(crate) struct Spectrum {
    /// One value per frequency, from zero to below half the sampling frequency. Its squared magnitude is the mean
    /// square of the signal at that frequency.
    pub(crate) bins: Vec<Complex<f64>>,
    /// Frequency resolution, Hz.
    pub(crate) bin_hz: f64,
}

impl Spectrum {
    /// Spectrum of a part of a longer signal, without its mean, under a Hann window, which hides both ends.
    pub(crate) fn of(samples: &[f64], sample_hz: f64) -> Self {
        let count = samples.len() as f64;
        let mean = samples.iter().sum::<f64>() / count.max(1.0);
        let windowed = (0_u32..).zip(samples).map(|(number, sample)| {
            let window = 0.5 - 0.5 * libm::cos(TAU * f64::from(number) / count);
            window * (sample - mean)
        });
        // The squares of a Hann window sum to 3/8 of its length.
        Self::transform(windowed, samples.len(), sample_hz, 1.0 / 0.375)
    }

    /// Spectrum of a whole signal, without its mean: every sample counts the same.
    pub(crate) fn of_whole(samples: &[f64], sample_hz: f64) -> Self {
        let mean = samples.iter().sum::<f64>() / samples.len().max(1) as f64;
        Self::transform(samples.iter().map(|sample| sample - mean), samples.len(), sample_hz, 1.0)
    }

    /// Spectrum of a whole signal without the line through its two ends, since a jump from the last sample to the first
    /// would spread over all frequencies.
    pub(crate) fn of_levelled(samples: &[f64], sample_hz: f64) -> Self {
        let (Some(first), Some(last)) = (samples.first(), samples.last()) else {
            return Self::of_whole(samples, sample_hz);
        };
        let slope = (last - first) / (samples.len().max(2) - 1) as f64;
        let levelled: Vec<f64> =
            (0_u32..).zip(samples).map(|(number, sample)| sample - first - slope * f64::from(number)).collect();
        Self::of_whole(&levelled, sample_hz)
    }

    /// `scale` compensates for the power lost in a window.
    fn transform(signal: impl Iterator<Item = f64>, count: usize, sample_hz: f64, scale: f64) -> Self {
        let mut bins: Vec<Complex<f64>> = signal.map(|sample| Complex::new(sample, 0.0)).collect();
        transform(&mut bins);
        bins.truncate(count / 2);
        // Each frequency has a negative counterpart.
        let scale = (2.0 * scale).sqrt() / count.max(1) as f64;
        for bin in &mut bins {
            *bin *= scale;
        }
        Self { bins, bin_hz: sample_hz / count.max(1) as f64 }
    }

    /// The bins of a band, from a frequency in Hz to below another.
    pub(crate) fn band(&self, band_hz: Range<f64>) -> &[Complex<f64>] {
        let bin = |frequency_hz: f64| ((frequency_hz / self.bin_hz).ceil() as usize).min(self.bins.len());
        self.bins.get(bin(band_hz.start)..bin(band_hz.end)).unwrap_or_default()
    }

    /// Mean square of the signal in a band.
    pub(crate) fn band_power(&self, band_hz: Range<f64>) -> f64 {
        self.band(band_hz).iter().map(Complex::norm_sqr).sum()
    }

    /// Mean square at each frequency.
    pub(crate) fn power(&self) -> Vec<f64> {
        self.bins.iter().map(Complex::norm_sqr).collect()
    }
}

/// Replaces a signal of any length by its discrete Fourier transform.
///
/// Other lengths than powers of two use Bluestein's algorithm. A planner would bring every algorithm into the page.
fn transform(signal: &mut [Complex<f64>]) {
    let radix4 = |length| Radix4::new(length, FftDirection::Forward);
    match signal.len() {
        0 => {}
        length if length.is_power_of_two() => radix4(length).process(signal),
        length => {
            let inner = Arc::new(radix4((2 * length).next_power_of_two()));
            BluesteinsAlgorithm::new(length, inner).process(signal);
        }
    }
}

/// Root mean square of a signal between two frequencies in Hz, without its mean and under a Hann window; 0 without
/// samples.
pub fn band_rms(samples: &[f64], sample_hz: u32, band_hz: Range<f64>) -> f64 {
    Spectrum::of(samples, f64::from(sample_hz)).band_power(band_hz).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_transform_of_any_length_is_the_sum_that_defines_it() {
        for length in 0..40_u32 {
            let signal: Vec<_> = (0..length).map(|at| Complex::new(libm::sin(f64::from(at * at)), 0.0)).collect();
            let mut found = signal.clone();
            transform(&mut found);
            for (bin, found) in (0..length).zip(found) {
                let turn = |at: u32| Complex::cis(-TAU * f64::from(bin * at) / f64::from(length));
                let expected: Complex<f64> = (0..length).zip(&signal).map(|(at, value)| turn(at) * value).sum();
                assert!((found - expected).norm() < 1e-12, "bin {bin} of {length}: {found} for {expected}");
            }
        }
    }

    #[test]
    fn a_sine_is_in_its_band_alone() {
        let sine: Vec<f64> = (0..1 << 14).map(|tick| libm::sin(TAU * 100.3 * f64::from(tick) / 8000.0)).collect();
        assert!((band_rms(&sine, 8000, 90.0..110.0) - 0.5_f64.sqrt()).abs() < 1e-3);
        assert!(band_rms(&sine, 8000, 130.0..4000.0) < 1e-4);
        assert_eq!(band_rms(&[], 8000, 0.0..4000.0).abs().to_bits(), 0.0_f64.to_bits());
    }

    /// A jump at the ends, as of a line, is not power of the signal.
    #[test]
    fn a_levelled_line_has_no_power_and_a_landing_counts_in_a_whole_signal() {
        let line: Vec<f64> = (0..2000).map(f64::from).collect();
        let power = |spectrum: &Spectrum| spectrum.power().iter().sum::<f64>();
        assert!(power(&Spectrum::of_levelled(&line, 1000.0)) < 1e-12);
        // The first twentieth is missing, and nothing hides it.
        let landing: Vec<f64> = (0..2000).map(|number| if number < 100 { 0.0 } else { 1.0 }).collect();
        assert!((power(&Spectrum::of_whole(&landing, 1000.0)) / (0.05 * 0.95) - 1.0).abs() < 0.01);
    }

    #[test]
    fn the_powers_sum_to_the_mean_square() {
        let sample = |number: u32| 3.0 + 0.5 * libm::sin(0.7 * f64::from(number)) + libm::cos(0.11 * f64::from(number));
        let samples: Vec<f64> = (0..3000).map(sample).collect();
        let sum: f64 = Spectrum::of(&samples, 1000.0).power().iter().sum();
        assert!((sum / (0.125 + 0.5) - 1.0).abs() < 0.01, "{sum}");
    }
}
