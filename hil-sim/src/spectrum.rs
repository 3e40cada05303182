//! The power of a signal in a band of frequencies.

use core::f64::consts::TAU;
use core::ops::Range;

/// Root mean square of a signal between two frequencies, from its Fourier transform under a Hann window and without its
/// mean. Only the first `2^n` samples count; of fewer than two it is 0.
pub fn band_rms(samples: &[f64], sample_hz: u32, band_hz: Range<f64>) -> f64 {
    if samples.len() < 2 {
        return 0.0;
    }
    let count = 1_usize << samples.len().ilog2();
    let mean = samples.iter().take(count).sum::<f64>() / count as f64;
    let mut spectrum: Vec<(f64, f64)> = samples
        .iter()
        .take(count)
        .enumerate()
        .map(|(index, sample)| {
            let hann = 1.0 - libm::cos(TAU * index as f64 / count as f64);
            ((sample - mean) * hann, 0.0)
        })
        .collect();
    transform(&mut spectrum);
    let bin_hz = f64::from(sample_hz) / count as f64;
    let inside = |bin: &(usize, &(f64, f64))| band_hz.contains(&(bin.0 as f64 * bin_hz));
    let half = spectrum.iter().enumerate().take(count / 2);
    let power: f64 = half.filter(inside).map(|(_, (re, im))| re * re + im * im).sum();
    // The window's mean square is 1.5; a real signal has as much power at negative frequencies.
    (2.0 * power / 1.5).sqrt() / count as f64
}

/// Fast Fourier transform of `2^n` numbers (Cooley and Tukey).
fn transform(values: &mut [(f64, f64)]) {
    let count = values.len();
    let bits = count.ilog2();
    for index in 0..count {
        let mirrored = index.reverse_bits() >> (usize::BITS - bits);
        if mirrored > index {
            values.swap(index, mirrored);
        }
    }
    let mut half = 1;
    while half < count {
        let turns: Vec<(f64, f64)> =
            (0..half).map(|step| libm::sincos(-TAU * step as f64 / (2 * half) as f64)).map(|(s, c)| (c, s)).collect();
        for block in values.chunks_exact_mut(2 * half) {
            let (low, high) = block.split_at_mut(half);
            for ((a, b), (c, s)) in low.iter_mut().zip(high).zip(&turns) {
                let turned = (b.0 * c - b.1 * s, b.0 * s + b.1 * c);
                (*a, *b) = ((a.0 + turned.0, a.1 + turned.1), (a.0 - turned.0, a.1 - turned.1));
            }
        }
        half *= 2;
    }
}

#[test]
fn a_sine_is_in_its_band_alone() {
    let sine: Vec<f64> = (0..1 << 14).map(|tick| libm::sin(TAU * 100.3 * f64::from(tick) / 8000.0)).collect();
    assert!((band_rms(&sine, 8000, 90.0..110.0) - 0.5_f64.sqrt()).abs() < 1e-3);
    assert!(band_rms(&sine, 8000, 130.0..4000.0) < 1e-4);
}
