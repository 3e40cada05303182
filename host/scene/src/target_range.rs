//! The range of a program's target friction over its screen, and the part out of reach.

use std::collections::BTreeSet;

use frixel_layers::Interval;
use serde::Serialize;

use super::cover::{interval_at, widened};
use super::program::Program;
use crate::reference::Reference;

/// Number of places evaluated along the longer side of the screen.
const PLACES: f64 = 600.0;
/// Largest number of further places evaluated where several varying layers may exceed the range found so far.
const SEARCHED_MAX: usize = 100_000;

/// The range of a program's target friction over its screen, at all times and speeds, with clicks and streams at their
/// largest.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TargetRange {
    /// Smallest total friction, N.
    pub least_n: f64,
    /// Largest total friction, N.
    pub most_n: f64,
    /// The part of the screen where the target exceeds the reachable friction, and is clamped.
    pub above: OutOfReach,
    /// The part of the screen where the target is below natural friction, and is clamped.
    pub below: OutOfReach,
}

/// The part of a screen on one side of the reach.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct OutOfReach {
    /// Its area as a percentage of the screen.
    pub screen_percent: f64,
    /// The layers that apply there.
    pub layers: Vec<String>,
}

impl TargetRange {
    /// Evaluates a grid of places over the screen. The extremes include those between the places, as in a refusal: a
    /// noise counts in full, and several varying layers count as far as a search finds.
    pub fn of(program: &Program) -> Self {
        let reference = Reference::new(program);
        let pieces = reference.pieces();
        let (reach, within) = (&program.reach, program.within_reach());
        let places = Places::of(program);
        let mut sampled = Interval::of([]);
        let (mut above, mut below) = (Counted::default(), Counted::default());
        for (x_m, y_m) in places.iter() {
            let interval = interval_at(pieces.iter(), x_m, y_m);
            sampled = sampled.hull(interval);
            if interval.high > within.high {
                above.count(reference.visible_at(x_m, y_m));
            }
            if interval.low < within.low {
                below.count(reference.visible_at(x_m, y_m));
            }
        }
        let Interval { low, high } = widened(sampled, &program.header, pieces, SEARCHED_MAX);
        Self {
            least_n: reach.natural_friction_n + low,
            most_n: reach.natural_friction_n + high,
            above: above.share(program, places.count()),
            below: below.share(program, places.count()),
        }
    }
}

/// A grid of places: the centres of its fields.
struct Places {
    pitch_m: (f64, f64),
    count: (usize, usize),
}

impl Places {
    fn of(program: &Program) -> Self {
        let (width_m, height_m) = (program.header.screen_width_m, program.header.screen_height_m);
        let sides_m = (f64::from(width_m), f64::from(height_m));
        let pitch_m = sides_m.0.max(sides_m.1) / PLACES;
        let count = |side_m: f64| (side_m / pitch_m).round().max(1.0) as usize;
        let count = (count(sides_m.0), count(sides_m.1));
        Self { pitch_m: (sides_m.0 / count.0 as f64, sides_m.1 / count.1 as f64), count }
    }

    fn count(&self) -> usize {
        self.count.0 * self.count.1
    }

    fn iter(&self) -> impl Iterator<Item = (f64, f64)> {
        let place = |pitch_m: f64, number: usize| pitch_m * (number as f64 + 0.5);
        (0..self.count()).map(move |number| {
            (place(self.pitch_m.0, number % self.count.0), place(self.pitch_m.1, number / self.count.0))
        })
    }
}

/// Places on one side of the reach, and the layers that apply there.
#[derive(Default)]
struct Counted {
    places: usize,
    layers: BTreeSet<usize>,
}

impl Counted {
    fn count(&mut self, layers: impl Iterator<Item = usize>) {
        self.places += 1;
        self.layers.extend(layers);
    }

    fn share(self, program: &Program, places: usize) -> OutOfReach {
        let titles = self.layers.iter().filter_map(|layer| program.titles.get(*layer));
        OutOfReach {
            screen_percent: 100.0 * self.places as f64 / places.max(1) as f64,
            layers: titles.map(ToString::to_string).collect(),
        }
    }
}
