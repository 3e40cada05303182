//! How many simulated fingers notice each layer, and tell two levels apart.

use std::cmp::Ordering;

use frixel_felt::noticed::{Level, NoticedBorder, NoticedLayer, Noticing};
use frixel_felt::perception::{Step, THRESHOLD_UNCERTAINTY, Texture, Verdict, weber_steps, weber_steps_safe};
use frixel_scene::{LayerTitle, Program};
use serde::Serialize;

use crate::statistics::{mean, median};

/// Levels of friction that differ by less in the scene, in Weber steps, are the same.
const SAME_WEBER_STEPS: f64 = 0.1;

/// What a finger noticed in its plays.
#[derive(Clone, Debug, Default)]
pub(super) struct Finger {
    layers: Vec<NoticedLayer>,
    borders: Vec<NoticedBorder>,
}

impl From<&Noticing> for Finger {
    fn from(noticing: &Noticing) -> Self {
        Self { layers: noticing.layers(), borders: noticing.borders() }
    }
}

/// The simulated fingers that touched something, by their verdict.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Verdicts {
    /// Fingers that touched it.
    pub touched: usize,
    /// Fingers that notice it.
    pub felt: usize,
    /// Fingers near the threshold.
    pub felt_by_some: usize,
    /// Fingers that do not notice it.
    pub not_felt: usize,
    /// Fingers of which no study says whether they notice it.
    pub unknown: usize,
}

impl FromIterator<Verdict> for Verdicts {
    fn from_iter<I: IntoIterator<Item = Verdict>>(verdicts: I) -> Self {
        let mut counts = Self::default();
        for verdict in verdicts {
            counts.touched += 1;
            *match verdict {
                Verdict::Felt => &mut counts.felt,
                Verdict::NearThreshold => &mut counts.felt_by_some,
                Verdict::NotFelt => &mut counts.not_felt,
                Verdict::Unknown => &mut counts.unknown,
            } += 1;
        }
        counts
    }
}

impl Verdicts {
    /// Whether every finger that touched it notices it.
    pub fn is_felt_by_all(&self) -> bool {
        self.felt == self.touched
    }
}

/// What simulated fingers felt of a layer that some of them touched. Sizes are medians over these.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LayerScore {
    /// Number and title of the layer.
    pub layer: LayerTitle,
    /// How many notice the layer, by its contrast, its texture, or a border of it.
    pub simulated_fingers: Verdicts,
    /// Felt contrast within the layer, without the step onto it, in Weber steps.
    pub contrast_weber_steps: f64,
    /// The texture of the finger in the middle, by its distance from the threshold; absent where no finger had one.
    pub texture: Option<Texture>,
    /// The border of it at which the largest step was felt; absent where no finger crossed one.
    pub border: Option<LayerBorder>,
}

/// A border of a layer.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LayerBorder {
    /// The layer on the other side; absent for the bare screen.
    pub from: Option<LayerTitle>,
    /// Felt step onto the layer, in Weber steps.
    pub weber_steps: f64,
}

/// What simulated fingers felt of a border.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BorderScore {
    /// The layer on one side; absent for the bare screen.
    pub from: Option<LayerTitle>,
    /// The layer on the other side, which is above.
    pub to: Option<LayerTitle>,
    /// How many of those that crossed it notice the step.
    pub simulated_fingers: Verdicts,
    /// Median of the felt step, in Weber steps.
    pub weber_steps: f64,
    /// The layers that are only on that side, a bit each from the bottom.
    #[serde(skip)]
    layers: [u64; 2],
}

/// Two levels of friction beside one another in the order of their friction.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LevelScore {
    /// The layers with the lower friction.
    pub lower: Vec<LayerTitle>,
    /// The layers with the higher friction.
    pub higher: Vec<LayerTitle>,
    /// How many of those that touched both tell them apart.
    pub simulated_fingers: Verdicts,
    /// Median of what was felt between them, in Weber steps.
    pub weber_steps: f64,
}

impl LevelScore {
    /// Orders pairs of levels by how surely they are told apart, and then by their distance.
    pub(super) fn cmp_felt(&self, other: &Self) -> Ordering {
        let by_verdict = self.simulated_fingers.cmp_felt(&other.simulated_fingers);
        by_verdict.then(self.weber_steps.total_cmp(&other.weber_steps))
    }
}

/// A row for each layer that a finger touched, from bottom to top.
pub(super) fn layers(program: &Program, fingers: &[Finger]) -> Vec<LayerScore> {
    let titles = program.titles.iter().enumerate();
    titles.filter_map(|(layer, title)| layer_score(layer, title, program, fingers)).collect()
}

fn layer_score(layer: usize, title: &LayerTitle, program: &Program, fingers: &[Finger]) -> Option<LayerScore> {
    let touched = || fingers.iter().filter_map(|finger| Some((finger, finger.on(layer)?)));
    let verdict = |(finger, on_layer): (&Finger, &NoticedLayer)| {
        let borders = finger.borders.iter().filter(|border| (border.layers[0] | border.layers[1]) >> layer & 1 == 1);
        Verdict::of_any(borders.map(|border| border.step.verdict).chain([on_layer.verdict()]))
    };
    let mut textures: Vec<Texture> = touched().filter_map(|(_, on_layer)| on_layer.texture).collect();
    textures.sort_by(|one, other| one.salience().total_cmp(&other.salience()));
    let borders = borders(program, fingers);
    let steps = borders.iter().filter_map(|border| border.onto(layer));
    touched().next()?;
    Some(LayerScore {
        layer: title.clone(),
        simulated_fingers: touched().map(verdict).collect(),
        contrast_weber_steps: median(touched().map(|(_, on_layer)| on_layer.contrast.weber_steps)),
        texture: textures.get(textures.len() / 2).copied(),
        border: steps.max_by(|one, other| one.weber_steps.abs().total_cmp(&other.weber_steps.abs())),
    })
}

impl Verdicts {
    /// Orders by the share of the fingers that touched it which notice it, and then by the share near the threshold.
    pub(super) fn cmp_felt(&self, other: &Self) -> Ordering {
        let share = |count: fn(&Self) -> usize| {
            let shares = [self, other].map(|verdicts| count(verdicts) as f64 / verdicts.touched as f64);
            shares[0].total_cmp(&shares[1])
        };
        share(|verdicts| verdicts.felt).then(share(|verdicts| verdicts.felt_by_some))
    }
}

impl LayerScore {
    /// Orders layers by how surely they are noticed, and then by the size of what is felt of them.
    pub(super) fn cmp_felt(&self, other: &Self) -> Ordering {
        let by_verdict = self.simulated_fingers.cmp_felt(&other.simulated_fingers);
        by_verdict.then(self.size().total_cmp(&other.size()))
    }

    /// The largest of contrast, step and texture, as a part of what is surely felt.
    fn size(&self) -> f64 {
        let Self { contrast_weber_steps, border, texture, .. } = self;
        let step = border.as_ref().map_or(0.0, |border| border.weber_steps.abs());
        let texture = texture.map_or(0.0, |texture| texture.salience() / THRESHOLD_UNCERTAINTY);
        (contrast_weber_steps.abs().max(step) / weber_steps_safe()).max(texture)
    }

    /// The layer that is noticed the least surely: of copies, it stands for all of them.
    pub(super) fn least<'l>(layers: impl IntoIterator<Item = &'l Self>) -> Option<&'l Self> {
        layers.into_iter().min_by(|one, other| one.cmp_felt(other))
    }
}

impl Finger {
    fn on(&self, layer: usize) -> Option<&NoticedLayer> {
        self.layers.iter().find(|noticed| noticed.layer == layer)
    }

    /// Mean level of some layers; `None` if the finger touched none of them alone.
    fn level(&self, layers: &[usize]) -> Option<Level> {
        let levels = || layers.iter().filter_map(|layer| self.on(*layer)?.level);
        levels().next()?;
        Some(Level {
            scene_n: mean(levels().map(|level| level.scene_n)),
            felt_n: mean(levels().map(|level| level.felt_n)),
        })
    }
}

impl BorderScore {
    /// The border as that of a layer that is only on one side of it.
    fn onto(&self, layer: usize) -> Option<LayerBorder> {
        let Self { from, to, weber_steps, layers: [before, after], .. } = self;
        if after >> layer & 1 == 1 {
            Some(LayerBorder { from: from.clone(), weber_steps: *weber_steps })
        } else {
            (before >> layer & 1 == 1).then(|| LayerBorder { from: to.clone(), weber_steps: -weber_steps })
        }
    }
}

/// A row for each border that a finger crossed.
pub(super) fn borders(program: &Program, fingers: &[Finger]) -> Vec<BorderScore> {
    let mut sides: Vec<_> =
        fingers.iter().flat_map(|finger| finger.borders.iter().map(|border| border.sides)).collect();
    sides.sort_unstable();
    sides.dedup();
    let title = |side: Option<usize>| side.and_then(|layer| program.titles.get(layer).cloned());
    let score = |[from, to]: [Option<usize>; 2]| {
        let crossed = fingers.iter().flat_map(|finger| &finger.borders).filter(|border| border.sides == [from, to]);
        let steps = || crossed.clone().map(|border| border.step);
        let layers = crossed
            .clone()
            .fold([0, 0], |[before, after], border| [before | border.layers[0], after | border.layers[1]]);
        BorderScore {
            layers,
            from: title(from),
            to: title(to),
            simulated_fingers: steps().map(|step| step.verdict).collect(),
            weber_steps: median(steps().map(|step| step.weber_steps)),
        }
    };
    sides.into_iter().map(score).collect()
}

/// A row for each two levels that are next to one another. A level is that of the flat layers with the same friction in
/// the scene, of which a finger felt the inside: narrower ones have none.
pub(super) fn levels(program: &Program, fingers: &[Finger]) -> Vec<LevelScore> {
    let level = |layer: usize| {
        let touched = || fingers.iter().filter_map(|finger| finger.on(layer));
        let levels = touched().filter_map(|on_layer| Some(on_layer.level?.scene_n));
        let scene_n = mean(levels);
        (scene_n.is_finite() && touched().all(|on_layer| on_layer.is_flat)).then_some((layer, scene_n))
    };
    let mut flat: Vec<(usize, f64)> = (0..program.titles.len()).filter_map(level).collect();
    flat.sort_by(|(_, one_n), (_, other_n)| one_n.total_cmp(other_n));
    let are_same =
        |(_, one_n): &(usize, f64), (_, other_n): &(usize, f64)| weber_steps(*one_n, *other_n) < SAME_WEBER_STEPS;
    let groups = flat.chunk_by(are_same);
    let groups: Vec<Vec<usize>> = groups.map(|group| group.iter().map(|(layer, _)| *layer).collect()).collect();
    let titles = |group: &[usize]| group.iter().filter_map(|layer| program.titles.get(*layer).cloned()).collect();
    let score = |pair: &[Vec<usize>]| {
        let [lower, higher] = pair else { return None };
        let steps = || {
            let both = fingers.iter().filter_map(|finger| Some((finger.level(lower)?, finger.level(higher)?)));
            // The other way round is not the difference that the scene has.
            both.map(|(low, high)| Step::new(low.felt_n, high.felt_n.max(low.felt_n)))
        };
        steps().next()?;
        Some(LevelScore {
            lower: titles(lower),
            higher: titles(higher),
            simulated_fingers: steps().map(|step| step.verdict).collect(),
            weber_steps: median(steps().map(|step| step.weber_steps)),
        })
    };
    groups.windows(2).filter_map(score).collect()
}
