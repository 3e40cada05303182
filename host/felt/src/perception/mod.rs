//! What a person will feel of a program, as far as published studies can tell.
//!
//! The input is a compiled program. The output is a verdict for each layer, for each border between two layers, and for
//! layers that are too much alike. A change of friction that is slower than 10 Hz under the finger is judged as a
//! step, in Weber fractions of the total friction; a faster one as a texture, against the threshold of touch at its
//! frequency and against the noise of the finger itself. What is too small for the touch source or a fingertip, too
//! slow, too short or too rare is felt less surely. The thresholds and their sources stand in one file,
//! `thresholds.rs`, those of sizes and times in `obstacle.rs`.

mod alike;
mod click;
mod layer;
mod neighbours;
mod obstacle;
mod slide;
mod spectrum;
#[cfg(test)]
mod tests;
mod thresholds;

use std::cmp::Ordering;

use frixel_layers::{Burst, Layer};
use serde::Serialize;

use crate::percentile::percentiles;
pub use alike::AlikeLayers;
use frixel_hil_sim::TouchConfig;
use frixel_scene::reference::Reference;
use frixel_scene::{LayerTitle, Program};
use layer::{Judge, JudgedBorder, JudgedLayer};
pub(crate) use neighbours::{border_reference, border_sides};
use obstacle::{Hindrance, SmallestSize};
pub use obstacle::{Obstacle, SizeLimit};
pub(crate) use slide::{total_n, visible_layers};
pub(crate) use spectrum::component_power;
use thresholds::lag_gain;
pub(crate) use thresholds::{MAYBE, VOLTAGE_DIFFERENCE_DB, WEBER_FRACTION, natural_noise_amplitude_n, texture_range_n};
pub use thresholds::{
    NATURAL_NOISE_RMS_N, THRESHOLD_UNCERTAINTY, Verdict, texture_threshold_n, weber_steps, weber_steps_safe,
    weber_steps_text,
};

/// Sliding speeds at which textures are judged, m/s: slow, usual and fast exploration. Assumed.
const SPEEDS_M_PER_S: [f64; 3] = [0.02, USUAL_M_PER_S, 0.1];
/// The speed at which contrasts are judged, m/s. Assumed.
const USUAL_M_PER_S: f64 = 0.05;
/// Samples a second of the friction along a slide: four times the highest frequency with a threshold.
pub(crate) const SAMPLE_HZ: f64 = 2000.0;
/// A texture of a smaller amplitude is not mentioned, N: a tenth of the smallest threshold.
const AMPLITUDE_MIN_N: f64 = 2e-5;
/// Where the 5th and the 95th percentile are nearer to one another than this part of the whole range, the friction is
/// the same almost everywhere but for a narrow place, such as a ridge. Noise, whose extremes are rare, stays above it.
/// Assumed.
const NARROW_PART: f64 = 0.3;

/// What a person will feel of a program.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Perception {
    /// The layers that are visible somewhere, from bottom to top.
    pub layers: Vec<LayerPerception>,
    /// The steps where one layer borders another.
    pub steps: Vec<BorderStep>,
    /// Layers that a person cannot tell apart by their strength.
    pub alike: Vec<AlikeLayers>,
    /// What only a sliding finger feels, and other notes, a sentence each.
    pub notes: Vec<String>,
}

/// What a person will feel of a layer.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LayerPerception {
    /// The layer's number and title.
    pub layer: LayerTitle,
    /// Whether a person feels the layer in any way but its click: the surest of contrast, textures and border.
    pub verdict: Verdict,
    /// What the contrast is a change with.
    pub over: Over,
    /// From the 5th to the 95th percentile of the friction along a slide over the layer: of ten slides, five along each
    /// side, that of which most is felt. From the least to the largest friction if the layer is an edge, or if
    /// [`Self::is_narrow`]. Over speed, from the friction at 20 mm/s to that at 100 mm/s; over the direction, between a
    /// slide and the slide back; of a stream, from its lowest to its highest sample.
    pub contrast: Step,
    /// Whether the friction is the same almost everywhere in the layer, but for a narrow place that makes the contrast.
    pub is_narrow: bool,
    /// The most noticeable texture at 20, 50 and 100 mm/s; absent where there is none, for an edge, which is a single
    /// ridge, and where all that is felt has steps only, such as a button.
    pub textures: Vec<Texture>,
    /// Of the borders where the layer ends, that which is felt most surely, as a step onto it; absent for a layer without
    /// any.
    pub border: Option<BorderStep>,
    /// The bursts of a vibration, during which contrast and textures hold; absent if they hold all the time.
    pub burst: Option<BurstTimes>,
    /// The step with which the layer's click begins.
    pub click: Option<Step>,
    /// Whether the drive cannot give all of the click.
    pub is_click_cut_off: bool,
}

impl LayerPerception {
    /// The texture that is felt most surely, and of several that which is felt most.
    pub fn surest_texture(&self) -> Option<&Texture> {
        self.textures.iter().max_by(|one, other| {
            let by_verdict = one.verdict.sureness().cmp(&other.verdict.sureness());
            by_verdict.then(one.salience().total_cmp(&other.salience()))
        })
    }
}

/// What friction changes with.
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

/// The times of a vibration's bursts.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct BurstTimes {
    /// How long a burst lasts, ms.
    pub on_ms: f64,
    /// From the start of a burst to that of the next one, ms.
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
    /// Below 1 step not felt, up to 2.3 near the threshold; less where there is an obstacle.
    pub verdict: Verdict,
    /// What makes the verdict less sure than the size of the step.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub obstacle: Option<Obstacle>,
}

impl Step {
    /// The step from one total friction to another, in newtons.
    pub fn new(from_n: f64, to_n: f64) -> Self {
        let steps = weber_steps(from_n, to_n);
        let verdict = Verdict::of_step(steps);
        Self { from_n, to_n, contrast_n: to_n - from_n, weber_steps: steps, verdict, obstacle: None }
    }

    /// The step the other way.
    fn reversed(self) -> Self {
        let Self { from_n, to_n, contrast_n, weber_steps, .. } = self;
        Self { from_n: to_n, to_n: from_n, contrast_n: -contrast_n, weber_steps: -weber_steps, ..self }
    }

    /// Orders steps by how surely they are felt, and then by their size.
    fn cmp_felt(&self, other: &Self) -> Ordering {
        let by_verdict = self.verdict.sureness().cmp(&other.verdict.sureness());
        by_verdict.then(self.weber_steps.abs().total_cmp(&other.weber_steps.abs()))
    }

    /// The same step behind something that hinders a finger.
    fn behind(self, hindrance: Option<Hindrance>) -> Self {
        match hindrance.and_then(|hindrance| hindrance.apply(self.verdict)) {
            Some((verdict, obstacle)) => Self { verdict, obstacle, ..self },
            None => self,
        }
    }
}

/// The most noticeable component of the friction under a finger that slides at a constant speed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Texture {
    /// Sliding speed, mm/s.
    pub speed_mm_per_s: f64,
    /// Frequency under the finger, Hz.
    pub frequency_hz: f64,
    /// Amplitude of the felt friction, behind the lag of friction, N.
    pub amplitude_n: f64,
    /// The smallest amplitude that is felt at this frequency, N; absent where there is no measurement.
    pub threshold_n: Option<f64>,
    /// Amplitude of the finger's own noise in the third of an octave around the frequency, N.
    pub natural_noise_n: f64,
    /// Whether a person feels it.
    pub verdict: Verdict,
    /// What makes the verdict less sure than the amplitude.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub obstacle: Option<Obstacle>,
}

/// A step where one layer borders another.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BorderStep {
    /// The layer on one side; absent for the bare screen.
    pub from: Option<LayerTitle>,
    /// The layer on the other side, which is above.
    pub to: Option<LayerTitle>,
    /// The step in the mean friction.
    pub step: Step,
}

impl Perception {
    /// Judges a program for a finger whose place is known by a touch source.
    ///
    /// ```
    /// use std::collections::BTreeMap;
    /// use frixel_felt::perception::{Perception, Verdict};
    /// use frixel_hil_sim::TouchConfig;
    /// use frixel_scene::{Scene, compile};
    /// # fn judge(text: &str, limits: &frixel_wire::hello::BoardLimits) -> Result<(), frixel_scene::CompileError> {
    /// let program = compile(&Scene::parse(text, "grating.toml", &BTreeMap::new())?, limits, 40_000)?;
    /// for layer in Perception::of(&program, &TouchConfig::REALISTIC).layers {
    ///     println!("{}: {}", layer.layer, layer.verdict.words());
    /// }
    /// # Ok(())
    /// # }
    /// ```
    pub fn of(program: &Program, touch: &TouchConfig) -> Self {
        let smallest = SmallestSize::of(touch);
        // A burst is judged while it lasts.
        let lasting = &without_bursts(program);
        let reference = Reference::new(lasting);
        let borders = neighbours::borders(lasting, USUAL_M_PER_S, smallest.size_m());
        let borders: Vec<JudgedBorder> =
            borders.iter().filter_map(|border| JudgedBorder::new(border, program, &smallest)).collect();
        let judge = Judge { reference: &reference, program, lasting, smallest, borders: &borders };
        let mut judged: Vec<JudgedLayer> = (0..lasting.records.len()).filter_map(|layer| judge.layer(layer)).collect();
        unite_copies(&mut judged, program);
        Self {
            steps: borders.into_iter().map(|border| border.step).collect(),
            alike: alike::of(&judged, program),
            notes: notes(&reference),
            layers: judged.into_iter().map(|judged| judged.perception).collect(),
        }
    }
}

/// Gives copies of a layer that differ only by how they were sampled the numbers of the first one.
fn unite_copies(judged: &mut [JudgedLayer], program: &Program) {
    for number in 1..judged.len() {
        let (before, rest) = judged.split_at_mut(number);
        let Some(copy) = rest.first_mut() else { return };
        let is_like = |one: &&JudgedLayer| alike::are_copies(one, copy, program) && one.is_near(copy);
        let Some(one) = before.iter().find(is_like) else { continue };
        copy.perception = LayerPerception { layer: copy.perception.layer.clone(), ..one.perception.clone() };
    }
}

/// The program with vibrations that do not pause between bursts.
fn without_bursts(program: &Program) -> Program {
    let mut lasting = program.clone();
    for record in &mut lasting.records {
        if let Layer::Vibration(vibration) = &mut record.layer {
            vibration.burst = Burst::default();
        }
    }
    lasting
}

/// The contrast along a slide, and whether only a narrow place makes it; `None` without any friction.
pub(crate) fn contrast_within(friction_n: &[f64], is_edge: bool) -> Option<(Step, bool)> {
    let [least_n, low_n, high_n, most_n] = percentiles(friction_n.to_vec(), [0, 5, 95, 100])?;
    let is_narrow = high_n - low_n < NARROW_PART * (most_n - least_n);
    let is_whole = is_edge || is_narrow;
    Some((if is_whole { Step::new(least_n, most_n) } else { Step::new(low_n, high_n) }, is_narrow))
}

/// Whether any of these layers repeats or changes by itself. The others have steps and lone ridges, whose spectrum is
/// not a texture.
pub(crate) fn has_texture(layers: u64, program: &Program) -> bool {
    let mut records = program.records.iter().enumerate().filter(|(number, _)| layers >> number & 1 == 1);
    records.any(|(_, record)| {
        !matches!(
            record.layer,
            Layer::Constant(_) | Layer::Button(_) | Layer::Edge(_) | Layer::Speed(_) | Layer::Direction(_)
        )
    })
}

impl Texture {
    /// How far it is above the threshold, to compare textures by.
    pub fn salience(&self) -> f64 {
        spectrum::salience_of(self.amplitude_n, self.threshold_n)
    }

    fn of(friction_n: &[f64], speed_m_per_s: f64) -> Option<Self> {
        let speed_mm_per_s = 1e3 * speed_m_per_s;
        let (frequency_hz, amplitude_n) = texture_component(friction_n, speed_mm_per_s)?;
        Self::new(speed_mm_per_s, frequency_hz, lag_gain(speed_mm_per_s / frequency_hz) * amplitude_n)
    }

    /// Judges a felt amplitude in newtons at a frequency; `None` for one that is not mentioned.
    pub(crate) fn new(speed_mm_per_s: f64, frequency_hz: f64, amplitude_n: f64) -> Option<Self> {
        (amplitude_n >= AMPLITUDE_MIN_N).then(|| Self {
            speed_mm_per_s,
            frequency_hz,
            amplitude_n,
            threshold_n: texture_threshold_n(frequency_hz),
            natural_noise_n: natural_noise_amplitude_n(frequency_hz),
            verdict: Verdict::of_texture(amplitude_n, frequency_hz),
            obstacle: None,
        })
    }

    /// The same texture behind something that hinders a finger.
    fn behind(self, hindrance: Option<Hindrance>) -> Self {
        match hindrance.and_then(|hindrance| hindrance.apply(self.verdict)) {
            Some((verdict, obstacle)) => Self { verdict, obstacle, ..self },
            None => self,
        }
    }
}

/// Frequency in Hz and amplitude in newtons, before the lag of friction, of the component of the friction along a slide
/// that is the most noticeable one behind that lag.
pub(crate) fn texture_component(friction_n: &[f64], speed_mm_per_s: f64) -> Option<(f64, f64)> {
    let behind_lag = |frequency_hz: f64| lag_gain(speed_mm_per_s / frequency_hz);
    let component = spectrum::most_noticeable(friction_n, SAMPLE_HZ, behind_lag)?;
    Some((component.frequency_hz, component.amplitude / behind_lag(component.frequency_hz)))
}

fn notes(reference: &Reference) -> Vec<String> {
    if reference.changes_by_itself() {
        vec![
            "Only a sliding finger feels vibrations and streams: of people whose finger rests, 30 % feel 125 Hz \
             (Dryad 9ghx3ffgp)."
                .to_owned(),
        ]
    } else {
        Vec::new()
    }
}
