//! How many simulated fingers notice each layer, and tell two levels apart.

use std::cmp::Ordering;

use frixel_felt::judge::{
    FLAT_WEBER_STEPS, Judgement, LayerVerdict, Level, Step, Texture, Verdict, felt_size, weber_steps,
};
use frixel_scene::{LayerTitle, Program};
use serde::Serialize;

use crate::statistics::{mean, median};

/// The simulated fingers that touched something, by their verdict.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Verdicts {
    /// Fingers that touched it.
    pub touched: usize,
    /// Fingers that notice it.
    pub felt: usize,
    /// Fingers near the threshold.
    pub maybe: usize,
    /// Fingers that do not notice it.
    pub not_felt: usize,
    /// Fingers that no study covers.
    pub unknown: usize,
}

impl Verdicts {
    /// The verdict of the one finger that these count.
    pub(crate) fn of_one(&self) -> Verdict {
        match *self {
            Self { felt: 1.., .. } => Verdict::Felt,
            Self { maybe: 1.., .. } => Verdict::Maybe,
            Self { unknown: 1.., .. } => Verdict::Unknown,
            _ => Verdict::NotFelt,
        }
    }

    /// Whether every finger that touched it notices it.
    pub(super) fn is_felt_by_all(&self) -> bool {
        self.felt == self.touched
    }

    /// Orders by the share of the fingers that touched it which notice it, and then by the share near the threshold.
    fn cmp_felt(&self, other: &Self) -> Ordering {
        let share = |count: fn(&Self) -> usize| {
            let shares = [self, other].map(|verdicts| count(verdicts) as f64 / verdicts.touched as f64);
            shares[0].total_cmp(&shares[1])
        };
        share(|verdicts| verdicts.felt).then(share(|verdicts| verdicts.maybe))
    }
}

impl FromIterator<Verdict> for Verdicts {
    fn from_iter<I: IntoIterator<Item = Verdict>>(verdicts: I) -> Self {
        let mut counts = Self::default();
        for verdict in verdicts {
            counts.touched += 1;
            *match verdict {
                Verdict::Felt => &mut counts.felt,
                Verdict::Maybe => &mut counts.maybe,
                Verdict::NotFelt => &mut counts.not_felt,
                Verdict::Unknown => &mut counts.unknown,
            } += 1;
        }
        counts
    }
}

/// Results of the simulated fingers that touched a layer. Sizes are medians over these fingers.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LayerScore {
    /// Number and title of the layer.
    pub layer: LayerTitle,
    /// Verdicts on the layer, by its contrast, its texture, or one of its borders.
    pub simulated_fingers: Verdicts,
    /// Felt contrast within the layer, without the step onto it, in Weber steps.
    pub contrast_weber_steps: f64,
    /// The texture of the finger in the middle, by its distance from the threshold; absent where no finger had one.
    pub texture: Option<Texture>,
    /// Its border with the largest felt step; absent where no finger crossed one.
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

/// Two levels of friction beside one another in the order of their friction.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LevelScore {
    /// The layers with the lower friction.
    pub lower: Vec<LayerTitle>,
    /// The layers with the higher friction.
    pub higher: Vec<LayerTitle>,
    /// Verdicts of the fingers that touched both on whether the levels differ.
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

/// A row for each layer that a finger was on, from bottom to top.
pub(super) fn layers(program: &Program, fingers: &[Judgement]) -> Vec<LayerScore> {
    program.titles.iter().filter_map(|title| layer_score(title, fingers)).collect()
}

fn layer_score(title: &LayerTitle, fingers: &[Judgement]) -> Option<LayerScore> {
    let touched = || fingers.iter().filter_map(|finger| on(finger, title));
    let mut textures: Vec<Texture> = touched().filter_map(|layer| layer.texture).collect();
    textures.sort_by(|one, other| one.salience().total_cmp(&other.salience()));
    let borders = || touched().filter_map(|layer| layer.border.as_ref());
    touched().next()?;
    Some(LayerScore {
        layer: title.clone(),
        simulated_fingers: touched().map(|layer| layer.verdict).collect(),
        contrast_weber_steps: median(touched().map(|layer| layer.contrast.weber_steps)),
        texture: textures.get(textures.len() / 2).copied(),
        border: borders().next().map(|first| LayerBorder {
            from: first.from.clone(),
            weber_steps: median(borders().map(|border| border.step.weber_steps)),
        }),
    })
}

impl LayerScore {
    /// Orders layers by how surely they are noticed, and then by the size of the felt change.
    pub(super) fn cmp_felt(&self, other: &Self) -> Ordering {
        let by_verdict = self.simulated_fingers.cmp_felt(&other.simulated_fingers);
        by_verdict.then(self.size().total_cmp(&other.size()))
    }

    /// The largest of contrast, step and texture, relative to the size that is felt with certainty.
    fn size(&self) -> f64 {
        let Self { contrast_weber_steps, border, texture, .. } = self;
        let step = border.as_ref().map_or(0.0, |border| border.weber_steps.abs());
        felt_size(contrast_weber_steps.abs().max(step), *texture)
    }

    /// The layer that is noticed the least surely: of copies, it stands for all of them.
    pub(super) fn least<'l>(layers: impl IntoIterator<Item = &'l Self>) -> Option<&'l Self> {
        layers.into_iter().min_by(|one, other| one.cmp_felt(other))
    }
}

/// A finger's result for a layer.
fn on<'f>(finger: &'f Judgement, title: &LayerTitle) -> Option<&'f LayerVerdict> {
    finger.layers.iter().find(|layer| layer.layer == *title)
}

/// Mean level of some layers; `None` if the finger felt the inside of none of them.
fn level(finger: &Judgement, layers: &[&LayerTitle]) -> Option<Level> {
    let levels = || layers.iter().filter_map(|title| on(finger, title)?.level);
    levels().next()?;
    Some(Level { scene_n: mean(levels().map(|level| level.scene_n)), felt_n: mean(levels().map(|level| level.felt_n)) })
}

/// A row for each two levels that are next to one another. A level is that of the flat layers with the same friction in
/// the scene, of which a finger felt the inside: narrower ones have none.
pub(super) fn levels(program: &Program, fingers: &[Judgement]) -> Vec<LevelScore> {
    let scene_n = |title: &LayerTitle| {
        let touched = || fingers.iter().filter_map(|finger| on(finger, title));
        let scene_n = mean(touched().filter_map(|layer| Some(layer.level?.scene_n)));
        (scene_n.is_finite() && touched().all(|layer| layer.is_flat)).then_some(scene_n)
    };
    let mut flat: Vec<(&LayerTitle, f64)> =
        program.titles.iter().filter_map(|title| Some((title, scene_n(title)?))).collect();
    flat.sort_by(|(_, one_n), (_, other_n)| one_n.total_cmp(other_n));
    let are_same = |(_, one_n): &(&LayerTitle, f64), (_, other_n): &(&LayerTitle, f64)| {
        weber_steps(*one_n, *other_n) < FLAT_WEBER_STEPS
    };
    let groups = flat.chunk_by(are_same);
    let groups: Vec<Vec<&LayerTitle>> = groups.map(|group| group.iter().map(|(title, _)| *title).collect()).collect();
    let score = |pair: &[Vec<&LayerTitle>]| {
        let [lower, higher] = pair else { return None };
        let steps = || {
            let both = fingers.iter().filter_map(|finger| Some((level(finger, lower)?, level(finger, higher)?)));
            // The other way round is not the difference that the scene has.
            both.map(|(low, high)| Step::new(low.felt_n, high.felt_n.max(low.felt_n)))
        };
        steps().next()?;
        Some(LevelScore {
            lower: lower.iter().copied().cloned().collect(),
            higher: higher.iter().copied().cloned().collect(),
            simulated_fingers: steps().map(|step| step.verdict).collect(),
            weber_steps: median(steps().map(|step| step.weber_steps)),
        })
    };
    groups.windows(2).filter_map(score).collect()
}
