//! Finds where layers overlap, and the range of their target friction there.
//!
//! The edges of all layers cut the screen into cells, within which the same rectangles apply everywhere. Each layer's
//! extremes in a cell follow from the bounds of its kind in `frixel-layers`, narrowed to the cell where the reference
//! has a closed form. Blending them bounds the friction of the stack. The bound is reached if a single layer varies. It
//! may not be reached if several layers vary, or if a layer's outline crosses the cell; such a cell is searched for a
//! place out of reach.
//!
//! # Why six kinds have closed forms
//!
//! Gratings, rings, spokes, edges, pictures and buttons narrow their bounds in
//! [`extremes_in`](crate::kinds::Field::extremes_in). Sampling alone would give other answers. It evaluates the middles
//! of a grid, so it meets no crest: a layer that exceeds the reach by 1 % at its crests would be accepted, and numbers
//! in messages would depend on the grid. It misses stripes narrower than the grid altogether: in the test
//! `a_target_range_has_what_lies_between_its_places`, all places lie at the mean of the stripes. A closed form gives
//! the extremes to rounding (`extremes_hold_all_over_a_cell`), from the corners of the cell and at most one other place
//! (a picture's from its samples there), where a grid takes 64 to 65,536 places. So scenes of separate layers, the
//! usual ones, compile without a search.

mod cell;

use std::collections::BTreeMap;

use frixel_layers::{Header, Interval};

pub(crate) use cell::Cell;
use cell::Coverage;

use crate::kinds::{Extremes, click_interval};
use crate::reference::{Context, ReferenceLayer};

/// Width below which a cell is a rounding artefact, m.
const CELL_MIN_M: f64 = 1e-6;
/// Largest number of places evaluated along each side of a cell.
const PLACES_PER_SIDE_MAX: f64 = 256.0;
/// Number of places evaluated along each side of a cell that an outline crosses.
const PLACES_PER_OUTLINE: f64 = 64.0;
/// Largest number of places evaluated when a scene is compiled.
pub(super) const PLACES_MAX: usize = 1_000_000;

/// Bare glass.
const ZERO: Interval<f64> = Interval { low: 0.0, high: 0.0 };

/// Layers whose friction is, or may be, out of reach in a cell.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Excess {
    /// Indices of the layers that apply there, from bottom to top.
    pub(super) layers: Vec<usize>,
    pub(super) cell: Cell,
    /// Range of the friction found by searching the cell.
    pub(super) found: Interval<f64>,
    /// Bound on the friction in the cell.
    pub(super) bound: Interval<f64>,
}

/// The layers that apply in a cell.
struct Stack {
    /// Indices of the layers, starting with the last one that replaces all below it.
    layers: Vec<usize>,
    bound: Interval<f64>,
    /// Reasons why the bound may not be reached: 1 for each layer that varies, 2 if its extremes are only bounded, plus
    /// 1 if its outline crosses the cell. Up to 1, the bound is reached; above, the cell is searched.
    doubts: usize,
    outlined: bool,
}

/// A cell in which the reach may be exceeded.
struct Suspect {
    cell: Cell,
    stack: Stack,
    /// Places to evaluate across and down; `None` if the bound is treated as reached.
    grid: Option<(f64, f64)>,
}

/// Returns all sets of layers that exceed, or may exceed, `reach` on a scene's screen, each with the cell of its
/// largest excess. Evaluates about `places_max` places at most, in coarser steps if a scene has more.
pub(super) fn excesses(
    header: &Header,
    pieces: &[ReferenceLayer],
    reach: Interval<f64>,
    places_max: usize,
) -> Vec<Excess> {
    let extent = |excess: &Excess| (beyond(excess.found, reach), beyond(excess.bound, reach));
    let mut worst: BTreeMap<Vec<usize>, Excess> = BTreeMap::new();
    for excess in excesses_of_cells(header, pieces, reach, places_max) {
        if worst.get(&excess.layers).is_none_or(|other| extent(&excess) > extent(other)) {
            worst.insert(excess.layers.clone(), excess);
        }
    }
    worst.into_values().collect()
}

/// An interval, widened to the friction that layers ask for anywhere on a scene's screen.
pub(super) fn widened(
    interval: Interval<f64>,
    header: &Header,
    pieces: &[ReferenceLayer],
    places_max: usize,
) -> Interval<f64> {
    let excesses = excesses_of_cells(header, pieces, interval, places_max);
    excesses.iter().fold(interval, |range, excess| range.hull(excess.found))
}

fn excesses_of_cells(
    header: &Header,
    pieces: &[ReferenceLayer],
    reach: Interval<f64>,
    places_max: usize,
) -> Vec<Excess> {
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

/// The sorted edges of the screen, and of the layers within it.
fn edges(screen_m: f64, layers: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut edges: Vec<f64> = layers.filter(|edge| *edge > 0.0 && *edge < screen_m).collect();
    edges.extend([0.0, screen_m]);
    edges.sort_by(f64::total_cmp);
    edges.dedup_by(|later, earlier| *later - *earlier < CELL_MIN_M);
    edges
}

impl Stack {
    fn of(pieces: &[ReferenceLayer], cell: Cell) -> Self {
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

/// Number of places to evaluate across and down a cell without missing a detail of its layers.
fn grid(pieces: &[ReferenceLayer], stack: &Stack, cell: Cell) -> (f64, f64) {
    let layers = stack.layers.iter().filter_map(|layer| pieces.get(*layer));
    let detail_m = layers.filter_map(|piece| piece.field.detail_m()).fold(f64::INFINITY, f64::min);
    let least = if stack.outlined { PLACES_PER_OUTLINE } else { 8.0 };
    let places = |length_m: f64| (length_m / detail_m).ceil().clamp(least, PLACES_PER_SIDE_MAX);
    (places(cell.right_m - cell.left_m), places(cell.bottom_m - cell.top_m))
}

/// Range of the friction on a grid of places in a cell.
fn search(pieces: &[ReferenceLayer], stack: &Stack, cell: Cell, grid: [f64; 2]) -> Interval<f64> {
    let layers: Vec<&ReferenceLayer> = stack.layers.iter().filter_map(|layer| pieces.get(*layer)).collect();
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

/// Range of the layers' combined target friction at a place, over all times and speeds.
pub(super) fn interval_at<'p>(layers: impl Iterator<Item = &'p ReferenceLayer>, x_m: f64, y_m: f64) -> Interval<f64> {
    let covering = layers.filter(|piece| piece.shape.covers(x_m, y_m));
    covering.fold(ZERO, |below, piece| piece.over(below, piece.interval_at(x_m, y_m), true))
}

impl ReferenceLayer {
    /// Range of the layer's friction at a place, over all times and speeds, click included.
    fn interval_at(&self, x_m: f64, y_m: f64) -> Interval<f64> {
        if !self.field.is_still() {
            return self.bounds;
        }
        let still_n = self.field.at(&Context { x_m, y_m, ..Context::default() });
        Interval::of([still_n]).plus(click_interval(self.field.click()))
    }

    /// Extremes of the layer's friction in a cell, over all times and speeds, click included.
    pub(crate) fn extremes_in(&self, cell: Cell) -> Extremes {
        if self.field.is_still() { self.field.extremes_in(cell, self.bounds) } else { Extremes::Reached(self.bounds) }
    }

    /// Blends the layer over the interval of the layers below. `own` is its friction before its gain. A stream may be
    /// absent.
    fn over(&self, below: Interval<f64>, own: Interval<f64>, covers_all: bool) -> Interval<f64> {
        let own = own.times(Interval::of([self.gain]));
        self.blend.of_intervals(below, own, covers_all && !self.is_streamed)
    }
}

/// Excess of an interval over the reach; zero within it.
pub(super) fn beyond(interval: Interval<f64>, reach: Interval<f64>) -> f64 {
    (reach.low - interval.low).max(interval.high - reach.high).max(0.0)
}
