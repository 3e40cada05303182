//! The judge: predicts the perception of each element of a scene from published studies.
//!
//! [`strokes`] moves a finger across an element, at 20, 50 and 100 mm/s. [`verdict`] compares felt friction in these
//! plays with the reference. This crate has no simulator: [`judge`] calls back for each play. `frixel check`, the page
//! and `frixel score` use these two; `frixel play` judges its own recording with [`in_play`].
//!
//! A change of friction that a fingertip resolves (2 mm) is judged as a step, in Weber fractions of the total friction.
//! A faster one is judged as a texture, against the threshold of touch at its frequency and the finger's own noise. An
//! element is perceived by its contrast, texture, border or click, at the best of the three speeds. Thresholds of
//! perception and their sources are in `thresholds.rs`.

mod advice;
mod alike;
mod border;
mod element;
mod fingertip;
mod layer_verdict;
mod likeness;
mod measure;
mod moment;
mod named;
mod reason;
mod spectrum;
mod step;
#[cfg(test)]
mod tests;
mod texture;
mod thresholds;
mod touch;
mod way;

use std::cmp::Ordering;

use frixel_hil_sim::Stroke;
use frixel_layers::{Layer, Stream};
use frixel_scene::Program;
use frixel_scene::reference::Reference;

use crate::GoesOn;
use crate::fidelity::FidelitySample;
pub use alike::AlikeLayers;
use element::SPEEDS_M_PER_S;
pub use element::{Element, strokes};
use layer_verdict::SceneFeel;
pub use layer_verdict::{Judgement, LayerVerdict};
pub use measure::changes_along;
use measure::{Measure, Measured};
use moment::Moment;
pub use named::{listed_briefly, starts_off};
pub use reason::{Reason, SizeLimit};
pub(crate) use spectrum::component_power;
pub use step::{BorderStep, BurstTimes, Level, Over, Step, Texture};
use step::{contrast_within, has_texture, texture_component, total_n, visible_layers};
pub(crate) use thresholds::{MAYBE, THRESHOLD_UNCERTAINTY, VOLTAGE_DIFFERENCE_DB, natural_noise_amplitude_n};
pub use thresholds::{NATURAL_NOISE_RMS_N, Verdict, WEBER_FRACTION, weber_steps, weber_steps_safe, weber_steps_text};

/// Whether a judgement includes advice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Advice {
    /// Verdicts only.
    Omitted,
    /// For an element that is not certainly perceived because of its size or strength, seeks a change that makes it
    /// perceptible.
    Sought,
}

/// Plays a program under a stroke, and returns samples at [`SAMPLE_HZ`](crate::fidelity::SAMPLE_HZ).
pub type Play<'p, E> = dyn FnMut(&Program, &Stroke) -> Result<Vec<FidelitySample>, E> + 'p;

/// Judges every layer of a program. Copies of a layer are judged once.
pub fn judge<E>(program: &Program, advice: Advice, play: &mut Play<'_, E>) -> Result<Judgement, E> {
    let mut judged: Vec<(Element, LayerVerdict)> = Vec::new();
    for element in (0..program.records.len()).filter_map(|layer| Element::of(program, layer)) {
        let copy = judged.iter().find(|(other, _)| element.is_copy_of(other));
        let found = match copy {
            Some((_, found)) => found.of_copy(&element),
            None => judge_element(&element, advice, play)?,
        };
        judged.push((element, found));
    }
    Ok(Judgement {
        alike: alike::of(&judged, program),
        notes: notes(program),
        layers: judged.into_iter().map(|(_, verdict)| verdict).collect(),
    })
}

fn judge_element<E>(element: &Element, advice: Advice, play: &mut Play<'_, E>) -> Result<LayerVerdict, E> {
    let strokes = if element.is_streamed() { Vec::new() } else { strokes(element) };
    let felt = strokes.iter().map(|stroke| play(element.program(), stroke)).collect::<Result<Vec<_>, E>>()?;
    let found = verdict(element, &felt);
    if advice == Advice::Omitted || !found.reasons.iter().any(Reason::is_size_or_strength) {
        return Ok(found);
    }
    for change in advice::changes(element, &found) {
        if is_felt(&change.element, play)? {
            return Ok(LayerVerdict { advice: Some(format!("felt with {}", change.text)), ..found });
        }
    }
    let advice = Some("no size or strength within the drive's reach makes it felt".to_owned());
    Ok(LayerVerdict { advice, ..found })
}

/// Whether an element is perceived at one of the speeds. The fastest stroke takes an eighth of the total time, and is
/// played first.
fn is_felt<E>(element: &Element, play: &mut Play<'_, E>) -> Result<bool, E> {
    let strokes = strokes(element);
    let mut felt = vec![Vec::new(); strokes.len()];
    for (number, stroke) in strokes.iter().enumerate().rev() {
        if let Some(samples) = felt.get_mut(number) {
            *samples = play(element.program(), stroke)?;
        }
        if verdict(element, &felt).verdict == Verdict::Felt {
            return Ok(true);
        }
    }
    Ok(false)
}

/// Judges an element by the felt friction on its [`strokes`]. The samples also contain the reference.
pub fn verdict(element: &Element, felt: &[Vec<FidelitySample>]) -> LayerVerdict {
    let measure = Measure::new(element);
    let speeds = SPEEDS_M_PER_S.iter().zip(felt);
    let mut plays: Vec<PlayPerception> = speeds
        .filter_map(|(speed_m_per_s, samples)| {
            PlayPerception::of(&measure, Some(*speed_m_per_s), &measure.runs(samples))
        })
        .collect();
    let over = element.over();
    if over == Over::Speed {
        over_speed(element, &mut plays);
    }
    of_plays(element, over, &plays)
}

/// Judges the elements of a program by one unchanged play, with any finger, load and touch source. An element is
/// omitted if the finger never slid on it while the board drove the scene. It is also omitted if its friction depends
/// on the speed, since a single play has no second speed to compare with. `goes_on` is called before each element; if
/// it breaks, there is no judgement.
pub fn in_play(program: &Program, samples: &[FidelitySample], goes_on: GoesOn<'_>) -> Option<Vec<LayerVerdict>> {
    let slides = |speed_m_per_s: f64| speed_m_per_s >= SLIDE_MIN_M_PER_S;
    let sliding = |sample: &FidelitySample| FidelitySample {
        is_driven: sample.is_driven && sample.speed_m_per_s.is_some_and(slides),
        ..*sample
    };
    let samples: Vec<FidelitySample> = samples.iter().map(sliding).collect();
    let runs = moment::runs(&samples, &Reference::at_start(program), program);
    let touched = runs.iter().flatten().fold(0, |all, moment| all | moment.visible);
    let layers = (0..program.records.len()).filter(|layer| touched >> layer & 1 == 1);
    let elements = layers.filter_map(|layer| Element::as_played(program, layer));
    let judged = |element: Element| {
        if goes_on().is_break() {
            return None;
        }
        let play = PlayPerception::of(&Measure::new(&element), None, &runs);
        Some(of_plays(&element, element.over(), play.as_slice()))
    };
    elements.filter(|element| element.over() != Over::Speed).map(judged).collect()
}

/// The verdict on an element from the play in which it was perceived most certainly.
fn of_plays(element: &Element, over: Over, plays: &[PlayPerception]) -> LayerVerdict {
    if let Some(Layer::Stream(stream)) = element.record().map(|record| record.layer) {
        return of_stream(element, &stream);
    }
    let usual = plays.iter().find(|play| play.speed_m_per_s == Some(SPEEDS_M_PER_S[1])).copied();
    let Some(best) = plays.iter().copied().max_by(|one, other| one.felt.cmp_felt(&other.felt)) else {
        let step = Step::new(1.0, 1.0);
        return LayerVerdict { reasons: vec![Reason::TooWeak], ..LayerVerdict::new(element, step, over) };
    };
    let (verdict, reasons) = reason::of(element, &best.felt, &best.faultless);
    let Measured { contrast, is_narrow, texture, border, click, level, scene, .. } = best.felt;
    let title = |layer: Option<usize>| layer.and_then(|layer| element.program.titles.get(layer).cloned());
    let border = border.map(|border| BorderStep {
        from: title(border.from),
        to: Some(element.title.clone()),
        step: border.step,
    });
    LayerVerdict {
        verdict,
        speed_mm_per_s: best.speed_m_per_s.filter(|_| over != Over::Speed).map(|speed_m_per_s| 1e3 * speed_m_per_s),
        reasons,
        is_narrow,
        texture,
        border,
        click: click.map(|click| click.step),
        is_click_clamped: click.is_some_and(|click| click.is_clamped),
        level,
        is_flat: scene.sharp.weber_steps.abs() < FLAT_WEBER_STEPS,
        scene: SceneFeel {
            layer: element.layer,
            contrast: scene.sharp,
            texture: usual.and_then(|usual| usual.faultless.texture),
            visible: scene.visible,
        },
        ..LayerVerdict::new(element, contrast, over)
    }
}

/// Speed below which the finger counts as resting, m/s: friction does not follow the scene before it slides.
pub const SLIDE_MIN_M_PER_S: f64 = 2e-3;

/// Smallest difference of two levels of friction in a scene that is not treated as flat, in Weber steps.
pub const FLAT_WEBER_STEPS: f64 = 0.1;

/// Perception of an element in one play, with the actual and with an ideal display.
#[derive(Clone, Copy)]
struct PlayPerception {
    /// Absent if the speed is not one of the three.
    speed_m_per_s: Option<f64>,
    felt: Measured,
    faultless: Measured,
}

impl PlayPerception {
    /// Measures a play; `None` if the finger was never on the element.
    fn of(measure: &Measure, speed_m_per_s: Option<f64>, runs: &[Vec<Moment>]) -> Option<Self> {
        let faultless = measure.of(&moment::faultless(runs))?;
        Some(Self { speed_m_per_s, felt: measure.of(runs)?, faultless })
    }
}

/// Sets the contrast of a speed-dependent layer to that between the slowest and the fastest play.
fn over_speed(element: &Element, plays: &mut [PlayPerception]) {
    let natural_n = element.program.reach.natural_friction_n;
    let contrast = |measured: fn(&PlayPerception) -> Measured, plays: &[PlayPerception]| {
        let mean_n = |play: &PlayPerception| natural_n + measured(play).mean_electric_n;
        Some(Step::new(mean_n(plays.first()?), mean_n(plays.last()?)))
    };
    let felt = contrast(|play| play.felt, plays);
    let faultless = contrast(|play| play.faultless, plays);
    let (Some(felt), Some(faultless)) = (felt, faultless) else { return };
    for play in plays {
        play.felt.contrast = felt;
        play.faultless.contrast = faultless;
        play.felt.scene.sharp = faultless;
    }
}

/// The verdict on a stream, whose samples are unknown in advance.
fn of_stream(element: &Element, stream: &Stream) -> LayerVerdict {
    let program = &element.program;
    let gain = program.start.get(element.layer).map_or(1.0, |setting| f64::from(setting.gain));
    let [from_n, to_n] = [stream.low_n, stream.high_n].map(|electric_n| total_n(program, gain * f64::from(electric_n)));
    let step = Step { verdict: Verdict::Unknown, ..Step::new(from_n, to_n) };
    let found = LayerVerdict::new(element, step, Over::Samples);
    LayerVerdict { verdict: Verdict::Unknown, reasons: vec![Reason::NotStudied], ..found }
}

impl Element {
    fn is_streamed(&self) -> bool {
        self.record().is_some_and(|record| record.layer.is_streamed())
    }

    /// The variable over which its contrast is measured.
    fn over(&self) -> Over {
        match self.record().map(|record| record.layer) {
            Some(Layer::Speed(_)) => Over::Speed,
            Some(Layer::Direction(_)) => Over::Direction,
            Some(Layer::Vibration(_)) => Over::Time,
            Some(Layer::Stream(_)) => Over::Samples,
            _ => Over::Place,
        }
    }
}

/// The larger of the largest step and the texture, each relative to the size that is certainly felt.
pub fn felt_size(largest_weber_steps: f64, texture: Option<Texture>) -> f64 {
    let step = largest_weber_steps / weber_steps_safe();
    step.max(texture.map_or(0.0, |texture| texture.salience() / THRESHOLD_UNCERTAINTY))
}

impl Measured {
    /// Contrast, border and click.
    fn steps(&self) -> impl Iterator<Item = Step> {
        let border = self.border.map(|border| border.step);
        [Some(self.contrast), border, self.click.map(|click| click.step)].into_iter().flatten()
    }

    /// The most certain way in which it is perceived.
    fn verdict(&self) -> Verdict {
        let verdicts = self.steps().map(|step| step.verdict).chain(self.texture.map(|texture| texture.verdict));
        verdicts.fold(Verdict::NotFelt, Verdict::max)
    }

    /// Orders by certainty of perception, and then by size.
    fn cmp_felt(&self, other: &Self) -> Ordering {
        let size = |measured: &Self| {
            felt_size(measured.steps().map(|step| step.weber_steps.abs()).fold(0.0, f64::max), measured.texture)
        };
        self.verdict().cmp(&other.verdict()).then(size(self).total_cmp(&size(other)))
    }
}

fn notes(program: &Program) -> Vec<String> {
    let changes = Reference::new(program).changes_by_itself();
    let still = changes.then(|| {
        "A resting finger hardly feels vibrations and streams: 30 % of people do at 125 Hz (Dryad 9ghx3ffgp)."
            .to_owned()
    });
    let empty = program.records.is_empty().then(|| "the scene has no layer: there is nothing to feel".to_owned());
    still.into_iter().chain(empty).chain(starts_off(program)).collect()
}
