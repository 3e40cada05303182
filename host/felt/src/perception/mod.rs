//! What a person will feel of a program, as far as published studies can tell.
//!
//! The input is a compiled program. The output is a verdict for each layer, for each border between two layers, and for
//! layers that are too much alike. A change of friction that is slower than 10 Hz under the finger is judged as a
//! step, in Weber fractions of the total friction; a faster one as a texture, against the threshold of touch at its
//! frequency and against the noise of the finger itself. The thresholds and
//! their sources stand in one file, `thresholds.rs`.

mod alike;
mod click;
mod neighbours;
mod slide;
mod spectrum;
#[cfg(test)]
mod tests;
mod thresholds;

use frixel_layers::{Burst, Direction, Layer};
use serde::Serialize;

use crate::percentile::percentiles;
pub use alike::AlikeLayers;
use click::ClickStep;
use frixel_scene::reference::Reference;
use frixel_scene::{LayerTitle, Program};
pub(crate) use neighbours::{border_reference, border_sides};
use slide::Slide;
pub(crate) use slide::{total_n, visible_layers};
pub(crate) use spectrum::component_power;
use thresholds::lag_gain;
pub use thresholds::{
    NATURAL_NOISE_RMS_N, Verdict, texture_threshold_n, weber_steps, weber_steps_safe, weber_steps_text,
};
pub(crate) use thresholds::{NEAR_THRESHOLD, VOLTAGE_DIFFERENCE_DB, WEBER_FRACTION, natural_noise_amplitude_n};

/// Sliding speeds at which textures are judged, m/s: slow, usual and fast exploration.
const SPEEDS_M_PER_S: [f64; 3] = [0.02, USUAL_M_PER_S, 0.1];
/// The speed at which contrasts are judged, m/s.
const USUAL_M_PER_S: f64 = 0.05;
/// Samples a second of the friction along a slide: four times the highest frequency with a threshold.
pub(crate) const SAMPLE_HZ: f64 = 2000.0;
/// A texture of a smaller amplitude is not mentioned, N: a tenth of the smallest threshold.
const AMPLITUDE_MIN_N: f64 = 2e-5;
/// Frictions of the copies of a layer that differ by less are the same, N: a slide meets the top of a narrow ridge only
/// as exactly as its samples lie.
const SAMPLING_N: f64 = 2e-4;
/// Where the 5th and the 95th percentile are nearer to one another than this part of the whole range, the friction is
/// the same almost everywhere but for a narrow place, such as a ridge. Noise, whose extremes are rare, stays above it.
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
    /// From the 5th to the 95th percentile of the friction along a slide over the layer: of ten slides, five along each
    /// side, that with the largest contrast. From the least to the largest friction if the layer is an edge, or if
    /// [`Self::is_narrow`].
    pub contrast: Step,
    /// Whether the contrast is that of a slide and the same one back, because the layer depends on the direction.
    pub is_by_direction: bool,
    /// Whether the friction is the same almost everywhere in the layer, but for a narrow place that makes the contrast.
    pub is_narrow: bool,
    /// The most noticeable texture at 20, 50 and 100 mm/s; absent where there is none, for an edge, which is a single
    /// ridge, and where all that is felt has steps only, such as a button.
    pub textures: Vec<Texture>,
    /// The bursts during which contrast and textures hold; absent if they hold all the time.
    pub burst: Option<BurstTimes>,
    /// The step with which the layer's click begins.
    pub click: Option<Step>,
    /// Whether the drive cannot give all of the click.
    pub is_click_cut_off: bool,
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
    /// Below 1 step not felt, up to 2.3 near the threshold.
    pub verdict: Verdict,
}

impl Step {
    /// The step from one total friction to another, in newtons.
    pub fn new(from_n: f64, to_n: f64) -> Self {
        let steps = weber_steps(from_n, to_n);
        Self { from_n, to_n, contrast_n: to_n - from_n, weber_steps: steps, verdict: Verdict::of_step(steps) }
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
    /// Judges a program.
    ///
    /// ```
    /// use std::collections::BTreeMap;
    /// use frixel_felt::perception::{Perception, Verdict};
    /// use frixel_scene::{Scene, compile};
    /// # fn judge(text: &str, limits: &frixel_wire::hello::BoardLimits) -> Result<(), frixel_scene::CompileError> {
    /// let program = compile(&Scene::parse(text, "grating.toml", &BTreeMap::new())?, limits, 40_000)?;
    /// for layer in Perception::of(&program).layers {
    ///     println!("{}: {}", layer.layer, layer.contrast.verdict.words());
    /// }
    /// # Ok(())
    /// # }
    /// ```
    pub fn of(program: &Program) -> Self {
        // A burst is judged while it lasts, however rare it is.
        let lasting = &without_bursts(program);
        let reference = Reference::new(lasting);
        let mut judged: Vec<JudgedLayer> = (0..lasting.records.len())
            .filter_map(|layer| JudgedLayer::new(layer, &reference, program, lasting))
            .collect();
        unite_copies(&mut judged, program);
        let steps =
            neighbours::borders(lasting, USUAL_M_PER_S).into_iter().filter_map(|border| border_step(&border, program));
        Self {
            steps: steps.collect(),
            alike: alike::of(&judged, program),
            notes: notes(&reference),
            layers: judged.into_iter().map(|judged| judged.perception).collect(),
        }
    }
}

/// Gives copies of a layer the same contrast and click, if they differ only by how they were sampled.
fn unite_copies(judged: &mut [JudgedLayer], program: &Program) {
    let are_near = |one: &Step, other: &Step| {
        (one.from_n - other.from_n).abs() < SAMPLING_N && (one.to_n - other.to_n).abs() < SAMPLING_N
    };
    for number in 1..judged.len() {
        let (before, rest) = judged.split_at_mut(number);
        let Some(copy) = rest.first_mut() else { return };
        let is_like = |one: &&JudgedLayer| {
            alike::are_copies(one, copy, program) && are_near(&one.perception.contrast, &copy.perception.contrast)
        };
        let Some(one) = before.iter().find(is_like) else { continue };
        copy.perception.contrast = one.perception.contrast;
        if let (Some(click), Some(of_copy)) = (one.perception.click, &mut copy.perception.click)
            && are_near(&click, of_copy)
        {
            *of_copy = click;
        }
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

/// The step at a border; `None` where a ridge ends in nothing, which is no step.
fn border_step(border: &neighbours::Border, program: &Program) -> Option<BorderStep> {
    let ([from, to], [from_n, to_n]) = (border.sides, border.friction_n);
    let step = Step::new(from_n, to_n);
    let is_edge =
        |layer: usize| program.records.get(layer).is_some_and(|record| matches!(record.layer, Layer::Edge(_)));
    let ends_a_ridge = [from, to].into_iter().flatten().any(is_edge) && step.verdict == Verdict::NotFelt;
    let title = |side: Option<usize>| side.and_then(|layer| program.titles.get(layer).cloned());
    (!ends_a_ridge).then(|| BorderStep { from: title(from), to: title(to), step })
}

/// A layer with what its comparison with others needs.
#[derive(Clone, Debug)]
struct JudgedLayer {
    /// Index from the bottom.
    layer: usize,
    /// The layers that act on its slides, a bit each.
    visible: u64,
    perception: LayerPerception,
}

impl JudgedLayer {
    /// Judges a layer, with those below it but without those above it, which are judged themselves; `None` if it is
    /// visible nowhere. `lasting` is `program` without pauses between bursts, and `reference` belongs to it.
    fn new(layer: usize, reference: &Reference, program: &Program, lasting: &Program) -> Option<Self> {
        let screen_m = (f64::from(program.header.screen_width_m), f64::from(program.header.screen_height_m));
        let record = program.records.get(layer)?;
        let over = Slide::over(layer, reference, screen_m);
        let slides = match record.layer {
            Layer::Direction(Direction { angle_turns, .. }) => {
                let along = Slide::along(angle_turns.into(), layer, reference, screen_m);
                over.into_iter().chain(along).flat_map(|slide| [slide, slide.back()]).collect()
            }
            _ => over,
        };
        let uncovered = reference.clone().with_only(|other| other <= layer);
        let slides_n = SPEEDS_M_PER_S.map(|speed_m_per_s| -> Vec<Vec<f64>> {
            slides.iter().map(|slide| slide.friction_n(&uncovered, lasting, speed_m_per_s, SAMPLE_HZ)).collect()
        });
        let [_, usual_n, _] = &slides_n;
        let is_edge = matches!(record.layer, Layer::Edge(_));
        let is_by_direction = matches!(record.layer, Layer::Direction(_));
        let ways_n = usual_n.chunks(if is_by_direction { 2 } else { 1 });
        let contrasts = ways_n.filter_map(|way_n| contrast_within(&way_n.concat(), is_edge));
        let (contrast, is_narrow) =
            contrasts.max_by(|(one, _), (other, _)| one.contrast_n.total_cmp(&other.contrast_n))?;
        let visible = slides.iter().fold(0, |visible, slide| visible | slide.visible_layers(reference));
        let felt = visible & (u64::MAX >> (63 - layer));
        let has_texture = !is_edge && has_texture(felt, program);
        let textures = SPEEDS_M_PER_S.into_iter().zip(&slides_n).filter(|_| has_texture).filter_map(
            |(speed_m_per_s, frictions_n)| {
                let textures = frictions_n.iter().filter_map(|friction_n| Texture::of(friction_n, speed_m_per_s));
                textures.max_by(|one, other| one.salience().total_cmp(&other.salience()))
            },
        );
        let click = ClickStep::of(layer, &slides, lasting, USUAL_M_PER_S);
        let perception = LayerPerception {
            layer: program.titles.get(layer)?.clone(),
            contrast,
            is_by_direction,
            is_narrow,
            textures: textures.collect(),
            burst: burst(felt, program),
            click: click.map(|click| click.step),
            is_click_cut_off: click.is_some_and(|click| click.is_cut_off),
        };
        Some(Self { layer, visible, perception })
    }
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

/// The bursts of the topmost of these layers that has any.
fn burst(layers: u64, program: &Program) -> Option<BurstTimes> {
    let acts = |(number, _): &(usize, _)| layers >> number & 1 == 1;
    program.records.iter().enumerate().filter(acts).rev().find_map(|(_, record)| match record.layer {
        Layer::Vibration(vibration) if vibration.burst.period_s > 0.0 => Some(BurstTimes {
            on_ms: 1e3 * f64::from(vibration.burst.on_s),
            period_ms: 1e3 * f64::from(vibration.burst.period_s),
        }),
        _ => None,
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
        })
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
