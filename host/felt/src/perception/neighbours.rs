//! Steps of friction where one layer borders another.

use std::collections::BTreeMap;

use frixel_layers::{Blend, Layer};

use super::slide::{total_n, visible_layers};
use frixel_scene::Program;
use frixel_scene::reference::{Context, Reference};

/// Places along the longer side of the screen.
const PLACES: f64 = 300.0;
/// Least number of pairs of places of a border; fewer are a corner.
const PAIRS_MIN: usize = 3;

/// A border between two layers; `None` is the bare screen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Border {
    pub(super) sides: [Option<usize>; 2],
    /// Mean total friction on either side, N.
    pub(super) friction_n: [f64; 2],
}

/// Places on both sides of a border, and their friction.
#[derive(Clone, Copy, Debug, Default)]
struct Pairs {
    count: usize,
    sums_n: [f64; 2],
}

/// What borders are judged by: vibrations at their largest, without clicks, streams, and ridges on what lies below: a
/// ridge is felt by itself, and its region ends where nothing is felt. Only those layers are on for whose index `is_on` is
/// true.
pub(crate) fn border_reference(program: &Program, is_on: impl Fn(usize) -> bool) -> Reference {
    let is_ridge_on_ground = |layer: usize| {
        let record = program.records.get(layer);
        record.is_some_and(|record| matches!(record.layer, Layer::Edge(_)) && record.blend != Blend::Replace)
    };
    Reference::new(program).with_vibrations_held().with_only(|layer| is_on(layer) && !is_ridge_on_ground(layer))
}

/// The borders between the layers of a program, for a slow finger.
pub(super) fn borders(program: &Program, speed_m_per_s: f64) -> Vec<Border> {
    let reference = border_reference(program, |_| true);
    let (width_m, height_m) = (f64::from(program.header.screen_width_m), f64::from(program.header.screen_height_m));
    let pitch_m = width_m.max(height_m) / PLACES;
    let (columns, rows) = ((width_m / pitch_m) as usize, (height_m / pitch_m) as usize);
    let at = |number: usize| {
        let place_m = |cell: usize| (cell as f64 + 0.5) * pitch_m;
        let (x_m, y_m) = (place_m(number % columns), place_m(number / columns));
        let context = Context { x_m, y_m, speed_m_per_s, ..Context::default() };
        (visible_layers(&reference, x_m, y_m), total_n(program, reference.electric_friction_at_n(&context)))
    };
    let cells: Vec<(u64, f64)> = (0..columns * rows).map(at).collect();
    let mut found: BTreeMap<[Option<usize>; 2], Pairs> = BTreeMap::new();
    for (number, here) in cells.iter().enumerate() {
        let right = (number % columns + 1 < columns).then_some(number + 1);
        for other in [right, Some(number + columns)].into_iter().flatten().filter_map(|other| cells.get(other)) {
            if here.0 != other.0 {
                add(&mut found, *here, *other);
            }
        }
    }
    let borders = found.into_iter().filter(|(_, pairs)| pairs.count >= PAIRS_MIN);
    borders
        .map(|(sides, pairs)| Border { sides, friction_n: pairs.sums_n.map(|sum| sum / pairs.count as f64) })
        .collect()
}

/// Counts a pair of places, with the lower layer first.
fn add(found: &mut BTreeMap<[Option<usize>; 2], Pairs>, one: (u64, f64), other: (u64, f64)) {
    let (sides, is_turned) = border_sides(one.0, other.0);
    let (low, high) = if is_turned { (other, one) } else { (one, other) };
    let pairs = found.entry(sides).or_default();
    pairs.count += 1;
    pairs.sums_n[0] += low.1;
    pairs.sums_n[1] += high.1;
}

/// What a person would call two places beside one another by, the lower layer first, and whether that is the second
/// place. A place has a set of layers, a bit each.
pub(crate) fn border_sides(one: u64, other: u64) -> ([Option<usize>; 2], bool) {
    let (one, other) = (own_layer(one, other), own_layer(other, one));
    if other < one { ([other, one], true) } else { ([one, other], false) }
}

/// The layer by which a person would call a place: the uppermost that the other place does not have, or the uppermost.
fn own_layer(layers: u64, other_layers: u64) -> Option<usize> {
    let own = layers & !other_layers;
    (if own == 0 { layers } else { own }).checked_ilog2().map(|bit| bit as usize)
}
