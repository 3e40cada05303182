//! Borders of an element crossed by a finger.

use std::ops::Range;

use frixel_layers::{Blend, Layer};
use frixel_scene::Program;
use frixel_scene::reference::{Context, Reference};

use super::fingertip::Fingertip;
use super::likeness::Likeness;
use super::moment::{Moment, ways_m};
use super::thresholds::FINGERTIP_M;
use super::touch::Sums;
use super::{Step, total_n, visible_layers};

/// Longest distance on either side of a border, m.
const SIDE_MAX_M: f64 = 0.01;
/// Longest time on either side of a border, in moments: 200 ms.
const SIDE_MAX: usize = 400;
/// Shortest time on one side, in moments (2 ms); less is a corner.
const SIDE_MIN: usize = 4;

/// The borders of an element.
pub(super) struct Borders {
    program: Program,
    layer: usize,
    reference: Reference,
    /// The scene without the element if the element adds to the layers below, whose own changes are not its step.
    below: Option<Reference>,
}

/// A border of an element crossed by a finger, in either direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct CrossedBorder {
    /// The layer on the other side; absent for the bare screen.
    pub(super) from: Option<usize>,
    /// The felt part of the step onto the element.
    pub(super) step: Step,
}

impl Borders {
    /// Borders are evaluated with vibrations at their largest, and without clicks, streams and added ridges. A ridge is
    /// perceived by itself, and the end of its region is not perceptible.
    pub(super) fn new(program: &Program, layer: usize, joins: bool, starts_on: impl Fn(usize) -> bool) -> Self {
        let is_ridge_on_ground = |layer: usize| {
            let record = program.records.get(layer);
            record.is_some_and(|record| matches!(record.layer, Layer::Edge(_)) && record.blend != Blend::Replace)
        };
        let reference = Reference::new(program)
            .with_vibrations_held()
            .with_only(|layer| starts_on(layer) && !is_ridge_on_ground(layer));
        let without = |other: usize| other != layer && starts_on(other) && !is_ridge_on_ground(other);
        let below = joins.then(|| reference.clone().with_only(without));
        Self { program: program.clone(), layer, reference, below }
    }

    /// The most certainly perceived border in a run.
    pub(super) fn met(&self, run: &[Moment], fingertip: &Fingertip) -> Option<CrossedBorder> {
        let visible = |moment: &Moment| visible_layers(&self.reference, moment.context.x_m, moment.context.y_m);
        let visible: Vec<u64> = run.iter().map(visible).collect();
        let felt_n: Vec<f64> = run.iter().map(|moment| moment.felt_n).collect();
        let felt_n = fingertip.smoothed(&felt_n, 0..felt_n.len());
        let scene_n: Vec<f64> = run.iter().map(|moment| moment.scene_n).collect();
        let same: Vec<&[u64]> = visible.chunk_by(|one, other| one == other).collect();
        let mut place = 0;
        let mut found: Option<CrossedBorder> = None;
        for pair in same.windows(2) {
            let [before, after] = pair else { continue };
            place += before.len();
            let is_on = [before, after].map(|side| side.first().is_some_and(|layers| layers >> self.layer & 1 == 1));
            let first = side(run.iter().take(place).rev(), before.len());
            let second = side(run.iter().skip(place), after.len());
            let (Some(first), Some(second), true) = (first, second, is_on[0] != is_on[1]) else { continue };
            let sides = [place - first.end..place - first.start, place + second.start..place + second.end];
            let met = self.cross(run, sides, is_on[1], [&scene_n, &felt_n]);
            found = super::measure::surest(found, met, |border| border.step);
        }
        found
    }

    /// The border between the moments before and after it, as a step onto the element.
    fn cross(
        &self,
        run: &[Moment],
        [before, after]: [Range<usize>; 2],
        is_onto: bool,
        [scene_n, felt_n]: [&[f64]; 2],
    ) -> Option<CrossedBorder> {
        let electric_n = |reference: &Reference, context: &Context| {
            total_n(&self.program, reference.electric_friction_at_n(context)) - self.program.reach.natural_friction_n
        };
        let side = |moment: &Moment| {
            let context = Context { t_s: 0.0, ..moment.context };
            let electric_n = electric_n(&self.reference, &context);
            (visible_layers(&self.reference, context.x_m, context.y_m), electric_n)
        };
        let sides = [side(run.get(before.end - 1)?), side(run.get(after.start)?)];
        let [(other_layers, other_n), (own_layers, own_n)] = if is_onto { sides } else { [sides[1], sides[0]] };
        let own = run.get(if is_onto { after.start } else { before.end - 1 })?;
        let at_border = Context { t_s: 0.0, ..own.context };
        let other_n = self.below.as_ref().map_or(other_n, |below| electric_n(below, &at_border));
        let mut sums = Sums::default();
        before.clone().chain(after.clone()).filter_map(|number| run.get(number)).for_each(|moment| sums.add(moment));
        let (low, high) = if is_onto { (0.0, 1.0) } else { (1.0, 0.0) };
        let mut likeness = Likeness::default();
        let signal = before.map(|number| (number, low)).chain(after.map(|number| (number, high)));
        likeness.add(signal, scene_n, felt_n);
        let step = sums.felt_part([other_n, own_n], likeness.part_of_scene());
        Some(CrossedBorder { from: own_layer(other_layers, own_layers), step })
    }
}

/// The moments of one side to use, starting at the border; `None` for a corner. `same` is the number of moments with
/// the same layers.
fn side<'m>(moments: impl Iterator<Item = &'m Moment>, same: usize) -> Option<Range<usize>> {
    let ways_m = ways_m(moments).take(same.min(SIDE_MAX)).take_while(|way_m| *way_m < SIDE_MAX_M);
    let (near, all) = ways_m.fold((0, 0), |(near, all), way_m| (near + usize::from(way_m < FINGERTIP_M), all + 1));
    (all >= SIDE_MIN).then(|| near.min(all - SIDE_MIN)..all)
}

/// The layer that characterises a place: the topmost one that is absent at the other place, or the topmost one.
fn own_layer(layers: u64, other_layers: u64) -> Option<usize> {
    let own = layers & !other_layers;
    (if own == 0 { layers } else { own }).checked_ilog2().map(|bit| bit as usize)
}
