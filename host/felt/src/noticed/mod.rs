//! What a finger noticed of each layer of a scene, in plays that were recorded.
//!
//! The input is a program and the samples of plays by one finger. The output is a verdict for each layer that the finger
//! touched and for each border that it crossed, by the thresholds with which [`perception`](crate::perception) judges a
//! program before it is played.
//!
//! A contrast counts as far as it comes back in what was felt: the contrast of the scene along the way, times the slope
//! of felt friction on it. So neither what lies beside a layer, nor what lies above it, nor the finger's own load and
//! noise is contrast of the layer, and a display that plays it in the wrong place has less of it. A delay that nobody
//! notices takes nothing. Of a texture, whose phase nobody feels, the power counts.

mod border;
mod likeness;
mod moment;
mod texture;

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use frixel_layers::{Direction, Layer};
use frixel_scene::Program;
use frixel_scene::reference::Reference;
use serde::Serialize;

use crate::fidelity::FidelitySample;
use crate::perception::{Step, Texture, Verdict, contrast_within, has_texture};
use border::Crossings;
use likeness::Likeness;
use moment::{MOMENT_HZ, Moment, context, electric_n, runs};

/// The longest way of which the contrast is taken, m: a change over a longer one is not noticed. Assumed.
const WAY_MAX_M: f64 = 0.05;
/// A shorter touch of a layer says nothing, in moments: 20 ms.
const TOUCH_MIN: usize = 40;
/// Nearer to a border a fingertip does not tell on which side a change is, m (its spatial resolution is 1 to 2 mm).
const FINGERTIP_M: f64 = 0.002;
/// From one place at which a change of the scene is sought to the next, in samples: 1 ms.
const PLACE_SAMPLES: usize = 4;
/// A smaller change of the scene's friction is none, N: the least amplitude with a threshold is 0.2 mN.
const CHANGE_MIN_N: f64 = 4e-4;
/// A contrast of the reference below it, in Weber steps, is that of a flat layer.
const FLAT_WEBER_STEPS: f64 = 0.1;

/// What a finger feels of the layers of a scene, summed over its plays.
#[derive(Clone, Debug)]
pub struct Noticing {
    program: Program,
    /// The whole scene.
    scene: Reference,
    /// For each layer, the scene without the layers above it.
    uncovered: Vec<Reference>,
    layers: Vec<Touches>,
    crossings: Crossings,
}

/// What a finger felt of a layer that it touched.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NoticedLayer {
    /// Index of the layer from the bottom.
    pub layer: usize,
    /// The felt part of the largest contrast on a way of at most 50 mm within the layer; of a layer that depends on the
    /// direction, of the contrast between ways. The step onto the layer is not in it.
    pub contrast: Step,
    /// The most noticeable texture; absent where there is none.
    pub texture: Option<Texture>,
    /// Mean of the total friction where no other layer is above, farther than a fingertip's resolution from where the layer
    /// ends; absent if the finger was there for less than 20 ms.
    pub level: Option<Level>,
    /// Whether the scene has the same friction throughout the layer.
    pub is_flat: bool,
}

/// A mean total friction.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Level {
    /// Of the scene, N.
    pub scene_n: f64,
    /// As it was felt, N.
    pub felt_n: f64,
}

/// What a finger felt of a border that it crossed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NoticedBorder {
    /// Indices of the layers on either side, as they are seen from the other one; absent for the bare screen.
    pub sides: [Option<usize>; 2],
    /// The layers that are only on that side, a bit each from the bottom.
    pub layers: [u64; 2],
    /// The felt part of the step.
    pub step: Step,
}

impl NoticedLayer {
    /// Whether the finger notices the layer by its contrast or its texture.
    pub fn verdict(&self) -> Verdict {
        Verdict::of_any([self.contrast.verdict].into_iter().chain(self.texture.map(|texture| texture.verdict)))
    }
}

/// Sums over the touches of a layer.
#[derive(Clone, Debug, Default)]
struct Touches {
    moments: usize,
    sums: Sums,
    /// Where no layer is above, without what a fingertip does not tell from what lies beside.
    uppermost: Sums,
    likeness: Likeness,
    /// The largest contrast of the scene on a way over the layer: least and largest electric friction, N. Of a layer
    /// that depends on the direction, over all ways.
    widest_n: Option<[f64; 2]>,
    /// Slides along the axis of a layer that depends on the direction, and against it.
    by_direction: [Sums; 2],
    texture: Option<Texture>,
}

/// Sums of electric and natural friction, N.
#[derive(Clone, Copy, Debug, Default)]
struct Sums {
    count: f64,
    scene_n: f64,
    felt_n: f64,
    natural_n: f64,
}

impl Sums {
    fn add(&mut self, moment: &Moment) {
        self.count += 1.0;
        self.scene_n += moment.scene_n;
        self.felt_n += moment.felt_n;
        self.natural_n += moment.natural_n;
    }

    /// The step between two electric frictions of the scene, of which a part is felt.
    fn felt_step(&self, [from_n, to_n]: [f64; 2], part: f64) -> Step {
        let [scene_n, felt_n, natural_n] = [self.scene_n, self.felt_n, self.natural_n].map(|sum| sum / self.count);
        let total_n = |electric_n: f64| natural_n + (felt_n + part * (electric_n - scene_n)).max(0.0);
        Step::new(total_n(from_n), total_n(to_n))
    }
}

impl Noticing {
    /// A finger that has touched nothing yet.
    pub fn new(program: &Program) -> Self {
        let scene = Reference::at_start(program);
        let layers = 0..scene.layer_count();
        Self {
            uncovered: layers
                .clone()
                .map(|layer| scene.clone().with_only(|other| other <= layer && starts_on(program, other)))
                .collect(),
            layers: layers.map(|_| Touches::default()).collect(),
            crossings: Crossings::new(program),
            program: program.clone(),
            scene,
        }
    }

    /// Adds a play, of [`SAMPLE_HZ`](crate::fidelity::SAMPLE_HZ) samples a second. Friction counts while the board drove
    /// the scene.
    pub fn add(&mut self, samples: &[FidelitySample]) {
        for run in runs(samples, &self.scene, &self.program) {
            self.crossings.add(&run);
            for layer in 0..self.layers.len() {
                for touch in stretches(&run, |moment| moment.is_on(layer)) {
                    self.add_touch(layer, &run, touch);
                }
            }
        }
    }

    /// Adds a stretch of a run on which a layer is touched.
    fn add_touch(&mut self, layer: usize, run: &[Moment], touch: std::ops::Range<usize>) {
        let Self { program, uncovered, layers, .. } = self;
        let (Some(touches), Some(uncovered), Some(on_layer), Some(record)) =
            (layers.get_mut(layer), uncovered.get(layer), run.get(touch.clone()), program.records.get(layer))
        else {
            return;
        };
        touches.moments += touch.len();
        let own_n: Vec<f64> = on_layer.iter().map(|moment| moment.electric_n(uncovered, program)).collect();
        for moment in on_layer {
            touches.sums.add(moment);
        }
        let is_uppermost = |moment: &Moment| moment.visible.checked_ilog2() == u32::try_from(layer).ok();
        for moment in stretches(on_layer, is_uppermost).into_iter().flat_map(|stretch| inner(&on_layer[stretch])) {
            touches.uppermost.add(moment);
        }
        for way in ways(on_layer) {
            let Some(way_n) = own_n.get(way.clone()) else { continue };
            touches.likeness.add((touch.start + way.start..).zip(way_n.iter().copied()), run);
            touches.widen(way_n, &record.layer, program.reach.natural_friction_n);
        }
        if let Layer::Direction(Direction { angle_turns, .. }) = record.layer {
            touches.add_directions(on_layer, angle_turns.into());
        }
        let visible = on_layer.iter().fold(0, |visible, moment| visible | moment.visible);
        if !matches!(record.layer, Layer::Edge(_)) && has_texture(visible & (u64::MAX >> (63 - layer)), program) {
            let textures = texture::of_touch(on_layer, &own_n).chain(touches.texture);
            touches.texture = textures.max_by(|one, other| one.salience().total_cmp(&other.salience()));
        }
    }

    /// Whether the friction of the scene changes along the way of a play.
    pub fn changes_along(&self, samples: &[FidelitySample]) -> bool {
        let places = samples.chunks(PLACE_SAMPLES).filter_map(context);
        let places = places.map(|context| electric_n(&self.scene, &self.program, &context));
        let (least_n, most_n) =
            places.fold((f64::INFINITY, f64::NEG_INFINITY), |(least_n, most_n), n| (least_n.min(n), most_n.max(n)));
        most_n - least_n > CHANGE_MIN_N
    }

    /// The layers that the finger touched, from bottom to top.
    pub fn layers(&self) -> Vec<NoticedLayer> {
        let touched = self.layers.iter().enumerate().filter(|(_, touches)| touches.moments >= TOUCH_MIN);
        touched.map(|(layer, touches)| touches.noticed(layer, self.program.reach.natural_friction_n)).collect()
    }

    /// The borders that the finger crossed, those of lower layers first.
    pub fn borders(&self) -> Vec<NoticedBorder> {
        self.crossings.noticed()
    }
}

impl Touches {
    /// Notes the contrast on a way, electric friction in newtons, if it is the largest; of a layer that depends on the
    /// direction, as a part of the contrast between ways.
    fn widen(&mut self, way_n: &[f64], layer: &Layer, natural_n: f64) {
        let total_n: Vec<f64> = way_n.iter().map(|own_n| natural_n + own_n).collect();
        let Some((contrast, _)) = contrast_within(&total_n, matches!(layer, Layer::Edge(_))) else { return };
        let [from_n, to_n] = [contrast.from_n, contrast.to_n].map(|total_n| total_n - natural_n);
        self.widest_n = Some(match (self.widest_n, layer) {
            (Some([least_n, most_n]), Layer::Direction(_)) => [from_n.min(least_n), to_n.max(most_n)],
            (Some([least_n, most_n]), _) if most_n - least_n >= contrast.contrast_n => [least_n, most_n],
            _ => [from_n, to_n],
        });
    }

    /// Adds the moments of a touch to those that slide along an axis, or against it.
    fn add_directions(&mut self, touch: &[Moment], axis_turns: f64) {
        let (axis_y, axis_x) = libm::sincos(TAU * axis_turns);
        let [along, against] = &mut self.by_direction;
        for moment in touch {
            let [x, y] = moment.context.direction;
            match axis_x * x + axis_y * y {
                cosine if cosine > 0.0 => along.add(moment),
                cosine if cosine < 0.0 => against.add(moment),
                _ => {}
            }
        }
    }

    /// The part of the scene's contrast that was felt.
    fn felt_part(&self) -> f64 {
        let [along, against] = &self.by_direction;
        if along.count.min(against.count) < TOUCH_MIN as f64 {
            return self.likeness.slope();
        }
        let difference_n = |sum: fn(&Sums) -> f64| sum(along) / along.count - sum(against) / against.count;
        let (felt_n, scene_n) = (difference_n(|sums| sums.felt_n), difference_n(|sums| sums.scene_n));
        if scene_n.abs() > CHANGE_MIN_N { (felt_n / scene_n).max(0.0) } else { self.likeness.slope() }
    }

    fn noticed(&self, layer: usize, scenes_natural_n: f64) -> NoticedLayer {
        let Self { sums, uppermost, widest_n, texture, .. } = self;
        let widest_n = widest_n.unwrap_or_default();
        let [least_n, most_n] = widest_n.map(|electric_n| scenes_natural_n + electric_n);
        NoticedLayer {
            layer,
            contrast: sums.felt_step(widest_n, self.felt_part()),
            texture: *texture,
            level: (uppermost.count >= TOUCH_MIN as f64).then(|| Level {
                scene_n: scenes_natural_n + uppermost.scene_n / uppermost.count,
                felt_n: (uppermost.natural_n + uppermost.felt_n) / uppermost.count,
            }),
            is_flat: Step::new(least_n, most_n).weber_steps < FLAT_WEBER_STEPS,
        }
    }
}

/// Whether a layer is on from the beginning; no host switches one on while a scene is scored.
fn starts_on(program: &Program, layer: usize) -> bool {
    program.start.get(layer).is_none_or(|setting| setting.on)
}

/// The stretches of a run of which all moments are wanted.
fn stretches(run: &[Moment], is_wanted: impl Fn(&Moment) -> bool) -> Vec<std::ops::Range<usize>> {
    let mut found = Vec::new();
    let mut start = None;
    for (number, moment) in run.iter().enumerate() {
        match (is_wanted(moment), start) {
            (true, None) => start = Some(number),
            (false, Some(first)) => {
                found.push(first..number);
                start = None;
            }
            _ => {}
        }
    }
    found.extend(start.map(|first| first..run.len()));
    found
}

/// The moments of a stretch that are farther from both of its ends than a fingertip's resolution.
fn inner(stretch: &[Moment]) -> &[Moment] {
    let from = near_count(stretch.iter(), FINGERTIP_M);
    let to = stretch.len() - near_count(stretch.iter().rev(), FINGERTIP_M);
    stretch.get(from..to).unwrap_or_default()
}

/// How many moments of a way are nearer to its beginning than a distance.
fn near_count<'m>(way: impl Iterator<Item = &'m Moment>, distance_m: f64) -> usize {
    let ways_m = way.scan(0.0, |way_m, moment| {
        *way_m += moment.context.speed_m_per_s / MOMENT_HZ;
        Some(*way_m)
    });
    ways_m.take_while(|way_m| *way_m < distance_m).count()
}

/// Parts of a touch that are at most [`WAY_MAX_M`] long.
fn ways(touch: &[Moment]) -> Vec<std::ops::Range<usize>> {
    let mut found = Vec::new();
    let (mut start, mut way_m) = (0, 0.0);
    for (number, moment) in touch.iter().enumerate() {
        way_m += moment.context.speed_m_per_s / MOMENT_HZ;
        if way_m > WAY_MAX_M {
            found.push(start..number);
            (start, way_m) = (number, 0.0);
        }
    }
    found.push(start..touch.len());
    found
}

#[cfg(test)]
mod tests;
