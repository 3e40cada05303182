//! The verdicts on one layer and on one border.

use frixel_layers::{Blend, Burst, Direction, Layer};
use frixel_scene::reference::Reference;
use frixel_scene::{LayerTitle, Program};

use super::click::ClickStep;
use super::neighbours::Border;
use super::obstacle::{self, SmallestSize};
use super::slide::{Slide, total_n};
use super::thresholds::TEXTURE_MAX_HZ;
use super::{
    BorderStep, BurstTimes, LayerPerception, Over, SAMPLE_HZ, SPEEDS_M_PER_S, Step, Texture, USUAL_M_PER_S, Verdict,
    contrast_within, has_texture,
};

/// Frictions of the copies of a layer that differ by less are the same, N: a slide meets the top of a narrow ridge only
/// as exactly as its samples lie.
const SAMPLING_N: f64 = 2e-4;

/// A smaller change of friction is none, N: above the rounding of `f32`.
const CHANGE_MIN_N: f64 = 1e-6;

/// A layer with what its comparison with others needs.
#[derive(Clone, Debug)]
pub(super) struct JudgedLayer {
    /// Index from the bottom.
    pub(super) layer: usize,
    /// The layers that act on its slides, a bit each.
    pub(super) visible: u64,
    pub(super) perception: LayerPerception,
}

/// A border with the layers that end there.
#[derive(Clone, Debug)]
pub(super) struct JudgedBorder {
    /// On either side, a bit each.
    ends: [u64; 2],
    pub(super) step: BorderStep,
}

/// What all layers of a program are judged with.
#[derive(Clone, Copy, Debug)]
pub(super) struct Judge<'p> {
    /// Of `lasting`.
    pub(super) reference: &'p Reference,
    pub(super) program: &'p Program,
    /// The program without pauses between bursts.
    pub(super) lasting: &'p Program,
    pub(super) smallest: SmallestSize,
    pub(super) borders: &'p [JudgedBorder],
}

impl JudgedBorder {
    /// Judges the step at a border; `None` where a ridge ends in nothing, which is no step.
    pub(super) fn new(border: &Border, program: &Program, smallest: &SmallestSize) -> Option<Self> {
        let ([from, to], [from_n, to_n], [from_met_n, to_met_n]) = (border.sides, border.friction_n, border.met_n);
        let step = Step::new(from_n, to_n).behind(Some(smallest.of_step(&Step::new(from_met_n, to_met_n))));
        let is_edge =
            |layer: usize| program.records.get(layer).is_some_and(|record| matches!(record.layer, Layer::Edge(_)));
        let ends_a_ridge = [from, to].into_iter().flatten().any(is_edge) && step.verdict == Verdict::NotFelt;
        let title = |side: Option<usize>| side.and_then(|layer| program.titles.get(layer).cloned());
        (!ends_a_ridge).then(|| Self { ends: border.ends, step: BorderStep { from: title(from), to: title(to), step } })
    }
}

impl Judge<'_> {
    /// Judges a layer, with those below it but without those above it, which are judged themselves; `None` if it is
    /// visible nowhere.
    pub(super) fn layer(&self, layer: usize) -> Option<JudgedLayer> {
        let Self { reference, program, lasting, smallest, .. } = self;
        let screen_m = (f64::from(program.header.screen_width_m), f64::from(program.header.screen_height_m));
        let over = Slide::over(layer, reference, screen_m);
        let small = smallest.of_extent(extent_m(&over));
        let slides = match program.records.get(layer)?.layer {
            Layer::Direction(Direction { angle_turns, .. }) => {
                let along = Slide::along(angle_turns.into(), layer, reference, screen_m);
                over.into_iter().chain(along).flat_map(|slide| [slide, slide.back()]).collect()
            }
            _ => over,
        };
        let burst = self.burst(layer);
        let is_triggered = program.start.get(layer).is_some_and(|setting| !setting.on);
        let brief = burst.as_ref().and_then(|burst| obstacle::of_bursts(burst, is_triggered));
        let (contrast, is_narrow, over) = self.contrast(layer, &slides)?;
        let contrast = contrast.behind(brief);
        let visible = slides.iter().fold(0, |visible, slide| visible | slide.visible_layers(reference));
        let textures = self.textures(layer, &slides, visible).into_iter();
        let textures: Vec<Texture> = textures.map(|texture| texture.behind(small).behind(brief)).collect();
        let title = program.titles.get(layer)?;
        let border = self.border(layer, title);
        let border = border.map(|border| BorderStep { step: border.step.behind(brief), ..border });
        let click = ClickStep::of(layer, &slides, lasting, USUAL_M_PER_S);
        let short = program.records.get(layer)?.layer.click();
        let short = short.and_then(|click| obstacle::of_pulse(click.decay_s.into()));
        let verdicts = textures.iter().map(|texture| texture.verdict).chain([contrast.verdict]);
        let perception = LayerPerception {
            layer: title.clone(),
            verdict: Verdict::of_any(verdicts.chain(border.iter().map(|border| border.step.verdict))),
            over,
            contrast,
            is_narrow,
            textures,
            border,
            burst: burst.map(|burst| BurstTimes {
                on_ms: 1e3 * f64::from(burst.on_s),
                period_ms: 1e3 * f64::from(burst.period_s),
            }),
            click: click.map(|click| click.step.behind(small).behind(short)),
            is_click_cut_off: click.is_some_and(|click| click.is_cut_off),
        };
        Some(JudgedLayer { layer, visible, perception })
    }

    /// The contrast of a layer, whether only a narrow place makes it, and what it is a change with.
    fn contrast(&self, layer: usize, slides: &[Slide]) -> Option<(Step, bool, Over)> {
        let program = self.program;
        let record = program.records.get(layer)?;
        let mean_n = |speed_m_per_s: f64| {
            let frictions_n = self.frictions_n(slides, |other| other <= layer, speed_m_per_s);
            let all_n = frictions_n.as_slice().concat();
            (!all_n.is_empty()).then(|| all_n.iter().sum::<f64>() / all_n.len() as f64)
        };
        match &record.layer {
            Layer::Speed(_) => {
                let [slow, _, fast] = SPEEDS_M_PER_S;
                Some((Step::new(mean_n(slow)?, mean_n(fast)?), false, Over::Speed))
            }
            Layer::Stream(stream) => {
                let electric_n = [stream.low_n, stream.high_n].map(|n| self.gain(layer) * f64::from(n));
                let [from_n, to_n] = electric_n.map(|electric_n| total_n(program, electric_n));
                let step = Step { verdict: Verdict::Unknown, ..Step::new(from_n, to_n) };
                (!slides.is_empty()).then_some((step, false, Over::Samples))
            }
            Layer::Direction(_) => {
                let frictions_n = self.frictions_n(slides, |other| other <= layer, USUAL_M_PER_S);
                let there_and_back = frictions_n.chunks(2);
                let contrasts = there_and_back.filter_map(|pair_n| contrast_within(&pair_n.concat(), false));
                let (contrast, is_narrow) = contrasts.max_by(|(one, _), (other, _)| one.cmp_felt(other))?;
                Some((contrast, is_narrow, Over::Direction))
            }
            _ => self.contrast_along(layer, slides),
        }
    }

    /// The contrast of a layer that changes with the place of the finger, or with time, along the slide on which most of
    /// it is felt.
    fn contrast_along(&self, layer: usize, slides: &[Slide]) -> Option<(Step, bool, Over)> {
        let Self { reference, lasting, smallest, program, .. } = self;
        let record = program.records.get(layer)?;
        let is_edge = matches!(record.layer, Layer::Edge(_));
        let repeats = !is_edge && has_texture(1 << layer, program);
        let frequency_hz = match record.layer {
            Layer::Vibration(vibration) => Some(f64::from(vibration.frequency_hz)),
            _ => None,
        };
        let whole = (*reference).clone().with_only(|other| other <= layer);
        let below = joins_those_below(record.blend).then(|| (*reference).clone().with_only(|other| other < layer));
        // All that is felt along a slide, and what is felt of it near to where the layer acts.
        let along_n = |slide: &Slide, sample_hz: f64| {
            let friction_n = |reference| slide.friction_n(reference, lasting, USUAL_M_PER_S, sample_hz);
            let whole_n = friction_n(&whole);
            let margin = (smallest.size_m() / USUAL_M_PER_S * sample_hz) as usize;
            let own_n = below.as_ref().map(|below| where_it_acts(&whole_n, &friction_n(below), margin));
            std::iter::once(whole_n).chain(own_n)
        };
        let judged = |slide: &Slide| {
            let sample_hz = slide.contrast_sample_hz(USUAL_M_PER_S);
            let outside = slide.begun_and_ended_outside(smallest.size_m());
            let judged = |(friction_n, outside_n): (Vec<f64>, Vec<f64>)| {
                let (contrast, is_narrow) = contrast_within(&friction_n, is_edge)?;
                // A ridge or a rim may fill the layer or lie at its border; the border of what repeats is no part of it.
                let met_n = if repeats && !is_narrow { &friction_n } else { &outside_n };
                // What changes with time does so wherever the finger is.
                let hindrance = match frequency_hz {
                    Some(frequency_hz) => obstacle::of_frequency(frequency_hz),
                    None => Some(smallest.of_slide(met_n, sample_hz)),
                };
                let slope = obstacle::of_slope(&friction_n, sample_hz);
                Some((contrast.behind(Some(slope)).behind(hindrance), is_narrow))
            };
            let contrasts = along_n(slide, sample_hz).zip(along_n(&outside, sample_hz)).filter_map(judged);
            contrasts.min_by(|(one, _), (other, _)| one.cmp_felt(other))
        };
        let contrasts = slides.iter().filter_map(judged);
        let (contrast, is_narrow) = contrasts.max_by(|(one, _), (other, _)| one.cmp_felt(other))?;
        Some((contrast, is_narrow, if frequency_hz.is_some() { Over::Time } else { Over::Place }))
    }

    /// The textures at each speed: of what the layer adds to those below it, or of all if it replaces or scales them.
    fn textures(&self, layer: usize, slides: &[Slide], visible: u64) -> Vec<Texture> {
        let Some(record) = self.program.records.get(layer) else { return Vec::new() };
        let joins = joins_those_below(record.blend);
        let felt = if joins { 1 << layer } else { visible & (u64::MAX >> (63 - layer)) };
        let has_none = matches!(record.layer, Layer::Edge(_) | Layer::Stream(_));
        if has_none || !has_texture(felt, self.program) {
            return Vec::new();
        }
        if let Layer::Vibration(vibration) = record.layer
            && vibration.frequency_hz > TEXTURE_MAX_HZ
        {
            // Faster than the samples can show.
            let amplitude_n = 0.5 * self.gain(layer) * f64::from(vibration.high_n - vibration.low_n).abs();
            let texture = Texture::new(1e3 * USUAL_M_PER_S, vibration.frequency_hz.into(), amplitude_n);
            return texture.into_iter().collect();
        }
        let at_speed = |speed_m_per_s: f64| {
            let mut frictions_n = self.frictions_n(slides, |other| other <= layer, speed_m_per_s);
            if joins {
                let below_n = self.frictions_n(slides, |other| other < layer, speed_m_per_s);
                for (friction_n, below_n) in frictions_n.iter_mut().flatten().zip(below_n.iter().flatten()) {
                    *friction_n -= below_n;
                }
            }
            let textures = frictions_n.iter().filter_map(|friction_n| Texture::of(friction_n, speed_m_per_s));
            textures.max_by(|one, other| one.salience().total_cmp(&other.salience()))
        };
        SPEEDS_M_PER_S.into_iter().filter_map(at_speed).collect()
    }

    /// The friction along each slide with these layers only.
    fn frictions_n(&self, slides: &[Slide], is_on: impl Fn(usize) -> bool, speed_m_per_s: f64) -> Vec<Vec<f64>> {
        let reference = self.reference.clone().with_only(is_on);
        slides.iter().map(|slide| slide.friction_n(&reference, self.lasting, speed_m_per_s, SAMPLE_HZ)).collect()
    }

    /// The border of a layer that is felt most surely, as a step onto it.
    fn border(&self, layer: usize, title: &LayerTitle) -> Option<BorderStep> {
        let ends_on = |ends: u64| ends >> layer & 1 == 1;
        let onto = |border: &JudgedBorder| {
            let BorderStep { from, to, step } = border.step.clone();
            let [below, above] = border.ends.map(ends_on);
            let (from, step) = if above { (from, step) } else { (to, step.reversed()) };
            (below || above).then(|| BorderStep { from, to: Some(title.clone()), step })
        };
        self.borders.iter().filter_map(onto).max_by(|one, other| one.step.cmp_felt(&other.step))
    }

    fn gain(&self, layer: usize) -> f64 {
        self.program.start.get(layer).map_or(1.0, |setting| setting.gain.into())
    }

    fn burst(&self, layer: usize) -> Option<Burst> {
        match self.program.records.get(layer)?.layer {
            Layer::Vibration(vibration) if vibration.burst.period_s > 0.0 => Some(vibration.burst),
            _ => None,
        }
    }
}

impl JudgedLayer {
    /// Whether another layer differs so little that sampling can be the reason.
    pub(super) fn is_near(&self, other: &Self) -> bool {
        let steps = |judged: &Self| {
            let LayerPerception { contrast, border, click, .. } = &judged.perception;
            [Some(*contrast), border.as_ref().map(|border| border.step), *click]
        };
        let are_near = |pair: (Option<Step>, Option<Step>)| match pair {
            (Some(one), Some(other)) => {
                one.verdict == other.verdict
                    && (one.from_n - other.from_n).abs() < SAMPLING_N
                    && (one.to_n - other.to_n).abs() < SAMPLING_N
            }
            (None, None) => true,
            _ => false,
        };
        self.perception.verdict == other.perception.verdict && steps(self).into_iter().zip(steps(other)).all(are_near)
    }
}

/// Whether a layer adds to those below it, which are felt with it: what is felt is not all its own.
fn joins_those_below(blend: Blend) -> bool {
    matches!(blend, Blend::Add | Blend::Max)
}

/// The part of the friction along a slide that lies no more samples than `margin` from where a layer changes that below;
/// one sample for a layer that changes nothing.
fn where_it_acts(whole_n: &[f64], below_n: &[f64], margin: usize) -> Vec<f64> {
    let mut is_near = vec![false; whole_n.len()];
    let mut marked = 0;
    for (number, (whole_n, below_n)) in whole_n.iter().zip(below_n).enumerate() {
        if (whole_n - below_n).abs() > CHANGE_MIN_N {
            let end = (number + margin + 1).min(is_near.len());
            let start = number.saturating_sub(margin).max(marked);
            is_near.iter_mut().take(end).skip(start).for_each(|is_near| *is_near = true);
            marked = end;
        }
    }
    let near_n: Vec<f64> = whole_n.iter().zip(is_near).filter_map(|(n, is_near)| is_near.then_some(*n)).collect();
    if near_n.is_empty() { whole_n.iter().take(1).copied().collect() } else { near_n }
}

/// The largest distance, m, over which a layer reaches both along x and along y.
fn extent_m(slides: &[Slide]) -> f64 {
    let longest_m = |is_row: bool| {
        let slides = slides.iter().filter(|slide| slide.is_row() == is_row);
        slides.map(Slide::length_m).fold(0.0, f64::max)
    };
    longest_m(true).min(longest_m(false))
}
