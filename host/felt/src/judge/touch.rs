//! Parts of a run on which the finger was on an element, and their perception.

use std::ops::Range;

use super::measure::SceneContrast;
use super::moment::{MOMENT_HZ, Moment, ways_m};
use super::thresholds::{FINGERTIP_M, WAY_MAX_M};
use super::{Step, Texture};

/// Perception on a part of a run.
#[derive(Clone, Copy, Debug)]
pub(super) struct Touch {
    pub(super) contrast: Step,
    pub(super) is_narrow: bool,
    pub(super) texture: Option<Texture>,
    /// The largest contrast of the scene on a way: smallest and largest electric friction of its own, N.
    pub(super) widest_n: [f64; 2],
    /// The felt fraction of it.
    pub(super) slope: f64,
    pub(super) scene: SceneContrast,
}

impl Touch {
    /// Combines two touches by the more certain perception. The contrast over the direction is between touches.
    pub(super) fn united(self, other: Self) -> Self {
        let surer = |one: Step, other: Step| if other.cmp_felt(&one).is_gt() { other } else { one };
        let contrast = surer(self.contrast, other.contrast);
        let textures = self.texture.into_iter().chain(other.texture);
        Self {
            contrast,
            is_narrow: if contrast == self.contrast { self.is_narrow } else { other.is_narrow },
            texture: textures.max_by(|one, other| one.salience().total_cmp(&other.salience())),
            widest_n: [self.widest_n[0].min(other.widest_n[0]), self.widest_n[1].max(other.widest_n[1])],
            slope: self.slope.max(other.slope),
            scene: SceneContrast {
                sharp: surer(self.scene.sharp, other.scene.sharp),
                whole: self.scene.whole,
                visible: self.scene.visible | other.scene.visible,
            },
        }
    }
}

/// Sums of electric and natural friction, N.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sums {
    pub(super) count: f64,
    pub(super) scene_n: f64,
    pub(super) felt_n: f64,
    pub(super) natural_n: f64,
}

impl Sums {
    pub(super) fn add(&mut self, moment: &Moment) {
        self.count += 1.0;
        self.scene_n += moment.scene_n;
        self.felt_n += moment.felt_n;
        self.natural_n += moment.natural_n;
    }

    /// The step between two electric frictions, whose distances from `mean_n` are felt by the fraction `part`.
    pub(super) fn felt_step(&self, [from_n, to_n]: [f64; 2], mean_n: f64, part: f64) -> Step {
        let [felt_n, natural_n] = [self.felt_n, self.natural_n].map(|sum| sum / self.count);
        let total_n = |electric_n: f64| natural_n + (felt_n + part * (electric_n - mean_n)).max(0.0);
        Step::new(total_n(from_n), total_n(to_n))
    }

    /// The felt fraction of the step between two electric frictions of the scene.
    pub(super) fn felt_part(&self, sides_n: [f64; 2], part: f64) -> Step {
        self.felt_step(sides_n, self.scene_n / self.count, part)
    }
}

/// The longest ranges of a run whose moments all satisfy `is_wanted`.
pub(super) fn stretches(run: &[Moment], is_wanted: impl Fn(&Moment) -> bool) -> Vec<Range<usize>> {
    let parts = run.chunk_by(|one, other| is_wanted(one) == is_wanted(other));
    let ranges = parts.scan(0, |end, part| {
        *end += part.len();
        Some(part.first().is_some_and(&is_wanted).then_some(*end - part.len()..*end))
    });
    ranges.flatten().collect()
}

/// The moments of a range farther from both ends than a fingertip's resolution.
pub(super) fn inner(stretch: &[Moment]) -> &[Moment] {
    let from = near_count(stretch.iter(), FINGERTIP_M);
    let to = stretch.len() - near_count(stretch.iter().rev(), FINGERTIP_M);
    stretch.get(from..to).unwrap_or_default()
}

/// Number of moments of a way closer to its start than a distance.
fn near_count<'m>(way: impl Iterator<Item = &'m Moment>, distance_m: f64) -> usize {
    ways_m(way).take_while(|way_m| *way_m < distance_m).count()
}

/// Parts of a touch that are at most [`WAY_MAX_M`] long.
pub(super) fn ways(touch: &[Moment]) -> Vec<Range<usize>> {
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
