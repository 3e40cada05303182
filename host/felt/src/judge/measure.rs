//! Measures the perception of one element in a play: its contrast, its texture, the step onto it and its click.
//!
//! Felt contrast is the contrast of the scene along the way, times the slope of felt friction against it. Neighbouring
//! and covering layers, and the finger's own load and noise, thus add no contrast, and a display that renders the
//! element at the wrong place loses contrast. An imperceptible delay loses none. Textures are compared by power, since
//! phase is not perceived.

use std::f64::consts::TAU;
use std::ops::Range;

use frixel_layers::{Direction, Interval, Layer};
use frixel_scene::Program;
use frixel_scene::reference::Reference;

use super::border::{Borders, CrossedBorder};
use super::fingertip::Fingertip;
use super::likeness::Likeness;
use super::moment::{Moment, context, electric_n, runs};
use super::texture;
use super::thresholds::{TEXTURE_MAX_HZ, TEXTURE_MIN_HZ};
use super::touch::{Sums, Touch, inner, stretches, ways};
use super::{Element, Level, Step, Texture, contrast_within, has_texture, total_n};
use crate::fidelity::FidelitySample;

/// Shortest touch of a layer that has a level, in moments: 20 ms.
const TOUCH_MIN: usize = 40;
/// Smallest change of the scene's friction treated as a change, N: the smallest amplitude with a threshold is 0.2 mN.
const CHANGE_MIN_N: f64 = 4e-4;
/// Search window on either side of a click, in moments: 100 ms.
const AROUND_CLICK: usize = 200;

/// References for measuring a play.
pub(super) struct Measure<'e> {
    element: &'e Element,
    /// The whole scene.
    scene: Reference,
    /// The scene without the layers above the element.
    uncovered: Reference,
    /// The layers below the element, if it adds to them.
    below: Option<Reference>,
    borders: Borders,
}

/// The perception of an element in a play.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Measured {
    /// The largest felt contrast on a way of at most 50 mm within the element, or between both directions if the layer
    /// depends on the direction. The step onto the element is not included.
    pub(super) contrast: Step,
    /// Whether friction is uniform in the element except for a narrow place that makes the contrast.
    pub(super) is_narrow: bool,
    /// Whether it changes with time, faster than steps do.
    pub(super) is_vibration: bool,
    /// The most noticeable texture.
    pub(super) texture: Option<Texture>,
    /// The most certainly perceived step onto the element.
    pub(super) border: Option<CrossedBorder>,
    /// The initial step of its click.
    pub(super) click: Option<Click>,
    /// Mean felt friction on the element above natural friction, N.
    pub(super) mean_electric_n: f64,
    /// Mean friction where the element is the topmost layer, away from its border by more than a fingertip's
    /// resolution.
    pub(super) level: Option<Level>,
    /// The contrast of the scene for the finger that it is designed for.
    pub(super) scene: SceneContrast,
}

/// The initial step of a click.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Click {
    pub(super) step: Step,
    /// Whether the drive clamps it.
    pub(super) is_clamped: bool,
}

/// Contrasts of the scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SceneContrast {
    /// Over ways of at most 50 mm, regardless of a fingertip's resolution.
    pub(super) sharp: Step,
    /// Over the whole way, at a fingertip's resolution.
    pub(super) whole: Step,
    /// Bit set of the layers that act on the way.
    pub(super) visible: u64,
}

impl<'e> Measure<'e> {
    pub(super) fn new(element: &'e Element) -> Self {
        let scene = Reference::at_start(&element.program);
        let starts_on = |layer: usize| element.program.start.get(layer).is_none_or(|setting| setting.on);
        let layer = element.layer;
        Self {
            uncovered: scene.clone().with_only(|other| other <= layer && starts_on(other)),
            below: element
                .joins_those_below()
                .then(|| scene.clone().with_only(|other| other < layer && starts_on(other))),
            borders: Borders::new(&element.program, layer, element.joins_those_below(), starts_on),
            scene,
            element,
        }
    }

    /// Returns the moments of a play, sampled at [`SAMPLE_HZ`](crate::fidelity::SAMPLE_HZ), in which the board drove
    /// the scene.
    pub(super) fn runs(&self, samples: &[FidelitySample]) -> Vec<Vec<Moment>> {
        runs(samples, &self.scene, &self.element.program)
    }

    /// Measures a play; `None` if the finger was never on the element.
    pub(super) fn of(&self, runs: &[Vec<Moment>]) -> Option<Measured> {
        let mut felt = Sums::default();
        let (mut uppermost, mut by_direction) = (Sums::default(), [Sums::default(); 2]);
        let mut touches: Vec<Touch> = Vec::new();
        let mut whole_n: Vec<f64> = Vec::new();
        let (mut border, mut click): (Option<CrossedBorder>, Option<Click>) = (None, None);
        for run in runs {
            let fingertip = Fingertip::of(run);
            border = surest(border, self.borders.met(run, &fingertip), |border| border.step);
            click = surest(click, self.click(run), |click| click.step);
            let own_n = self.own_n(run);
            let felt_n: Vec<f64> = run.iter().map(|moment| moment.felt_n).collect();
            let smooth_felt_n = fingertip.smoothed(&felt_n, 0..run.len());
            for range in stretches(run, |moment| moment.is_on(self.element.layer)) {
                let on_layer = run.get(range.clone()).unwrap_or_default();
                for moment in on_layer {
                    felt.add(moment);
                }
                let is_uppermost =
                    |moment: &Moment| moment.visible.checked_ilog2() == u32::try_from(self.element.layer).ok();
                let alone = stretches(on_layer, is_uppermost);
                alone.into_iter().flat_map(|alone| inner(&on_layer[alone])).for_each(|moment| uppermost.add(moment));
                self.add_directions(on_layer, &mut by_direction);
                touches.push(self.touch(run, range, [&own_n, &smooth_felt_n], &fingertip, &mut whole_n));
            }
        }
        let first = *touches.first()?;
        let touch = touches.iter().copied().reduce(Touch::united).unwrap_or(first);
        let (contrast, is_narrow) = self.contrast(&touch, &felt, &by_direction);
        let natural_n = self.element.program.reach.natural_friction_n;
        Some(Measured {
            contrast,
            is_narrow,
            is_vibration: self.is_vibration(),
            texture: touch.texture,
            border,
            click,
            mean_electric_n: felt.felt_n / felt.count,
            level: (uppermost.count >= TOUCH_MIN as f64).then(|| Level {
                scene_n: natural_n + uppermost.scene_n / uppermost.count,
                felt_n: (uppermost.natural_n + uppermost.felt_n) / uppermost.count,
            }),
            scene: SceneContrast { whole: contrast_within(&whole_n, self.is_edge())?.0, ..touch.scene },
        })
    }

    /// The scene's electric friction along a run without the layers above, N, while the finger is on the element. For a
    /// layer that adds to the layers below, the friction that it adds.
    fn own_n(&self, run: &[Moment]) -> Vec<f64> {
        let Element { program, layer, .. } = self.element;
        let own_n = |moment: &Moment| {
            if !moment.is_on(*layer) {
                return 0.0;
            }
            let below_n = self.below.as_ref().map_or(0.0, |below| moment.electric_n(below, program));
            moment.electric_n(&self.uncovered, program) - below_n
        };
        run.iter().map(own_n).collect()
    }

    /// Measures a part of a run on the element. `own_n` is the scene's friction along the run, `felt_n` the felt
    /// friction at a fingertip's resolution.
    fn touch(
        &self,
        run: &[Moment],
        range: Range<usize>,
        [own_n, felt_n]: [&[f64]; 2],
        fingertip: &Fingertip,
        whole_n: &mut Vec<f64>,
    ) -> Touch {
        let Element { program, layer, .. } = self.element;
        let natural_n = program.reach.natural_friction_n;
        let base_n = self.below.as_ref().map_or(0.0, |below| {
            let moments = run.get(range.clone()).unwrap_or_default();
            moments.iter().map(|moment| moment.electric_n(below, program)).sum::<f64>() / moments.len().max(1) as f64
        });
        let smooth_n = fingertip.smoothed(own_n, range.clone());
        whole_n.extend(smooth_n.iter().map(|own_n| total_n(program, base_n + own_n)));
        let sharp_n = own_n.get(range.clone()).unwrap_or_default();
        let of_scene = |own_n: &[f64]| {
            let total_n: Vec<f64> = own_n.iter().map(|own_n| total_n(program, base_n + own_n)).collect();
            contrast_within(&total_n, self.is_edge()).unwrap_or((Step::new(natural_n, natural_n), false))
        };
        let mut touch = Touch {
            contrast: Step::new(natural_n, natural_n),
            is_narrow: false,
            texture: None,
            widest_n: [0.0; 2],
            slope: 0.0,
            scene: SceneContrast {
                sharp: Step::new(natural_n, natural_n),
                whole: Step::new(natural_n, natural_n),
                visible: run.get(range.clone()).unwrap_or_default().iter().fold(0, |all, moment| all | moment.visible),
            },
        };
        for way in ways(run.get(range.clone()).unwrap_or_default()) {
            let (Some(smooth_n), Some(sharp_n)) = (smooth_n.get(way.clone()), sharp_n.get(way.clone())) else {
                continue;
            };
            let ((scene, is_narrow), (sharp, _)) = (of_scene(smooth_n), of_scene(sharp_n));
            let start = range.start + way.start;
            let mut likeness = Likeness::default();
            likeness.add((start..).zip(smooth_n.iter().copied()), felt_n, felt_n);
            let slope = likeness.slope();
            let mut sums = Sums::default();
            run.get(start..start + way.len()).unwrap_or_default().iter().for_each(|moment| sums.add(moment));
            let mean_n = smooth_n.iter().sum::<f64>() / smooth_n.len().max(1) as f64;
            let electric_n = [scene.from_n, scene.to_n].map(|total_n| total_n - natural_n - base_n);
            let contrast = sums.felt_step(electric_n, mean_n, slope);
            if contrast.cmp_felt(&touch.contrast).is_gt() || touch.contrast.contrast_n == 0.0 {
                touch = Touch { contrast, is_narrow, slope, ..touch };
            }
            let [least_n, most_n] = touch.widest_n;
            if way.start == 0 || electric_n[1] - electric_n[0] > most_n - least_n {
                touch.widest_n = electric_n;
            }
            if sharp.cmp_felt(&touch.scene.sharp).is_gt() || way.start == 0 {
                touch.scene.sharp = sharp;
            }
        }
        let below = if self.below.is_some() { 1 << layer } else { touch.scene.visible & (u64::MAX >> (63 - layer)) };
        if !self.is_edge() && has_texture(below, program) {
            touch.texture = self.texture(run.get(range).unwrap_or_default(), sharp_n);
        }
        touch
    }

    fn is_edge(&self) -> bool {
        self.element.record().is_some_and(|record| matches!(record.layer, Layer::Edge(_)))
    }

    fn is_vibration(&self) -> bool {
        let layer = self.element.record().map(|record| record.layer);
        matches!(layer, Some(Layer::Vibration(vibration)) if f64::from(vibration.frequency_hz) >= TEXTURE_MIN_HZ)
    }

    /// The most noticeable texture of a touch.
    fn texture(&self, touch: &[Moment], own_n: &[f64]) -> Option<Texture> {
        match self.element.record()?.layer {
            Layer::Vibration(vibration) if vibration.frequency_hz > TEXTURE_MAX_HZ => {
                // Too fast for the sampling rate of the moments.
                let gain = self.element.program.start.get(self.element.layer).map_or(1.0, |setting| setting.gain);
                let amplitude_n = 0.5 * f64::from(gain) * f64::from(vibration.high_n - vibration.low_n).abs();
                let mean_n = |value: fn(&Moment) -> f64| touch.iter().map(value).sum::<f64>() / touch.len() as f64;
                let part = (mean_n(|moment| moment.felt_n) / mean_n(|moment| moment.reference_n)).clamp(0.0, 1.0);
                let speed_mm_per_s = 1e3 * mean_n(|moment| moment.context.speed_m_per_s);
                Texture::new(speed_mm_per_s, vibration.frequency_hz.into(), part * amplitude_n)
            }
            _ => texture::of_touch(touch, own_n).max_by(|one, other| one.salience().total_cmp(&other.salience())),
        }
    }

    /// The felt contrast of all touches, and whether a narrow place makes it.
    fn contrast(&self, touch: &Touch, felt: &Sums, [along, against]: &[Sums; 2]) -> (Step, bool) {
        match self.element.record().map(|record| record.layer) {
            Some(Layer::Vibration(_)) if self.is_vibration() => {
                // Too fast for a step; reported as a texture.
                let total_n = (felt.natural_n + felt.felt_n) / felt.count;
                (Step::new(total_n, total_n), false)
            }
            Some(Layer::Direction(_)) if along.count.min(against.count) >= TOUCH_MIN as f64 => {
                let difference_n = |sum: fn(&Sums) -> f64| sum(along) / along.count - sum(against) / against.count;
                let (felt_n, scene_n) = (difference_n(|sums| sums.felt_n), difference_n(|sums| sums.scene_n));
                let part = if scene_n.abs() > CHANGE_MIN_N { (felt_n / scene_n).max(0.0) } else { touch.slope };
                (felt.felt_step(touch.widest_n, felt.scene_n / felt.count, part), touch.is_narrow)
            }
            _ => (touch.contrast, touch.is_narrow),
        }
    }

    /// Adds the moments of a touch to the sums of its direction along the element's axis.
    fn add_directions(&self, touch: &[Moment], [along, against]: &mut [Sums; 2]) {
        let Some(Layer::Direction(Direction { angle_turns, .. })) = self.element.record().map(|record| record.layer)
        else {
            return;
        };
        let (axis_y, axis_x) = libm::sincos(TAU * f64::from(angle_turns));
        for moment in touch {
            let [x, y] = moment.context.direction;
            match axis_x * x + axis_y * y {
                cosine if cosine > 0.0 => along.add(moment),
                cosine if cosine < 0.0 => against.add(moment),
                _ => {}
            }
        }
    }

    /// The felt part of the element's click in a run.
    fn click(&self, run: &[Moment]) -> Option<Click> {
        let Element { program, layer, .. } = self.element;
        self.element.record()?.layer.click()?;
        let mut with = self.uncovered.clone().along_stroke().with_clicks_of(*layer);
        let frictions_n = |moment: &Moment| {
            let without_n = self.uncovered.electric_friction_at_n(&moment.context);
            [without_n, with.electric_friction_n(&moment.context)]
        };
        let frictions_n: Vec<[f64; 2]> = run.iter().map(frictions_n).collect();
        let within_n = |electric_n: f64| total_n(program, electric_n);
        let size_n = |[without_n, with_n]: &[f64; 2]| (with_n - without_n).abs();
        let (peak, largest_n) = frictions_n
            .iter()
            .enumerate()
            .max_by(|(_, one), (_, other)| size_n(one).total_cmp(&size_n(other)))
            .filter(|(_, largest)| size_n(largest) > 0.0)?;
        let around = peak.saturating_sub(AROUND_CLICK)..(peak + AROUND_CLICK).min(run.len());
        let signal = around.map(|number| {
            let [without_n, with_n] = frictions_n.get(number).copied().unwrap_or_default();
            (number, within_n(with_n) - within_n(without_n))
        });
        let felt_n: Vec<f64> = run.iter().map(|moment| moment.felt_n).collect();
        let mut likeness = Likeness::default();
        likeness.add(signal, &felt_n, &felt_n);
        let natural_n = run.iter().map(|moment| moment.natural_n).sum::<f64>() / run.len() as f64;
        let [from_n, to_n] = largest_n.map(within_n);
        let above_n = from_n - program.reach.natural_friction_n;
        let step = Step::new(natural_n + above_n, natural_n + above_n + likeness.slope().min(1.0) * (to_n - from_n));
        let is_clamped = size_n(largest_n) - (to_n - from_n).abs() > 1e-6;
        Some(Click { step, is_clamped })
    }
}

/// The one of two that is perceived more certainly.
pub(super) fn surest<T>(one: Option<T>, other: Option<T>, step: impl Fn(&T) -> Step) -> Option<T> {
    one.into_iter().chain(other).max_by(|one, other| step(one).cmp_felt(&step(other)))
}

/// Spacing of the places at which a change of the scene is sought, in samples: 1 ms.
const PLACE_SAMPLES: usize = 4;

/// Whether the friction of a scene changes along a play's way.
pub fn changes_along(program: &Program, samples: &[FidelitySample]) -> bool {
    let scene = Reference::at_start(program);
    let places = samples.chunks(PLACE_SAMPLES).filter_map(context);
    let Interval { low, high } = Interval::of(places.map(|context| electric_n(&scene, program, &context)));
    high - low > CHANGE_MIN_N
}
