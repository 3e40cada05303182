//! Steps of friction where one layer borders another.

use std::collections::BTreeMap;
use std::ops::Range;

use frixel_layers::{Blend, Layer};

use super::slide::{total_n, visible_layers};
use crate::percentile::percentiles;
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
    /// Means over squares as wide as the smallest size that is felt, N: below, that of the quarter of the border that
    /// differs most; above, the median.
    pub(super) met_n: [f64; 2],
    /// The layers that end there, which are on that side only, a bit each.
    pub(super) ends: [u64; 2],
}

/// Places on both sides of a border, and their friction.
#[derive(Clone, Debug, Default)]
struct Pairs {
    count: usize,
    sums_n: [f64; 2],
    met_n: [Vec<f64>; 2],
    ends: [u64; 2],
}

/// A place beside a border.
#[derive(Clone, Copy, Debug)]
struct Side {
    /// The layers that have an effect there, a bit each.
    visible: u64,
    friction_n: f64,
    /// Mean over a square beside the border.
    met_n: f64,
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

/// The borders between the layers of a program, for a slow finger. `smallest_m` is the smallest size that is felt.
pub(super) fn borders(program: &Program, speed_m_per_s: f64, smallest_m: f64) -> Vec<Border> {
    let reference = border_reference(program, |_| true);
    let (width_m, height_m) = (f64::from(program.header.screen_width_m), f64::from(program.header.screen_height_m));
    // A border across a narrow screen has as many pairs as one that counts.
    let places = |side_m: f64| ((PLACES * side_m / width_m.max(height_m)).round() as usize).max(PAIRS_MIN);
    let (columns, rows) = (places(width_m), places(height_m));
    let (column_m, row_m) = (width_m / columns as f64, height_m / rows as f64);
    let at = |number: usize| {
        let place_m = |cell: usize, pitch_m: f64| (cell as f64 + 0.5) * pitch_m;
        let (x_m, y_m) = (place_m(number % columns, column_m), place_m(number / columns, row_m));
        let context = Context { x_m, y_m, speed_m_per_s, ..Context::default() };
        (visible_layers(&reference, x_m, y_m), total_n(program, reference.electric_friction_at_n(&context)))
    };
    let cells: Vec<(u64, f64)> = (0..columns * rows).map(at).collect();
    let sums = Sums::new(columns, rows, |column, row| cells.get(row * columns + column).map_or(0.0, |cell| cell.1));
    let [wide, high] = [column_m, row_m].map(|pitch_m| ((smallest_m / pitch_m).round() as usize).max(1));
    let mut found: BTreeMap<[Option<usize>; 2], Pairs> = BTreeMap::new();
    for (number, here) in cells.iter().enumerate() {
        let (column, row) = (number % columns, number / columns);
        // The cells of a square before an index, behind it, and around it.
        let before = |end: usize, count: usize| end.saturating_sub(count)..end;
        let behind = |start: usize, count: usize| start..start + count;
        let around = |middle: usize, count: usize| behind(middle.saturating_sub(count / 2), count);
        let right = (column + 1 < columns).then(|| {
            let sides = [before(column + 1, wide), behind(column + 1, wide)];
            (number + 1, sides.map(|columns| sums.mean(columns, around(row, high))))
        });
        let below = [before(row + 1, high), behind(row + 1, high)].map(|rows| sums.mean(around(column, wide), rows));
        for (other, [here_met_n, other_met_n]) in right.into_iter().chain([(number + columns, below)]) {
            let Some(other) = cells.get(other).filter(|other| other.0 != here.0) else { continue };
            let side = |cell: &(u64, f64), met_n| Side { visible: cell.0, friction_n: cell.1, met_n };
            add(&mut found, side(here, here_met_n), side(other, other_met_n));
        }
    }
    let borders = found.into_iter().filter(|(_, pairs)| pairs.count >= PAIRS_MIN);
    let border = |(sides, pairs): ([Option<usize>; 2], Pairs)| {
        let Pairs { count, sums_n, met_n, ends } = pairs;
        let friction_n = sums_n.map(|sum_n| sum_n / count as f64);
        // At corners a square reaches beyond the layer, however large that is. A quarter of a border, such as one side of
        // a key beside others, is enough to come from.
        let quarter = if friction_n[0] < friction_n[1] { 25 } else { 75 };
        let [from_met_n, to_met_n] = met_n;
        let met_n = [(from_met_n, quarter), (to_met_n, 50)]
            .map(|(met_n, percent)| percentiles(met_n, [percent]).map_or(friction_n[0], |[met_n]| met_n));
        Border { sides, friction_n, met_n, ends }
    };
    borders.map(border).collect()
}

/// Counts a pair of places, with the lower layer first.
fn add(found: &mut BTreeMap<[Option<usize>; 2], Pairs>, one: Side, other: Side) {
    let (sides, is_turned) = border_sides(one.visible, other.visible);
    let (low, high) = if is_turned { (other, one) } else { (one, other) };
    let pairs = found.entry(sides).or_default();
    pairs.count += 1;
    pairs.sums_n[0] += low.friction_n;
    pairs.sums_n[1] += high.friction_n;
    pairs.met_n[0].push(low.met_n);
    pairs.met_n[1].push(high.met_n);
    pairs.ends[0] |= low.visible & !high.visible;
    pairs.ends[1] |= high.visible & !low.visible;
}

/// Sums over the cells of a grid from its first corner on, from which that over any rectangle follows.
#[derive(Clone, Debug)]
struct Sums {
    columns: usize,
    rows: usize,
    /// A row and a column more than the grid: the first are 0.
    sums: Vec<f64>,
}

impl Sums {
    fn new(columns: usize, rows: usize, value: impl Fn(usize, usize) -> f64) -> Self {
        let mut sums = vec![0.0; (columns + 1) * (rows + 1)];
        for row in 0..rows {
            let mut of_row = 0.0;
            for column in 0..columns {
                of_row += value(column, row);
                sums[(row + 1) * (columns + 1) + column + 1] = sums[row * (columns + 1) + column + 1] + of_row;
            }
        }
        Self { columns, rows, sums }
    }

    /// The mean over the cells of a rectangle that are within the grid.
    fn mean(&self, columns: Range<usize>, rows: Range<usize>) -> f64 {
        let (right, bottom) = (columns.end.min(self.columns), rows.end.min(self.rows));
        let at = |column: usize, row: usize| self.sums[row * (self.columns + 1) + column];
        let sum = at(right, bottom) - at(columns.start, bottom) - at(right, rows.start) + at(columns.start, rows.start);
        sum / ((right - columns.start) * (bottom - rows.start)).max(1) as f64
    }
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
