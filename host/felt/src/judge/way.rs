//! Paths of a finger across an element.

use std::f64::consts::TAU;

use frixel_hil_sim::{Point, Stroke};
use frixel_layers::Interval;
use frixel_scene::reference::{Context, Reference, direction_of};

use super::visible_layers;

/// Rows and columns over the bounding rectangle of a layer, the middle one first.
const ROWS: [f64; 5] = [0.5, 0.3, 0.7, 0.1, 0.9];
/// Number of places on a way at which the layers are determined.
const PLACES: usize = 400;
/// Length of a stroke beyond both ends of an element, m.
const BEYOND_M: f64 = 0.01;
/// Longest way of a stroke, m: for a longer element, the part with the largest changes of friction.
const LENGTH_MAX_M: f64 = 0.12;
/// Spacing of the places at which friction is compared, m.
const STEP_M: f64 = 2.5e-4;
/// Fraction of a way omitted at both ends, where a border of the screen may be that of a region.
const END_PART: f64 = 1e-4;
/// Factor by which friction must change more on a way to prefer it to an earlier one.
const BETTER: f64 = 1.05;
/// Offsets of a finger from the way that it is meant to follow, m. Assumed: a little more than the steps of a touch
/// source.
const BESIDE_M: [f64; 3] = [-2.5e-4, 0.0, 2.5e-4];
/// The part of its change that a steady way keeps if friction is averaged over [`BESIDE_M`], and of the largest change
/// of any way that it has to have. Assumed.
const STEADY_PART: f64 = 0.5;

/// A straight way, m.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Way {
    from_m: (f64, f64),
    to_m: (f64, f64),
}

impl Way {
    /// The way across a layer with the largest changes of friction, and 10 mm beyond both ends, within the screen;
    /// `None` for a layer that is visible nowhere. Changes of `below` do not count. A layer that depends on the
    /// direction is crossed along its axis.
    pub(super) fn across(
        layer: usize,
        axis_turns: Option<f64>,
        [reference, below]: [&Reference; 2],
        screen_m: (f64, f64),
    ) -> Option<Self> {
        let [left_m, top_m, right_m, bottom_m] = reference.bounds_m(layer)?;
        let bounds_m = [left_m.max(0.0), top_m.max(0.0), right_m.min(screen_m.0), bottom_m.min(screen_m.1)];
        let ways = match axis_turns {
            Some(axis_turns) => vec![Self::along(axis_turns, bounds_m)],
            None => Self::rows_and_columns(bounds_m),
        };
        let visible: Vec<Self> = ways.into_iter().filter_map(|way| way.longest_visible(layer, reference)).collect();
        let liveliest = |way: Self| way.liveliest_part([reference, below]);
        let parts: Vec<(Self, f64)> = visible.iter().map(|way| liveliest(way.extended(screen_m))).collect();
        let own: Vec<(Self, f64)> = visible.iter().map(|way| liveliest(*way)).collect();
        let mut number = Self::liveliest_of(&parts, [reference, below])?;
        let largest_own_n = own.iter().map(|(_, change_n)| *change_n).fold(0.0, f64::max);
        if own.get(number).is_some_and(|(_, change_n)| *change_n < STEADY_PART * largest_own_n) {
            // The best way runs along this layer's stripes into a neighbour.
            number = Self::liveliest_of(&own, [reference, below])?;
        }
        parts.get(number).map(|(way, _)| *way)
    }

    /// The number of the way with the largest changes of friction, N. One along a border, where friction changes a
    /// little beside it, is taken only if no other has half of its changes.
    fn liveliest_of(parts: &[(Self, f64)], references: [&Reference; 2]) -> Option<usize> {
        let largest_n = parts.iter().map(|(_, change_n)| *change_n).fold(0.0, f64::max);
        let is_steady = |(way, change_n): &(Self, f64)| {
            *change_n >= STEADY_PART * largest_n && way.steady_change_n(references) >= STEADY_PART * change_n
        };
        let best = |is_taken: &dyn Fn(&(Self, f64)) -> bool| {
            let taken = parts.iter().enumerate().filter(|(_, part)| is_taken(part));
            taken
                .reduce(|best, other| if other.1.1 > BETTER * best.1.1 { other } else { best })
                .map(|(number, _)| number)
        };
        best(&is_steady).or_else(|| best(&|_| true))
    }

    /// A stroke along the way at constant speed, and back if `there_and_back`.
    pub(super) fn stroke(&self, speed_m_per_s: f64, there_and_back: bool) -> Option<Stroke> {
        let point = |(x_m, y_m): (f64, f64)| Point { x_m, y_m };
        let (from, to) = (point(self.from_m), point(self.to_m));
        let duration_s = self.length_m() / speed_m_per_s;
        if there_and_back {
            Stroke::through(&[(0.0, Some(from)), (duration_s, Some(to)), (2.0 * duration_s, Some(from))]).ok()
        } else {
            Stroke::constant_speed(from, to, speed_m_per_s).ok()
        }
    }

    fn rows_and_columns([left_m, top_m, right_m, bottom_m]: [f64; 4]) -> Vec<Self> {
        let row = |part: f64| {
            let y_m = top_m + part * (bottom_m - top_m);
            Self { from_m: (left_m, y_m), to_m: (right_m, y_m) }
        };
        let column = |part: f64| {
            let x_m = left_m + part * (right_m - left_m);
            Self { from_m: (x_m, top_m), to_m: (x_m, bottom_m) }
        };
        ROWS.into_iter().flat_map(|part| [row(part), column(part)]).collect()
    }

    /// The way along an axis through the middle of a rectangle.
    fn along(axis_turns: f64, [left_m, top_m, right_m, bottom_m]: [f64; 4]) -> Self {
        let (middle_x_m, middle_y_m) = (0.5 * (left_m + right_m), 0.5 * (top_m + bottom_m));
        let (axis_y, axis_x) = libm::sincos(TAU * axis_turns);
        // An axis parallel to one side never meets the ends of the other: infinite.
        let half_m = (0.5 * (right_m - left_m) / axis_x.abs()).min(0.5 * (bottom_m - top_m) / axis_y.abs());
        let at = |part: f64| (middle_x_m + part * half_m * axis_x, middle_y_m + part * half_m * axis_y);
        Self { from_m: at(-1.0), to_m: at(1.0) }
    }

    fn length_m(&self) -> f64 {
        libm::hypot(self.to_m.0 - self.from_m.0, self.to_m.1 - self.from_m.1)
    }

    fn direction(&self) -> [f64; 2] {
        direction_of([self.to_m.0 - self.from_m.0, self.to_m.1 - self.from_m.1])
    }

    /// The place at a fraction of the way, from 0 to 1.
    fn at(&self, part: f64) -> (f64, f64) {
        let ((from_x_m, from_y_m), (to_x_m, to_y_m)) = (self.from_m, self.to_m);
        (from_x_m + part * (to_x_m - from_x_m), from_y_m + part * (to_y_m - from_y_m))
    }

    fn part(&self, from: f64, to: f64) -> Self {
        Self { from_m: self.at(from), to_m: self.at(to) }
    }

    /// The longest part on which the layer is visible, if it is visible anywhere.
    fn longest_visible(self, layer: usize, reference: &Reference) -> Option<Self> {
        let part = |number: usize| number as f64 / PLACES as f64;
        let (mut longest, mut run) = (0..0, 0..0);
        for number in 0..PLACES {
            let (x_m, y_m) = self.at(part(number) + 0.5 / PLACES as f64);
            if visible_layers(reference, x_m, y_m) >> layer & 1 == 1 {
                run.end = number + 1;
                if run.len() > longest.len() {
                    longest = run.clone();
                }
            } else {
                run = number + 1..number + 1;
            }
        }
        (!longest.is_empty() && self.length_m() > 0.0).then(|| self.part(part(longest.start), part(longest.end)))
    }

    /// The way extended beyond both ends, within the screen.
    fn extended(self, (width_m, height_m): (f64, f64)) -> Self {
        let [x, y] = self.direction();
        let beyond = |(x_m, y_m): (f64, f64), [x, y]: [f64; 2]| {
            let room_m = |place_m: f64, direction: f64, side_m: f64| match direction {
                direction if direction > 0.0 => (side_m - place_m) / direction,
                direction if direction < 0.0 => -place_m / direction,
                _ => f64::INFINITY,
            };
            let way_m = BEYOND_M.min(room_m(x_m, x, width_m)).min(room_m(y_m, y, height_m)).max(0.0);
            (x_m + way_m * x, y_m + way_m * y)
        };
        Self { from_m: beyond(self.from_m, [-x, -y]), to_m: beyond(self.to_m, [x, y]) }
    }

    /// The first part of at most [`LENGTH_MAX_M`] with the largest changes of friction in either direction, and its
    /// change, N.
    fn liveliest_part(self, references: [&Reference; 2]) -> (Self, f64) {
        let frictions_n = self.frictions_n(references, &[0.0]);
        let count = self.steps();
        let window = ((LENGTH_MAX_M / STEP_M) as usize).min(count) + 1;
        let step = (window / 8).max(1);
        let last = count + 1 - window;
        let starts = (0..last).step_by(step).chain([last]);
        let change_n = |from: usize| {
            let parts_n = frictions_n.iter().filter_map(|friction_n| friction_n.get(from..from + window));
            parts_n.map(spread_n).fold(0.0, f64::max)
        };
        let changes = starts.map(|start| (start, change_n(start)));
        let best = changes.reduce(|best, other| if other.1 > BETTER * best.1 { other } else { best });
        let (start, change_n) = best.unwrap_or((0, 0.0));
        let part = |number: usize| number as f64 / count as f64;
        (self.part(part(start), part(start + window - 1)), change_n)
    }

    /// The change of friction on the way, there or back, that remains if the finger is now and then beside it, N.
    fn steady_change_n(&self, references: [&Reference; 2]) -> f64 {
        self.frictions_n(references, &BESIDE_M).iter().map(|friction_n| spread_n(friction_n)).fold(0.0, f64::max)
    }

    /// Steps of about [`STEP_M`] that the way has.
    fn steps(&self) -> usize {
        (self.length_m() / STEP_M) as usize + 1
    }

    /// Friction after each step of the way, there and back, N. It is the mean over places at the distances `beside_m`
    /// from the way.
    fn frictions_n(&self, [reference, below]: [&Reference; 2], beside_m: &[f64]) -> [Vec<f64>; 2] {
        let count = self.steps();
        let [x, y] = self.direction();
        let friction_n = |direction: [f64; 2], number: usize, beside_m: f64| {
            let (x_m, y_m) = self.at((number as f64 / count as f64).clamp(END_PART, 1.0 - END_PART));
            let (x_m, y_m) = (x_m - beside_m * y, y_m + beside_m * x);
            let context = Context { x_m, y_m, speed_m_per_s: 0.05, direction, ..Context::default() };
            reference.electric_friction_at_n(&context) - below.electric_friction_at_n(&context)
        };
        [[x, y], [-x, -y]].map(|direction| {
            let mean_n = |number: usize| {
                let sum_n: f64 = beside_m.iter().map(|beside_m| friction_n(direction, number, *beside_m)).sum();
                sum_n / beside_m.len() as f64
            };
            (0..=count).map(mean_n).collect()
        })
    }
}

/// From the least to the largest friction, N.
fn spread_n(friction_n: &[f64]) -> f64 {
    let Interval { low, high } = Interval::of(friction_n.iter().copied());
    high - low
}
