//! The strongest component of a friction signal.

use std::ops::Range;

use super::fingertip::running_sums;
use super::thresholds::{TEXTURE_MIN_HZ, texture_threshold_n};
use crate::spectrum::Spectrum;

/// Smallest number of samples for finding a component.
const SAMPLES_MIN: usize = 64;
/// Smallest fraction of the signal's power; a weaker component is a harmonic or numerical noise. Assumed.
pub(super) const POWER_PART_MIN: f64 = 0.05;
/// Half width of a component, in bins: a Hann window spreads a sine over two bins on either side.
const SPREAD_BINS: usize = 2;
/// Half width of a component, as a factor of its frequency: a sixth of an octave on either side.
const SIXTH_OF_OCTAVE: f64 = 1.122_462_048_309_373;

/// A spectral component: a sine, or the noise of a third of an octave as a sine of the same power.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Component {
    pub(super) frequency_hz: f64,
    /// Amplitude of a sine of the same power.
    pub(super) amplitude: f64,
}

/// Returns the component that exceeds the threshold of touch by the largest factor. `gain` is a factor by frequency in
/// Hz, which is applied to its amplitude. If no frequency has a threshold, returns the component of the largest
/// amplitude. `None` if the signal is too short, or has no component above [`TEXTURE_MIN_HZ`] with 5 % of its power.
pub(super) fn most_noticeable(samples: &[f64], sample_hz: f64, gain: impl Fn(f64) -> f64) -> Option<Component> {
    if samples.len() < SAMPLES_MIN {
        return None;
    }
    let spectrum = Spectrum::of(samples, sample_hz);
    let (power, bin_hz) = (spectrum.power(), spectrum.bin_hz);
    let cumulative = running_sums(&power);
    let first = ((TEXTURE_MIN_HZ / bin_hz).ceil() as usize).max(SPREAD_BINS + 1);
    let peaks = (first..power.len()).filter(|bin| is_largest(&power, *bin));
    let power_min = POWER_PART_MIN * cumulative.last().copied().unwrap_or_default();
    let components = peaks.filter_map(|bin| {
        let around = around(bin, power.len());
        let sum = cumulative.get(around.end).zip(cumulative.get(around.start)).map_or(0.0, |(to, from)| to - from);
        let frequency_hz = (bin as f64 + offset(&power, bin)) * bin_hz;
        let component = Component { frequency_hz, amplitude: gain(frequency_hz) * (2.0 * sum.max(0.0)).sqrt() };
        (sum >= power_min).then_some(component)
    });
    components.max_by(|one, other| salience(one).total_cmp(&salience(other)))
}

/// Distance of a sine from its largest bin, in bins: for a Hann window, the ratio of that bin and the larger one beside
/// it states the distance.
fn offset(power: &[f64], bin: usize) -> f64 {
    let amplitude = |bin: Option<usize>| bin.and_then(|bin| power.get(bin)).map_or(0.0, |power| power.sqrt());
    let (left, here, right) = (amplitude(bin.checked_sub(1)), amplitude(Some(bin)), amplitude(bin.checked_add(1)));
    let ratio = left.max(right) / here;
    let offset = ((2.0 * ratio - 1.0) / (ratio + 1.0)).clamp(0.0, 0.5);
    if left > right { -offset } else { offset }
}

/// Mean square of the signal in the component around a frequency.
pub(crate) fn component_power(spectrum: &Spectrum, frequency_hz: f64) -> f64 {
    let power = spectrum.power();
    let bin = (frequency_hz / spectrum.bin_hz).round() as usize;
    power.get(around(bin, power.len())).unwrap_or_default().iter().sum()
}

/// The bins of a component with its largest bin at `bin`.
fn around(bin: usize, bins: usize) -> Range<usize> {
    let low = ((bin as f64 / SIXTH_OF_OCTAVE).ceil() as usize).min(bin.saturating_sub(SPREAD_BINS));
    let high = ((bin as f64 * SIXTH_OF_OCTAVE).floor() as usize).max(bin + SPREAD_BINS);
    low..(high + 1).min(bins)
}

/// Ratio of a component to its threshold; components without a threshold come last.
fn salience(component: &Component) -> f64 {
    salience_of(component.amplitude, texture_threshold_n(component.frequency_hz))
}

/// Ratio of an amplitude to its threshold, for comparing textures.
pub(super) fn salience_of(amplitude_n: f64, threshold_n: Option<f64>) -> f64 {
    threshold_n.map_or_else(|| 1e-6 * amplitude_n, |threshold_n| amplitude_n / threshold_n)
}

/// Whether a bin has the most power of its component.
fn is_largest(power: &[f64], bin: usize) -> bool {
    let here = power.get(bin).copied().unwrap_or(0.0);
    let around = power.get(around(bin, power.len())).unwrap_or_default();
    here > 0.0 && around.iter().all(|power| *power <= here)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    const SAMPLE_HZ: f64 = 2000.0;

    fn sines(count: usize, sines: &[(f64, f64)]) -> Vec<f64> {
        let at = |t_s: f64| sines.iter().map(|(hz, amplitude)| amplitude * libm::sin(TAU * hz * t_s)).sum::<f64>();
        (0..count).map(|number| 0.3 + at(number as f64 / SAMPLE_HZ)).collect()
    }

    #[test]
    fn a_sine_has_its_frequency_and_amplitude() {
        for (count, hz) in [(4000, 40.0), (1000, 63.0), (700, 211.0), (512, 90.0)] {
            let component = most_noticeable(&sines(count, &[(hz, 0.02)]), SAMPLE_HZ, |_| 1.0).unwrap();
            assert!((component.frequency_hz - hz).abs() <= 0.05 * SAMPLE_HZ / count as f64, "{component:?}");
            assert!((component.amplitude / 0.02 - 1.0).abs() < 0.02, "{component:?}");
        }
    }

    /// The gain takes from 200 Hz what made it more noticeable than 40 Hz.
    #[test]
    fn what_is_most_noticeable_is_judged_behind_the_gain() {
        let both = sines(4000, &[(40.0, 0.02), (200.0, 0.006)]);
        let ahead = most_noticeable(&both, SAMPLE_HZ, |_| 1.0).unwrap();
        assert!((ahead.frequency_hz - 200.0).abs() < 1.0, "{ahead:?}");
        let behind = most_noticeable(&both, SAMPLE_HZ, |hz| if hz > 100.0 { 1e-3 } else { 0.5 }).unwrap();
        assert!((behind.frequency_hz - 40.0).abs() < 1.0 && (behind.amplitude - 0.01).abs() < 1e-4, "{behind:?}");
    }

    /// 4.5 % of the power: a harmonic of what is felt as a step.
    #[test]
    fn a_small_part_of_the_power_is_no_component() {
        let small = |amplitude| most_noticeable(&sines(4000, &[(5.0, 0.02), (200.0, amplitude)]), SAMPLE_HZ, |_| 1.0);
        assert_eq!(small(0.0043), None);
        assert!((small(0.0048).unwrap().frequency_hz - 200.0).abs() < 1.0);
    }

    #[test]
    fn slow_changes_constants_and_short_signals_have_no_component() {
        assert_eq!(most_noticeable(&vec![0.25; 4000], SAMPLE_HZ, |_| 1.0), None);
        assert_eq!(most_noticeable(&sines(63, &[(200.0, 0.02)]), SAMPLE_HZ, |_| 1.0), None);
        let slow = most_noticeable(&sines(4000, &[(2.0, 0.02)]), SAMPLE_HZ, |_| 1.0);
        assert!(slow.is_none_or(|component| component.amplitude < 1e-6), "{slow:?}");
    }
}
