//! Where layers lie over each other, and what friction they can ask for there.
//!
//! The edges of all layers cut the screen into cells; in each cell the same layers count everywhere. What one layer
//! asks for in a cell is known exactly. A sum of several that vary has a bound that need not be reached, so it is
//! also searched for a place that is out of reach.

use std::collections::BTreeMap;

use frixel_wire::scene::Wave;

use crate::wanted::{Field, Grating, Piece, Samples};

/// Cells narrower than this come from rounding, m.
const CELL_MIN_M: f64 = 1e-6;
/// Most places that are looked at along each side of a cell.
const PLACES_PER_SIDE_MAX: f64 = 256.0;
/// Most places that are looked at in a scene.
const PLACES_MAX: usize = 1_000_000;

/// Least and largest electric friction, N.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Span {
    pub(super) low_n: f64,
    pub(super) high_n: f64,
}

/// A rectangle of the screen, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cell {
    pub(super) left_m: f64,
    pub(super) top_m: f64,
    pub(super) right_m: f64,
    pub(super) bottom_m: f64,
}

/// Layers whose friction leaves the reach somewhere, or may.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Excess {
    /// Numbers of the layers that count there, from zero, the first one at the bottom.
    pub(super) layers: Vec<usize>,
    /// A cell where they go furthest.
    pub(super) cell: Cell,
    /// Friction that a finger finds there.
    pub(super) found: Span,
    /// Friction that it cannot leave there.
    pub(super) bound: Span,
}

impl Span {
    const ZERO: Self = Self { low_n: 0.0, high_n: 0.0 };

    fn of(values: impl Iterator<Item = f64>) -> Self {
        values.fold(Self { low_n: f64::INFINITY, high_n: f64::NEG_INFINITY }, |span, value| Self {
            low_n: span.low_n.min(value),
            high_n: span.high_n.max(value),
        })
    }

    fn plus(self, other: Self) -> Self {
        Self { low_n: self.low_n + other.low_n, high_n: self.high_n + other.high_n }
    }

    /// How far it leaves the other span.
    fn beyond(self, reach: Self) -> f64 {
        (reach.low_n - self.low_n).max(self.high_n - reach.high_n).max(0.0)
    }
}

/// Every set of layers that leaves `reach` somewhere on a screen of this size, or may leave it.
pub(super) fn excesses(pieces: &[Piece], width_m: f64, height_m: f64, reach: Span) -> Vec<Excess> {
    let columns = edges(width_m, pieces.iter().flat_map(|piece| [piece.left_m, piece.right_m]));
    let rows = edges(height_m, pieces.iter().flat_map(|piece| [piece.top_m, piece.bottom_m]));
    let mut worst: BTreeMap<Vec<usize>, Excess> = BTreeMap::new();
    let mut places_left = PLACES_MAX;
    for row in rows.windows(2) {
        for column in columns.windows(2) {
            let cell = Cell { left_m: column[0], top_m: row[0], right_m: column[1], bottom_m: row[1] };
            let layers = counting(pieces, cell);
            let bound = layers.iter().fold(Span::ZERO, |sum, layer| sum.plus(span(&pieces[*layer].field, cell)));
            if bound.beyond(reach) == 0.0 {
                continue;
            }
            let found = search(pieces, &layers, cell, &mut places_left).unwrap_or(bound);
            let excess = Excess { layers: layers.clone(), cell, found, bound };
            let further = |other: &Excess| {
                (found.beyond(reach), bound.beyond(reach)) > (other.found.beyond(reach), other.bound.beyond(reach))
            };
            if worst.get(&layers).is_none_or(further) {
                worst.insert(layers, excess);
            }
        }
    }
    worst.into_values().collect()
}

/// Edges within the screen, in order, and the screen's own.
fn edges(screen_m: f64, layers: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut edges: Vec<f64> = layers.filter(|edge| *edge > 0.0 && *edge < screen_m).collect();
    edges.extend([0.0, screen_m]);
    edges.sort_by(f64::total_cmp);
    edges.dedup_by(|later, earlier| *later - *earlier < CELL_MIN_M);
    edges
}

/// The layers that count in a cell: the last that replaces, and those added after it.
fn counting(pieces: &[Piece], cell: Cell) -> Vec<usize> {
    let (x_m, y_m) = (f64::midpoint(cell.left_m, cell.right_m), f64::midpoint(cell.top_m, cell.bottom_m));
    let mut layers = Vec::new();
    for (number, piece) in pieces.iter().enumerate().rev() {
        if piece.covers(x_m, y_m) {
            layers.push(number);
            if !piece.adds {
                break;
            }
        }
    }
    layers.reverse();
    layers
}

/// What a layer asks for in a cell, exactly.
fn span(field: &Field, cell: Cell) -> Span {
    match field {
        Field::Constant(friction_n) => Span { low_n: *friction_n, high_n: *friction_n },
        Field::Grating(grating) => grating_span(grating, cell),
        Field::Samples(samples) => {
            // A bilinear patch has its extremes at its corners: samples' centres, and where the cell cuts it.
            let columns = vertices(cell.left_m, cell.right_m, samples.x_m, samples.pitch_m, samples.width);
            let rows = vertices(cell.top_m, cell.bottom_m, samples.y_m, samples.pitch_m, samples.height);
            Span::of(rows.iter().flat_map(|y_m| columns.iter().map(|x_m| field.at(*x_m, *y_m))))
        }
    }
}

fn grating_span(grating: &Grating, cell: Cell) -> Span {
    let corners = [
        grating.turns(cell.left_m, cell.top_m),
        grating.turns(cell.right_m, cell.top_m),
        grating.turns(cell.left_m, cell.bottom_m),
        grating.turns(cell.right_m, cell.bottom_m),
    ];
    // Over a rectangle the phase takes every value between its least and its largest.
    let turns = Span::of(corners.into_iter());
    let passes = |turn: f64| libm::floor(turns.high_n - turn) > libm::floor(turns.low_n - turn);
    let (trough_n, crest_n) = (grating.trough_n, grating.trough_n + grating.span_n);
    let ends = [turns.low_n, turns.high_n].into_iter().map(|turns| grating.at_turns(turns));
    let extremes = match grating.wave {
        Wave::Sine => [(passes(0.25), crest_n), (passes(0.75), trough_n)],
        Wave::Square => [(passes(0.0), crest_n), (passes(0.5), trough_n)],
    };
    let passed = extremes.into_iter().filter(|(passed, _)| *passed).map(|(_, friction_n)| friction_n);
    Span::of(ends.chain(passed))
}

/// The ends of a stretch, and the sample centres within it.
fn vertices(start_m: f64, end_m: f64, first_m: f64, pitch_m: f64, samples: usize) -> Vec<f64> {
    let number = |place_m: f64| (place_m - first_m) / pitch_m - 0.5;
    let after = (number(end_m).floor() + 1.0).clamp(0.0, samples as f64) as usize;
    let mut vertices = vec![start_m, end_m];
    vertices.extend((number(start_m).ceil().max(0.0) as usize..after).map(|n| first_m + (n as f64 + 0.5) * pitch_m));
    vertices
}

/// What a finger finds at many places of a cell; nothing where the bound is exact, because at most one layer varies.
fn search(pieces: &[Piece], layers: &[usize], cell: Cell, places_left: &mut usize) -> Option<Span> {
    let detail_m: Vec<f64> = layers.iter().filter_map(|layer| detail_m(&pieces[*layer].field)).collect();
    if detail_m.len() < 2 {
        return None;
    }
    let step_m = Span::of(detail_m.into_iter()).low_n;
    let places = |length_m: f64| (length_m / step_m).ceil().clamp(8.0, PLACES_PER_SIDE_MAX) as usize;
    let (across, down) = (places(cell.right_m - cell.left_m), places(cell.bottom_m - cell.top_m));
    *places_left = places_left.saturating_sub(across * down);
    if *places_left == 0 {
        return Some(Span::ZERO);
    }
    let at = |start: f64, end: f64, place: usize, places: usize| {
        start + (end - start) * (place as f64 + 0.5) / places as f64
    };
    Some(Span::of((0..across * down).map(|place| {
        let x_m = at(cell.left_m, cell.right_m, place % across, across);
        let y_m = at(cell.top_m, cell.bottom_m, place / across, down);
        layers.iter().map(|layer| pieces[*layer].field.at(x_m, y_m)).sum()
    })))
}

/// Length over which a layer varies little, m; nothing for a constant.
fn detail_m(field: &Field) -> Option<f64> {
    match field {
        Field::Constant(_) => None,
        Field::Grating(Grating { cycles_per_m_x, cycles_per_m_y, .. }) => {
            Some(0.1 / libm::hypot(*cycles_per_m_x, *cycles_per_m_y))
        }
        Field::Samples(Samples { pitch_m, .. }) => Some(*pitch_m),
    }
}
