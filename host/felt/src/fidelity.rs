//! Fidelity of the felt friction to the friction that a scene defines.
//!
//! The input is a record of a touch: felt friction, and the reference. The reference is the friction that an ideal
//! display would have given the same finger, with the same load and noise. The output is one number for each
//! perceptible property. Bands are separated at 40 Hz. Below, friction is perceived as it changes along the way; above,
//! as vibration, whose phase is not perceived.
//!
//! All numbers compare electric friction, since natural friction is the same in both and would make any display look
//! faithful. Contrast is relative to the total friction. It uses the mean natural friction, since changes of natural
//! friction are not a contrast of the scene. It counts only while the board drives the scene, since switching the
//! output is not one either.
//!
//! Start and end of a touch count as much as its middle. Ratios are absent if the reference is imperceptible.

mod goal;

use std::ops::Range;

use frixel_wire::fault::Flags;
use rustfft::num_complex::Complex;
use serde::Serialize;

use crate::judge::{WEBER_FRACTION, natural_noise_amplitude_n, weber_steps};
use crate::percentile::percentiles;
use crate::recorder::FeltRow;
use crate::spectrum::Spectrum;

pub use goal::{FidelityMean, Goal};

/// Sampling rate, Hz.
pub const SAMPLE_HZ: f64 = 4000.0;
/// Border between perceived friction and perceived vibration, Hz.
const BAND_BORDER_HZ: f64 = 40.0;
/// Upper end of the band of vibrations, Hz.
const BAND_END_HZ: f64 = 400.0;
/// Shortest scored touch, in samples.
const STRETCH_MIN: usize = 1000;
/// Delays that are tried, in samples: from 10 ms early to 100 ms late.
const DELAYS: std::ops::RangeInclusive<i32> = -40..=400;
/// Correlation below which a delay is meaningless.
const CORRELATION_MIN: f64 = 0.1;
/// Relative tolerance for equal covariances.
const ROUNDING: f64 = 1e-9;
/// Window of the mean from which rates are computed, in samples: a quarter of a period at [`BAND_END_HZ`].
const RATE_SAMPLES: usize = 10;
/// Smallest rms of the changes of a reference for which ratios are computed, N: that of the smallest texture with a
/// threshold, whose amplitude is 0.2 mN.
const REFERENCE_MIN_RMS_N: f64 = 1.4e-4;
/// Third octaves from [`BAND_BORDER_HZ`] to [`BAND_END_HZ`].
const THIRD_OCTAVES: u32 = 10;
/// Settling time after the output is switched on and before it is switched off, in samples: 20 ms.
const SETTLING: usize = 80;
/// Flags with which the output is off, regardless of the scene.
const OFF: [Flags; 4] = [Flags::NO_FINGER, Flags::TOUCH_STALE, Flags::STILL, Flags::HOST_SILENT];

/// Ticks per sample, on a board with tick rate `tick_hz`.
pub fn ticks_per_sample(tick_hz: u32) -> u32 {
    (f64::from(tick_hz) / SAMPLE_HZ).round().max(1.0) as u32
}

/// One sample of a record.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FidelitySample {
    /// Time since the power-on of the board, s.
    pub t_s: f64,
    /// The finger's place from the left edge of the screen, m.
    pub x_m: f64,
    /// The finger's place from the top edge of the screen, m.
    pub y_m: f64,
    /// Sliding speed in m/s, while the finger is on the screen and the board has received a report of it. Friction
    /// before the first report is not scored, since the board cannot render it.
    pub speed_m_per_s: Option<f64>,
    /// Total friction of the reference, N.
    pub reference_n: f64,
    /// Total friction that the finger felt, N.
    pub felt_n: f64,
    /// Natural friction, part of both, N.
    pub natural_n: f64,
    /// Whether the board drove the scene. It does not while touch reports are missing or the finger stands still.
    pub is_driven: bool,
}

impl FidelitySample {
    /// Converts a row of a record with [`SAMPLE_HZ`] rows per second, whose reference is filtered through the simulated
    /// finger. `start_s` is the time from the board's power-on to the start of the record.
    pub fn of_row(row: &FeltRow, start_s: f64) -> Self {
        Self {
            t_s: start_s + row.t_s,
            x_m: 1e-3 * row.x_mm.unwrap_or(0.0),
            y_m: 1e-3 * row.y_mm.unwrap_or(0.0),
            speed_m_per_s: row.speed_mm_s.filter(|_| row.is_tracked).map(|speed_mm_s| 1e-3 * speed_mm_s),
            reference_n: row.reference_n.unwrap_or(0.0),
            felt_n: row.felt_n.unwrap_or(0.0),
            natural_n: row.natural_n.unwrap_or(0.0),
            is_driven: row.flags.is_some_and(|flags| !OFF.into_iter().any(|off| flags.contains(off))),
        }
    }

    /// Electric part of the reference, N.
    pub(crate) fn reference_electric_n(&self) -> f64 {
        self.reference_n - self.natural_n
    }

    /// Electric part of the felt friction, N.
    pub(crate) fn felt_electric_n(&self) -> f64 {
        self.felt_n - self.natural_n
    }
}

/// Fidelity of felt friction. Ratios are `None` if the reference is imperceptible.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Fidelity {
    /// Rms error from 0 to 400 Hz, the mean error included, over the rms of the reference without its mean.
    pub error: Option<f64>,
    /// Correlation of felt and reference below 400 Hz.
    pub correlation: Option<f64>,
    /// Rms error below 40 Hz over the rms of the reference, both without their means.
    pub error_below_40_hz: Option<f64>,
    /// Correlation of felt and reference below 40 Hz.
    pub correlation_below_40_hz: Option<f64>,
    /// Rms error below 40 Hz, its mean included, in Weber fractions of the mean reference.
    pub error_weber: f64,
    /// Power of the reference over that of the error below 40 Hz, dB.
    pub snr_below_40_hz_db: Option<f64>,
    /// Power of the reference over that of the error from 40 to 400 Hz, dB.
    pub snr_above_40_hz_db: Option<f64>,
    /// Felt contrast, 5th to 95th percentile of electric friction above the mean natural friction, in Weber steps.
    pub contrast_weber_steps: f64,
    /// The felt contrast over that of the reference, both in Weber steps.
    pub contrast_kept: Option<f64>,
    /// Delay of the felt friction at its best match with the reference, ms; `None` if they are uncorrelated.
    pub delay_ms: Option<f64>,
    /// The delay as a distance at the mean speed, mm.
    pub delay_mm: Option<f64>,
    /// 99th percentile of the rate of change of the felt friction over that of the reference.
    pub peak_rate_kept: Option<f64>,
    /// Spurious friction in the third octaves from 40 to 400 Hz, N: the root of the sum of the powers by which felt
    /// friction exceeds the reference. A band that lost power does not compensate one that gained power. A texture with
    /// the wrong phase is not spurious, since phase is not perceived.
    pub spurious_40_to_400_hz_n: f64,
    /// Third octave with the largest gain, relative to the finger's own noise in it, dB; `None` without any gain.
    pub spurious_over_noise_db: Option<f64>,
}

impl Fidelity {
    /// Scores a record sampled at [`SAMPLE_HZ`]; `None` if no touch lasts a quarter of a second.
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
        let driven = || settled(&scored).flatten();
        let contrast = |electric_n: fn(&FidelitySample) -> f64| {
            percentiles(driven().map(electric_n).collect(), [5, 95])
                .map(|[low_n, high_n]| weber_steps(natural_n + low_n, natural_n + high_n))
        };
        let felt_steps = contrast(FidelitySample::felt_electric_n).unwrap_or(0.0);
        let reference_steps = contrast(FidelitySample::reference_electric_n);
        let felt_rate = peak_rate(&touches, FidelitySample::felt_electric_n)?;
        let reference_rate = peak_rate(&touches, FidelitySample::reference_electric_n)?;
        let Powers { weight, low, high, error_mean, .. } = powers;
        let whole = powers.whole();
        let is_reference_felt = whole.reference >= weight * REFERENCE_MIN_RMS_N * REFERENCE_MIN_RMS_N;
        let ratio = |value: f64| (is_reference_felt && value.is_finite()).then_some(value);
        let delay_s = powers.delay().and_then(ratio).map(|delay| delay / SAMPLE_HZ);
        Some(Self {
            error: ratio(((error_mean + whole.error) / whole.reference).sqrt()),
            correlation: ratio(whole.correlation()),
            error_below_40_hz: ratio((low.error / low.reference).sqrt()),
            correlation_below_40_hz: ratio(low.correlation()),
            error_weber: ((low.error + error_mean) / weight).sqrt() / (WEBER_FRACTION * mean_n),
            snr_below_40_hz_db: ratio(decibels(low.reference / low.error)),
            snr_above_40_hz_db: ratio(decibels(high.reference / high.error)),
            contrast_weber_steps: felt_steps,
            contrast_kept: reference_steps.and_then(|steps| ratio(felt_steps / steps)),
            delay_ms: delay_s.map(|delay_s| 1e3 * delay_s),
            delay_mm: delay_s.map(|delay_s| 1e3 * delay_s * speed_m_per_s),
            peak_rate_kept: ratio(felt_rate / reference_rate),
            spurious_40_to_400_hz_n: (powers.grown().sum::<f64>() / weight).sqrt(),
            spurious_over_noise_db: powers.spurious_over_noise_db(),
        })
    }

    /// The score without ratios, for a reference that changes only with load and skin, and not with the scene.
    #[must_use]
    pub fn without_ratios(self) -> Self {
        let Self { error_weber, contrast_weber_steps, spurious_40_to_400_hz_n, spurious_over_noise_db, .. } = self;
        Self { error_weber, contrast_weber_steps, spurious_40_to_400_hz_n, spurious_over_noise_db, ..Self::default() }
    }
}

/// The parts of a record in which the board drives the scene, without settling times.
pub(crate) fn settled(samples: &[FidelitySample]) -> impl Iterator<Item = &[FidelitySample]> {
    let driven = samples.split(|sample| !sample.is_driven || sample.speed_m_per_s.is_none());
    driven.filter_map(|run| run.get(SETTLING..run.len().checked_sub(SETTLING)?))
}

fn decibels(ratio: f64) -> f64 {
    10.0 * libm::log10(ratio)
}

/// Lower end of a third octave, and upper end of the one before, Hz.
fn third_octave_hz(number: u32) -> f64 {
    BAND_BORDER_HZ * libm::pow(BAND_END_HZ / BAND_BORDER_HZ, f64::from(number) / f64::from(THIRD_OCTAVES))
}

/// Sums over touches, weighted by their length.
#[derive(Clone, Debug, Default)]
struct Powers {
    weight: f64,
    /// Below [`BAND_BORDER_HZ`].
    low: Band,
    /// Up to [`BAND_END_HZ`].
    high: Band,
    /// Square of the mean error, which the spectra omit.
    error_mean: f64,
    /// Covariance at each of [`DELAYS`].
    covariance_by_delay: Vec<f64>,
    /// Power by which felt friction exceeds the reference in each third octave; negative for a loss.
    growth: [f64; THIRD_OCTAVES as usize],
}

/// The powers of a band of frequencies.
#[derive(Clone, Copy, Debug, Default)]
struct Band {
    reference: f64,
    felt: f64,
    error: f64,
    /// Covariance of felt and reference.
    cross: f64,
}

impl Powers {
    fn add(&mut self, touch: &[FidelitySample]) {
        let signal = |value: fn(&FidelitySample) -> f64| touch.iter().map(value).collect::<Vec<f64>>();
        let signals = [
            signal(FidelitySample::reference_electric_n),
            signal(FidelitySample::felt_electric_n),
            signal(|sample| sample.felt_n - sample.reference_n),
        ];
        let [reference_n, felt_n, error_n] = &signals;
        let weight = touch.len() as f64;
        self.weight += weight;
        let mean_n = error_n.iter().sum::<f64>() / weight;
        self.error_mean += weight * mean_n * mean_n;
        let spectra = [reference_n, felt_n, error_n].map(|signal| Spectrum::of_whole(signal, SAMPLE_HZ));
        self.low.add(&spectra, 0.0..BAND_BORDER_HZ, weight);
        self.high.add(&spectra, BAND_BORDER_HZ..BAND_END_HZ, weight);
        let [reference, felt, _] = &spectra;
        self.add_delays(reference, felt, weight);
        let [reference, felt] = [reference_n, felt_n].map(|signal| Spectrum::of_levelled(signal, SAMPLE_HZ));
        for (number, growth) in (0..).zip(&mut self.growth) {
            let band_hz = third_octave_hz(number)..third_octave_hz(number + 1);
            *growth += weight * (felt.band_power(band_hz.clone()) - reference.band_power(band_hz));
        }
    }

    fn add_delays(&mut self, reference: &Spectrum, felt: &Spectrum, weight: f64) {
        let low_hz = 0.0..BAND_BORDER_HZ;
        let pairs = reference.band(low_hz.clone()).iter().zip(felt.band(low_hz));
        let cross: Vec<Complex<f64>> = pairs.map(|(reference, felt)| felt * reference.conj()).collect();
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

    /// Both bands.
    fn whole(&self) -> Band {
        let Self { low, high, .. } = self;
        Band {
            reference: low.reference + high.reference,
            felt: low.felt + high.felt,
            error: low.error + high.error,
            cross: low.cross + high.cross,
        }
    }

    /// Delay of the largest covariance, in samples; the smallest one if several are equal within rounding, as for a
    /// grating's periods. `None` if felt friction and reference are uncorrelated.
    fn delay(&self) -> Option<f64> {
        let largest = self.covariance_by_delay.iter().copied().max_by(f64::total_cmp)?;
        let likeness = CORRELATION_MIN * (self.low.reference * self.low.felt).sqrt();
        let delays = self.covariance_by_delay.iter().zip(DELAYS);
        let best = delays.filter(|(covariance, _)| **covariance >= largest * (1.0 - ROUNDING));
        best.map(|(_, delay)| f64::from(delay)).min_by_key(|delay| delay.abs() as u32).filter(|_| largest > likeness)
    }

    /// Power gains of the third octaves.
    fn grown(&self) -> impl Iterator<Item = f64> {
        self.growth.iter().map(|growth| growth.max(0.0))
    }

    fn spurious_over_noise_db(&self) -> Option<f64> {
        let over_noise = (0..).zip(self.grown()).map(|(number, growth)| {
            let middle_hz = (third_octave_hz(number) * third_octave_hz(number + 1)).sqrt();
            let amplitude_n = natural_noise_amplitude_n(middle_hz);
            growth / self.weight / (0.5 * amplitude_n * amplitude_n)
        });
        over_noise.filter(|ratio| *ratio > 0.0).max_by(f64::total_cmp).map(decibels)
    }
}

impl Band {
    /// Adds the powers of a touch from the spectra of reference, felt friction and error.
    fn add(&mut self, spectra: &[Spectrum; 3], band_hz: Range<f64>, weight: f64) {
        let [reference, felt, error] = spectra;
        self.reference += weight * reference.band_power(band_hz.clone());
        self.felt += weight * felt.band_power(band_hz.clone());
        self.error += weight * error.band_power(band_hz.clone());
        let pairs = reference.band(band_hz.clone()).iter().zip(felt.band(band_hz));
        self.cross += weight * pairs.map(|(reference, felt)| (felt * reference.conj()).re).sum::<f64>();
    }

    /// Correlation of felt friction and reference; 0 for a display that adds nothing, so that it still counts in a
    /// mean.
    fn correlation(&self) -> f64 {
        let scale = (self.reference * self.felt).sqrt();
        if scale > 0.0 { self.cross / scale } else { 0.0 }
    }
}

/// 99th percentile of the magnitude of the rate of change of a running mean over [`RATE_SAMPLES`].
fn peak_rate(touches: &[&[FidelitySample]], value: fn(&FidelitySample) -> f64) -> Option<f64> {
    let rates = touches.iter().flat_map(|touch| {
        let sums: Vec<f64> = touch.windows(RATE_SAMPLES).map(|window| window.iter().map(value).sum()).collect();
        let later = sums.iter().skip(RATE_SAMPLES);
        sums.iter().zip(later).map(|(from, to)| (to - from).abs()).collect::<Vec<f64>>()
    });
    percentiles(rates.collect(), [99]).map(|[rate]| rate)
}

#[cfg(test)]
mod tests;
