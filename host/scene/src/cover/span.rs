//! Least and largest friction of layers.

use frixel_layers::{Blend, Click, Wave};

use super::cell::Cell;
use crate::reference::{Context, Edge, Field, Grating, Piece, Samples};

/// Least and largest electric friction, N.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in super::super) struct Span {
    pub(in super::super) low_n: f64,
    pub(in super::super) high_n: f64,
}

impl Span {
    pub(in super::super) const ZERO: Self = Self { low_n: 0.0, high_n: 0.0 };

    pub(super) fn of(values: impl Iterator<Item = f64>) -> Self {
        values.fold(Self { low_n: f64::INFINITY, high_n: f64::NEG_INFINITY }, |span, value| Self {
            low_n: span.low_n.min(value),
            high_n: span.high_n.max(value),
        })
    }

    pub(in super::super) fn hull(self, other: Self) -> Self {
        Self { low_n: self.low_n.min(other.low_n), high_n: self.high_n.max(other.high_n) }
    }

    pub(super) fn times(self, factor: f64) -> Self {
        Self::of([self.low_n * factor, self.high_n * factor].into_iter())
    }

    /// A layer's span joined to that of the layers below.
    pub(super) fn blended(self, own: Self, blend: Blend) -> Self {
        match blend {
            Blend::Replace => own,
            Blend::Add => Self { low_n: self.low_n + own.low_n, high_n: self.high_n + own.high_n },
            Blend::Multiply => self.times(own.low_n).hull(self.times(own.high_n)),
            Blend::Max => Self { low_n: self.low_n.max(own.low_n), high_n: self.high_n.max(own.high_n) },
        }
    }

    /// How far it leaves the other span.
    pub(super) fn beyond(self, reach: Self) -> f64 {
        (reach.low_n - self.low_n).max(self.high_n - reach.high_n).max(0.0)
    }

    /// What a layer asks for in a cell: exactly, or more than that.
    pub(super) fn in_cell(field: &Field, cell: Cell) -> Self {
        match field {
            Field::Grating(grating) => grating_span(grating, cell),
            Field::Samples(samples) => samples_span(field, samples, cell),
            Field::Noise(noise) => Self { low_n: noise.low_n, high_n: noise.high_n },
            Field::Edge(edge) => edge_span(edge, cell),
            Field::Button(button) => Self::of([button.rim_n, button.face_n].into_iter()).with_click(button.click),
            _ => {
                let (x_m, y_m) = cell.middle();
                Self::at_place(field, x_m, y_m)
            }
        }
    }

    /// What a layer asks for at a place, at any time and speed.
    pub(super) fn at_place(field: &Field, x_m: f64, y_m: f64) -> Self {
        match field {
            Field::Vibration(vibration) => Self::of([vibration.low_n, vibration.high_n].into_iter()),
            Field::Stream { low_n, high_n } => Self::of([*low_n, *high_n].into_iter()),
            Field::Curve(points) => Self::of(points.iter().map(|(_, friction_n)| *friction_n)),
            _ => {
                let friction_n = field.at(&Context { x_m, y_m, ..Context::default() });
                Self { low_n: friction_n, high_n: friction_n }.with_click(field.click().unwrap_or_default())
            }
        }
    }

    fn with_click(self, click: Click) -> Self {
        let height_n = f64::from(click.height_n);
        Self { low_n: self.low_n + height_n.min(0.0), high_n: self.high_n + height_n.max(0.0) }
    }

    /// 0 for a layer that asks for the same all over a cell, 1 when [`Span::in_cell`] is what it does ask for, 2 when
    /// it may be more than that.
    pub(super) fn doubts_in_cell(piece: &Piece, cell: Cell) -> usize {
        match &piece.field {
            Field::Constant(_) => 0,
            Field::Samples(samples) if is_turned(samples) => 2,
            Field::Button(_) => {
                let own = piece.shape.bounds_m();
                let [left_m, top_m, right_m, bottom_m] = own;
                let whole = Cell { left_m, top_m, right_m, bottom_m } == cell;
                if whole { 1 } else { 2 }
            }
            _ => 1,
        }
    }

    /// Length over which a layer varies little, m; nothing for one that is the same everywhere.
    pub(super) fn detail_m(field: &Field) -> Option<f64> {
        match field {
            Field::Constant(_) | Field::Vibration(_) | Field::Curve(_) | Field::Stream { .. } => None,
            Field::Grating(Grating { cycles_per_m_x, cycles_per_m_y, .. }) => {
                Some(0.1 / libm::hypot(*cycles_per_m_x, *cycles_per_m_y))
            }
            Field::Samples(samples) => Some(samples.pitch_m.min(samples.pitch_y_m)),
            Field::Noise(noise) => Some(0.1 * noise.wavelength_min_m),
            Field::Edge(edge) => Some(0.1 * edge.width_m),
            Field::Button(button) => Some(0.1 * button.rim_width_m),
        }
    }
}

fn grating_span(grating: &Grating, cell: Cell) -> Span {
    // Over a rectangle the phase takes every value between its least and its largest.
    let turns = Span::of(cell.corners().into_iter().map(|(x_m, y_m)| grating.turns(x_m, y_m)));
    let passes = |turn: f64| libm::floor(turns.high_n - turn) > libm::floor(turns.low_n - turn);
    let (trough_n, crest_n) = (grating.trough_n, grating.trough_n + grating.span_n);
    let ends = [turns.low_n, turns.high_n].into_iter().map(|turns| grating.at_turns(turns));
    let extremes = match grating.wave {
        Wave::Sine => [(passes(0.25), crest_n), (passes(0.75), trough_n)],
        Wave::Square { duty } => [(passes(0.0), crest_n), (passes(f64::from(duty)), trough_n)],
        Wave::Triangle => [(passes(0.5), crest_n), (passes(0.0), trough_n)],
        Wave::Saw => [(passes(0.0), crest_n), (passes(0.0), trough_n)],
    };
    let passed = extremes.into_iter().filter(|(passed, _)| *passed).map(|(_, friction_n)| friction_n);
    Span::of(ends.chain(passed))
}

/// A bilinear patch has its extremes at its corners: samples' centres, and where the cell cuts it. Of a picture that is
/// turned, all samples count that are in reach.
fn samples_span(field: &Field, samples: &Samples, cell: Cell) -> Span {
    let positions = cell.corners().map(|(x_m, y_m)| samples.position(x_m, y_m));
    let (u, v) = (Span::of(positions.iter().map(|(u, _)| *u)), Span::of(positions.iter().map(|(_, v)| *v)));
    if is_turned(samples) {
        return Span::of(samples.frictions(around(u, samples.width), around(v, samples.height)));
    }
    let stretch = |start_m: f64, end_m: f64, first_m: f64, pitch_m: f64, samples: std::ops::RangeInclusive<i64>| {
        let centres = samples.map(move |n| first_m + (n as f64 + 0.5) * pitch_m);
        let mut stretch = vec![start_m, end_m];
        stretch.extend(centres.filter(|centre_m| (start_m..=end_m).contains(centre_m)));
        stretch
    };
    let columns = stretch(cell.left_m, cell.right_m, samples.x_m, samples.pitch_m, around(u, samples.width));
    let rows = stretch(cell.top_m, cell.bottom_m, samples.y_m, samples.pitch_y_m, around(v, samples.height));
    let places = rows.iter().flat_map(|y_m| columns.iter().map(|x_m| (*x_m, *y_m)));
    Span::of(places.map(|(x_m, y_m)| field.at(&Context { x_m, y_m, ..Context::default() })))
}

/// The samples that positions in a span lie between. Twice as many as there are show all that tiling repeats.
fn around(positions: Span, samples: usize) -> std::ops::RangeInclusive<i64> {
    let first = libm::floor(positions.low_n).max(-1e6) as i64;
    let last = libm::ceil(positions.high_n).min(1e6) as i64;
    first..=last.min(first + 2 * samples as i64)
}

fn is_turned(samples: &Samples) -> bool {
    samples.angle_turns.abs() > 0.0
}

fn edge_span(edge: &Edge, cell: Cell) -> Span {
    let distances = Span::of(cell.corners().into_iter().map(|(x_m, y_m)| edge.distance_m(x_m, y_m)));
    // The ridge falls off on both sides.
    let nearest_m = 0.0_f64.clamp(distances.low_n, distances.high_n);
    let ends =
        [distances.low_n, distances.high_n, nearest_m].into_iter().map(|distance_m| edge.at_distance(distance_m));
    let still = Span::of(ends);
    if distances.low_n < 0.0 && distances.high_n > 0.0 { still.with_click(edge.click) } else { still }
}
