//! Steps and textures, with their verdicts.

use std::cmp::Ordering;

use frixel_layers::Layer;
use frixel_scene::reference::Reference;
use frixel_scene::{LayerTitle, Program};
use serde::Serialize;

use super::moment::MOMENT_HZ;
use super::thresholds::{lag_gain, texture_threshold_n};
use super::{Verdict, natural_noise_amplitude_n, spectrum, weber_steps};
use crate::percentile::percentiles;

/// Smallest amplitude of a reported texture, N: a tenth of the smallest threshold.
const AMPLITUDE_MIN_N: f64 = 2e-5;
/// If the distance between the 5th and the 95th percentile is below this fraction of the whole range, friction is
/// uniform except for a narrow place, such as a ridge. Noise, whose extremes are rare, stays above it. Assumed.
const NARROW_PART: f64 = 0.3;

/// The variable with which friction changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Over {
    /// The place of the finger.
    Place,
    /// Time.
    Time,
    /// The speed of the finger.
    Speed,
    /// The direction of its slide.
    Direction,
    /// The samples that a host streams.
    Samples,
}

/// Timing of a vibration's bursts.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct BurstTimes {
    /// Duration of a burst, ms.
    pub on_ms: f64,
    /// Period of the bursts, ms.
    pub period_ms: f64,
}

/// A change of the total friction.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Step {
    /// Total friction before, N.
    pub from_n: f64,
    /// Total friction after, N.
    pub to_n: f64,
    /// `to_n - from_n`.
    pub contrast_n: f64,
    /// The change in Weber steps, `ln(to / from) / ln 1.11`.
    pub weber_steps: f64,
    /// Below 1 step not felt; up to 2.3 steps near the threshold.
    pub verdict: Verdict,
}

impl Step {
    /// The step from one total friction to another, in newtons.
    pub fn new(from_n: f64, to_n: f64) -> Self {
        let steps = weber_steps(from_n, to_n);
        let verdict = Verdict::of_step(steps);
        Self { from_n, to_n, contrast_n: to_n - from_n, weber_steps: steps, verdict }
    }

    /// Orders steps by certainty of perception, and then by size.
    pub(crate) fn cmp_felt(&self, other: &Self) -> Ordering {
        self.verdict.cmp(&other.verdict).then(self.weber_steps.abs().total_cmp(&other.weber_steps.abs()))
    }
}

/// The most noticeable component of the friction under a finger sliding at constant speed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Texture {
    /// Sliding speed, mm/s.
    pub speed_mm_per_s: f64,
    /// Frequency under the finger, Hz.
    pub frequency_hz: f64,
    /// Amplitude of the felt friction, after the lag of friction, N.
    pub amplitude_n: f64,
    /// The smallest perceptible amplitude at this frequency, N; absent without a measurement.
    pub threshold_n: Option<f64>,
    /// Amplitude of the finger's own noise in the third of an octave around the frequency, N.
    pub natural_noise_n: f64,
    /// Whether a person feels it.
    pub verdict: Verdict,
}

/// A step where one layer borders another.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BorderStep {
    /// The layer on one side; absent for the bare screen.
    pub from: Option<LayerTitle>,
    /// The layer on the other side, which is above.
    pub to: Option<LayerTitle>,
    /// The felt part of the step.
    pub step: Step,
}

/// A mean total friction.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Level {
    /// Friction of the scene, N.
    pub scene_n: f64,
    /// Felt friction, N.
    pub felt_n: f64,
}

/// The contrast along a slide, and whether a narrow place makes it; `None` without samples.
pub(super) fn contrast_within(friction_n: &[f64], is_edge: bool) -> Option<(Step, bool)> {
    let [least_n, low_n, high_n, most_n] = percentiles(friction_n.to_vec(), [0, 5, 95, 100])?;
    let is_narrow = high_n - low_n < NARROW_PART * (most_n - least_n);
    let is_whole = is_edge || is_narrow;
    Some((if is_whole { Step::new(least_n, most_n) } else { Step::new(low_n, high_n) }, is_narrow))
}

/// Whether any of these layers is periodic or changes by itself. The others have steps and single ridges, whose
/// spectrum is not a texture.
pub(super) fn has_texture(layers: u64, program: &Program) -> bool {
    let mut records = program.records.iter().enumerate().filter(|(number, _)| layers >> number & 1 == 1);
    records.any(|(_, record)| {
        !matches!(
            record.layer,
            Layer::Constant(_) | Layer::Button(_) | Layer::Edge(_) | Layer::Speed(_) | Layer::Direction(_)
        )
    })
}

impl Texture {
    /// Ratio of the amplitude to the threshold, for comparing textures.
    pub fn salience(&self) -> f64 {
        spectrum::salience_of(self.amplitude_n, self.threshold_n)
    }

    /// Judges a felt amplitude in newtons at a frequency; `None` if it is too small to report.
    pub(super) fn new(speed_mm_per_s: f64, frequency_hz: f64, amplitude_n: f64) -> Option<Self> {
        (amplitude_n >= AMPLITUDE_MIN_N).then(|| Self {
            speed_mm_per_s,
            frequency_hz,
            amplitude_n,
            threshold_n: texture_threshold_n(frequency_hz),
            natural_noise_n: natural_noise_amplitude_n(frequency_hz),
            verdict: Verdict::of_texture(amplitude_n, frequency_hz),
        })
    }
}

/// Returns frequency in Hz and amplitude in newtons, before the lag of friction, of the component along a slide that is
/// most noticeable after that lag.
pub(super) fn texture_component(friction_n: &[f64], speed_mm_per_s: f64) -> Option<(f64, f64)> {
    let behind_lag = |frequency_hz: f64| lag_gain(speed_mm_per_s / frequency_hz);
    let component = spectrum::most_noticeable(friction_n, MOMENT_HZ, behind_lag)?;
    Some((component.frequency_hz, component.amplitude / behind_lag(component.frequency_hz)))
}

/// Total friction, in newtons, with the electric friction clamped to the drive's reach.
pub(super) fn total_n(program: &Program, electric_n: f64) -> f64 {
    program.reach.natural_friction_n + electric_n.clamp(0.0, program.reach.electric_friction_max_n)
}

/// Bit set of the layers that have an effect at a place.
pub(super) fn visible_layers(reference: &Reference, x_m: f64, y_m: f64) -> u64 {
    reference.visible_at(x_m, y_m).fold(0, |visible, layer| visible | 1 << layer)
}
