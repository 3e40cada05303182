//! Finds where layers overlap, and the range of their target friction there.
//!
//! The edges of all layers cut the screen into cells. Within a cell, the same rectangles apply everywhere. Each layer's
//! extremes in a cell follow from the bounds of its kind in `frixel-layers`, which the reference narrows to the cell
//! where it has a closed form. Blended, they bound the friction of the stack. If a single layer varies, the bound is
//! reached. For several varying layers, and for a layer whose outline crosses the cell, it need not be: such a cell is
//! searched for a place that is out of reach.

mod cell;

use std::collections::BTreeMap;

use frixel_layers::{Header, Interval};

pub(crate) use cell::Cell;
use cell::Coverage;

use crate::kinds::{Extremes, click_interval};
use crate::reference::{Context, Piece};

/// Width below which a cell is a rounding artefact, m.
const CELL_MIN_M: f64 = 1e-6;
/// Most places that are evaluated along each side of a cell.
const PLACES_PER_SIDE_MAX: f64 = 256.0;
/// Places that are evaluated along each side of a cell that an outline crosses.
const PLACES_PER_OUTLINE: f64 = 64.0;
/// Most places that are evaluated in a scene that is compiled.
pub(super) const PLACES_MAX: usize = 1_000_000;

/// Bare glass.
const ZERO: Interval<f64> = Interval { low: 0.0, high: 0.0 };

/// Layers whose friction is out of reach in a cell, or may be out of reach.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Excess {
    /// Numbers of the layers that apply there, from zero, from bottom to top.
    pub(super) layers: Vec<usize>,
    pub(super) cell: Cell,
    /// Range of the friction that the search found in the cell.
    pub(super) found: Interval<f64>,
    /// Bound on the friction in the cell.
    pub(super) bound: Interval<f64>,
}

/// The layers that apply in a cell.
struct Stack {
    /// Numbers of the layers, starting with the last one that replaces all below it.
    layers: Vec<usize>,
    bound: Interval<f64>,
    /// What keeps the bound from being reached: 1 for each layer that is not the same everywhere, 2 if its extremes are
    /// only bounded, and 1 for its outline in the cell. With up to 1, the bound is reached; with more, the cell is
    /// searched.
    doubts: usize,
    outlined: bool,
}

/// A cell in which the reach may be exceeded.
struct Suspect {
    cell: Cell,
    stack: Stack,
    /// Places to evaluate across and down; `None` if the bound counts as reached.
    grid: Option<(f64, f64)>,
}

/// All sets of layers that exceed `reach`, or may exceed it, somewhere on the screen of a scene, each with the cell
/// where it does so most. At about `places_max` places at most are evaluated: a scene that has more is searched with
/// coarser steps.
pub(super) fn excesses(header: &Header, pieces: &[Piece], reach: Interval<f64>, places_max: usize) -> Vec<Excess> {
    let extent = |excess: &Excess| (beyond(excess.found, reach), beyond(excess.bound, reach));
    let mut worst: BTreeMap<Vec<usize>, Excess> = BTreeMap::new();
    for excess in excesses_of_cells(header, pieces, reach, places_max) {
        if worst.get(&excess.layers).is_none_or(|other| extent(&excess) > extent(other)) {
            worst.insert(excess.layers.clone(), excess);
        }
    }
    worst.into_values().collect()
}

/// An interval, widened to all friction that layers ask for anywhere on the screen of a scene.
pub(super) fn widened(interval: Interval<f64>, header: &Header, pieces: &[Piece], places_max: usize) -> Interval<f64> {
    let excesses = excesses_of_cells(header, pieces, interval, places_max);
    excesses.iter().fold(interval, |range, excess| range.hull(excess.found))
}

fn excesses_of_cells(header: &Header, pieces: &[Piece], reach: Interval<f64>, places_max: usize) -> Vec<Excess> {
    let (width_m, height_m) = (f64::from(header.screen_width_m), f64::from(header.screen_height_m));
    let bounds: Vec<[f64; 4]> = pieces.iter().map(|piece| piece.shape.bounds_m()).collect();
    let columns = edges(width_m, bounds.iter().flat_map(|[left_m, _, right_m, _]| [*left_m, *right_m]));
    let rows = edges(height_m, bounds.iter().flat_map(|[_, top_m, _, bottom_m]| [*top_m, *bottom_m]));
    let mut suspects = Vec::new();
    for row in rows.windows(2) {
        for column in columns.windows(2) {
            let cell = Cell { left_m: column[0], top_m: row[0], right_m: column[1], bottom_m: row[1] };
            let stack = Stack::of(pieces, cell);
            if beyond(stack.bound, reach) > 0.0 {
                let grid = (stack.doubts > 1).then(|| grid(pieces, &stack, cell));
                suspects.push(Suspect { cell, stack, grid });
            }
        }
    }
    let places: f64 = suspects.iter().filter_map(|suspect| suspect.grid).map(|(across, down)| across * down).sum();
    let coarseness = (places / places_max as f64).sqrt().max(1.0);
    let searched = suspects.into_iter().map(|Suspect { cell, stack, grid }| {
        let found = grid.map_or(stack.bound, |(across, down)| {
            search(pieces, &stack, cell, [across / coarseness, down / coarseness])
        });
        Excess { layers: stack.layers, cell, found, bound: stack.bound }
    });
    searched.collect()
}

/// The edges of layers within the screen, and those of the screen, sorted.
fn edges(screen_m: f64, layers: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut edges: Vec<f64> = layers.filter(|edge| *edge > 0.0 && *edge < screen_m).collect();
    edges.extend([0.0, screen_m]);
    edges.sort_by(f64::total_cmp);
    edges.dedup_by(|later, earlier| *later - *earlier < CELL_MIN_M);
    edges
}

impl Stack {
    fn of(pieces: &[Piece], cell: Cell) -> Self {
        let mut stack = Self { layers: Vec::new(), bound: ZERO, doubts: 0, outlined: false };
        for (number, piece) in pieces.iter().enumerate().filter(|(_, piece)| piece.is_on) {
            let coverage = Coverage::of(&piece.shape, cell);
            if coverage == Coverage::None {
                continue;
            }
            let (extremes, doubts) = match piece.extremes_in(cell) {
                Extremes::Reached(extremes) => (extremes, usize::from(piece.bounds.low < piece.bounds.high)),
                Extremes::Bounded(bounds) => (bounds, 2),
            };
            let is_outlined = coverage == Coverage::Part;
            if piece.hides_below() && !is_outlined {
                stack = Self { layers: Vec::new(), bound: ZERO, doubts: 0, outlined: false };
            }
            stack.bound = piece.over(stack.bound, extremes, !is_outlined);
            stack.doubts += doubts + usize::from(is_outlined);
            stack.outlined |= is_outlined;
            stack.layers.push(number);
        }
        stack
    }
}

/// Places to evaluate across and down a cell, so that no detail of its layers is missed.
fn grid(pieces: &[Piece], stack: &Stack, cell: Cell) -> (f64, f64) {
    let layers = stack.layers.iter().filter_map(|layer| pieces.get(*layer));
    let detail_m = layers.filter_map(|piece| piece.field.detail_m()).fold(f64::INFINITY, f64::min);
    let least = if stack.outlined { PLACES_PER_OUTLINE } else { 8.0 };
    let places = |length_m: f64| (length_m / detail_m).ceil().clamp(least, PLACES_PER_SIDE_MAX);
    (places(cell.right_m - cell.left_m), places(cell.bottom_m - cell.top_m))
}

/// Range of the friction at so many places across and down a cell.
fn search(pieces: &[Piece], stack: &Stack, cell: Cell, grid: [f64; 2]) -> Interval<f64> {
    let layers: Vec<&Piece> = stack.layers.iter().filter_map(|layer| pieces.get(*layer)).collect();
    let [across, down] = grid.map(|places| places.round().max(1.0) as usize);
    let at = |start: f64, end: f64, place: usize, places: usize| {
        start + (end - start) * (place as f64 + 0.5) / places as f64
    };
    let intervals = (0..across * down).map(|place| {
        let x_m = at(cell.left_m, cell.right_m, place % across, across);
        let y_m = at(cell.top_m, cell.bottom_m, place / across, down);
        interval_at(layers.iter().copied(), x_m, y_m)
    });
    intervals.reduce(Interval::hull).unwrap_or(ZERO)
}

/// The range of the layers' combined target friction at a place, at any time and speed.
pub(super) fn interval_at<'p>(layers: impl Iterator<Item = &'p Piece>, x_m: f64, y_m: f64) -> Interval<f64> {
    let covering = layers.filter(|piece| piece.shape.covers(x_m, y_m));
    covering.fold(ZERO, |below, piece| piece.over(below, piece.interval_at(x_m, y_m), true))
}

impl Piece {
    /// The interval of the layer's friction at a place, at any time and speed, and with its click.
    fn interval_at(&self, x_m: f64, y_m: f64) -> Interval<f64> {
        if !self.field.is_still() {
            return self.bounds;
        }
        let still_n = self.field.at(&Context { x_m, y_m, ..Context::default() });
        Interval::of([still_n]).plus(click_interval(self.field.click()))
    }

    /// The extremes of the layer's friction in a cell, at any time and speed, and with its click.
    pub(crate) fn extremes_in(&self, cell: Cell) -> Extremes {
        if self.field.is_still() { self.field.extremes_in(cell, self.bounds) } else { Extremes::Reached(self.bounds) }
    }

    /// The interval after the layer is blended over those below it. `own` is its friction before its gain. A stream may
    /// be absent.
    fn over(&self, below: Interval<f64>, own: Interval<f64>, covers_all: bool) -> Interval<f64> {
        let own = own.times(Interval::of([self.gain]));
        self.blend.of_intervals(below, own, covers_all && !self.is_streamed)
    }
}

/// How far an interval exceeds the reach; zero within it.
pub(super) fn beyond(interval: Interval<f64>, reach: Interval<f64>) -> f64 {
    (reach.low - interval.low).max(interval.high - reach.high).max(0.0)
}
