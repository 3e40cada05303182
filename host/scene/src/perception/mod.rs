//! What a person will feel of a program, as far as published studies can tell.
//!
//! The input is a compiled program. The output is a verdict for each layer, for each border between two layers, and for
//! textures that are too much alike. A change of friction that is slower than 10 Hz under the finger is judged as a
//! step, in Weber fractions of the total friction; a faster one as a texture, against the threshold of touch at its
//! frequency and against the noise of the finger itself. The thresholds and
//! their sources stand in one file, `thresholds.rs`.

mod neighbours;
mod slide;
mod spectrum;
#[cfg(test)]
mod tests;
mod thresholds;

use frixel_layers::Layer;
use serde::Serialize;

use crate::Program;
use crate::percentile::percentiles;
use crate::reach::loaded_contact;
use crate::reference::Reference;
use slide::Slide;
pub use thresholds::{
    NATURAL_NOISE_RMS_N, NOISE_BAND_HZ, TEXTURE_MIN_HZ, VOLTAGE_DIFFERENCE_DB, Verdict, WEBER_FRACTION, lag_gain,
    natural_noise_amplitude_n, texture_threshold_n, weber_steps, weber_steps_safe,
};

/// Sliding speeds at which textures are judged, m/s: slow, usual and fast exploration.
const SPEEDS_M_PER_S: [f64; 3] = [0.02, USUAL_M_PER_S, 0.1];
/// The speed at which contrasts are judged, m/s.
const USUAL_M_PER_S: f64 = 0.05;
/// Samples a second of the friction along a slide: four times the highest frequency with a threshold.
const SAMPLE_HZ: f64 = 2000.0;
/// A texture of a smaller amplitude is not mentioned, N: a tenth of the smallest threshold.
const AMPLITUDE_MIN_N: f64 = 2e-5;
/// Textures whose frequencies differ by less, in octaves, are compared by their voltage. Assumed.
const ALIKE_OCTAVES: f64 = 1.0 / 3.0;

/// What a person will feel of a program.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Perception {
    /// The layers that are visible somewhere, from bottom to top.
    pub layers: Vec<LayerPerception>,
    /// The steps where one layer borders another.
    pub steps: Vec<BorderStep>,
    /// Textures that a person cannot tell apart by their strength.
    pub alike: Vec<AlikeTextures>,
    /// What only a sliding finger feels, and other notes, a sentence each.
    pub notes: Vec<String>,
}

/// What a person will feel of a layer.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LayerPerception {
    /// The layer's title.
    pub layer: String,
    /// From the 5th to the 95th percentile of the friction along a slide over the layer: of ten slides, five along each
    /// side, that with the largest contrast.
    pub contrast: Step,
    /// The most noticeable texture at 20, 50 and 100 mm/s; absent where there is none.
    pub textures: Vec<Texture>,
    /// The layer's click, on the mean friction of the layer.
    pub click: Option<Step>,
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
    /// Below 1 step not felt, up to 2.3 felt by some.
    pub verdict: Verdict,
}

impl Step {
    /// From the 5th to the 95th percentile of frictions, in newtons; `None` without any.
    fn within(friction_n: &[f64]) -> Option<Self> {
        percentiles(friction_n.to_vec(), [5, 95]).map(|[low_n, high_n]| Self::new(low_n, high_n))
    }

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
    /// Title of the layer on one side; absent for the bare screen.
    pub from: Option<String>,
    /// Title of the layer on the other side, which is above.
    pub to: Option<String>,
    /// The step in the mean friction.
    pub step: Step,
}

/// Two textures of about the same frequency whose voltages differ by less than a person can tell.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct AlikeTextures {
    /// Titles of the layers.
    pub layers: [String; 2],
    /// Difference of their voltages at the 95th percentile of their friction, dB.
    pub difference_db: f64,
}

impl Perception {
    /// Judges a program.
    ///
    /// ```
    /// use std::collections::BTreeMap;
    /// use frixel_scene::perception::{Perception, Verdict};
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
        let reference = Reference::new(program);
        let layers: Vec<LayerPerception> =
            (0..program.records.len()).filter_map(|layer| of_layer(layer, &reference, program)).collect();
        let title = |side: Option<usize>| side.and_then(|layer| program.titles.get(layer).cloned());
        let steps = neighbours::borders(program, USUAL_M_PER_S).into_iter().map(|border| {
            let ([from, to], [from_n, to_n]) = (border.sides.map(title), border.friction_n);
            BorderStep { from, to, step: Step::new(from_n, to_n) }
        });
        Self { steps: steps.collect(), alike: alike(&layers, program), notes: notes(&reference), layers }
    }
}

fn of_layer(layer: usize, reference: &Reference, program: &Program) -> Option<LayerPerception> {
    let screen_m = (f64::from(program.header.screen_width_m), f64::from(program.header.screen_height_m));
    let slides = Slide::over(layer, reference.pieces(), screen_m);
    let frictions_n = |speed_m_per_s: f64| -> Vec<Vec<f64>> {
        slides.iter().map(|slide| slide.friction_n(reference, program, speed_m_per_s, SAMPLE_HZ)).collect()
    };
    let slides_n = SPEEDS_M_PER_S.map(frictions_n);
    let [_, usual_n, _] = &slides_n;
    let contrasts = usual_n.iter().filter_map(|friction_n| Step::within(friction_n));
    let contrast = contrasts.max_by(|one, other| one.contrast_n.total_cmp(&other.contrast_n))?;
    let textures = SPEEDS_M_PER_S.into_iter().zip(&slides_n).filter_map(|(speed_m_per_s, frictions_n)| {
        let textures = frictions_n.iter().filter_map(|friction_n| Texture::of(friction_n, speed_m_per_s));
        textures.max_by(|one, other| one.salience().total_cmp(&other.salience()))
    });
    let all_n = usual_n.concat();
    let mean_n = all_n.iter().sum::<f64>() / all_n.len() as f64;
    let click = program.records.get(layer).and_then(|record| record.layer.click());
    Some(LayerPerception {
        layer: program.titles.get(layer)?.clone(),
        contrast,
        textures: textures.collect(),
        click: click.map(|click| Step::new(mean_n, mean_n + f64::from(click.height_n))),
    })
}

impl Texture {
    /// How far it is above the threshold.
    fn salience(&self) -> f64 {
        spectrum::salience_of(self.amplitude_n, self.threshold_n)
    }

    fn of(friction_n: &[f64], speed_m_per_s: f64) -> Option<Self> {
        let speed_mm_per_s = 1e3 * speed_m_per_s;
        let behind_lag = |frequency_hz: f64| lag_gain(speed_mm_per_s / frequency_hz);
        let component = spectrum::most_noticeable(friction_n, SAMPLE_HZ, behind_lag)?;
        let (frequency_hz, amplitude_n) = (component.frequency_hz, component.amplitude);
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

/// A texture that may be felt, as far as a comparison needs it.
struct Comparable<'a> {
    title: &'a str,
    layer: Layer,
    frequency_hz: f64,
    voltage_v_rms: f64,
}

/// Pairs of textures of about the same frequency and voltage. Layers of the same parameters are meant to feel the same.
fn alike(layers: &[LayerPerception], program: &Program) -> Vec<AlikeTextures> {
    // The contact is one: the program's reach was computed from it.
    let Ok(contact) = loaded_contact(&program.header) else { return Vec::new() };
    let comparable = |layer: &LayerPerception| {
        let texture = layer.textures.iter().find(|texture| texture.speed_mm_per_s == 1e3 * USUAL_M_PER_S)?;
        let number = program.titles.iter().position(|title| *title == layer.layer)?;
        let electric_n = layer.contrast.to_n - program.reach.natural_friction_n;
        (electric_n > 0.0 && texture.verdict != Verdict::NotFelt).then_some(Comparable {
            title: program.titles.get(number)?,
            layer: program.records.get(number)?.layer,
            frequency_hz: texture.frequency_hz,
            voltage_v_rms: contact.voltage_v_rms(electric_n),
        })
    };
    let textures: Vec<Comparable> = layers.iter().filter_map(comparable).collect();
    let pairs = textures
        .iter()
        .enumerate()
        .flat_map(|(number, one)| textures.iter().skip(number + 1).map(move |other| (one, other)));
    let alike = pairs.filter_map(|(one, other)| {
        let difference_db = 20.0 * libm::log10(one.voltage_v_rms / other.voltage_v_rms).abs();
        let octaves = libm::log2(one.frequency_hz / other.frequency_hz).abs();
        let is_alike = one.layer != other.layer && octaves < ALIKE_OCTAVES && difference_db < VOLTAGE_DIFFERENCE_DB;
        is_alike.then(|| AlikeTextures { layers: [one, other].map(|texture| texture.title.to_owned()), difference_db })
    });
    alike.collect()
}

fn notes(reference: &Reference) -> Vec<String> {
    let changes_by_itself =
        reference.pieces().iter().any(|piece| piece.is_streamed || piece.field.largest_over_time_n().is_some());
    if changes_by_itself {
        vec![
            "Only a sliding finger feels vibrations and streams: of people whose finger rests, 30 % feel 125 Hz \
             (Dryad 9ghx3ffgp)."
                .to_owned(),
        ]
    } else {
        Vec::new()
    }
}
