//! The range of a program's target friction over its screen, and how much of it is out of reach.

use frixel_layers::{Blend, Interval};
use serde::Serialize;

use super::cover::{ZERO, interval_at};
use super::program::Program;
use super::reach::ROUNDING;
use crate::reference::{Piece, Reference};

/// Places that are evaluated along the longer side of the screen.
const PLACES: f64 = 600.0;

/// The range of a program's target friction anywhere on its screen, at any time and speed, with clicks and streams at
/// their largest.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TargetRange {
    /// Least friction, in total, N.
    pub least_n: f64,
    /// Largest friction, in total, N.
    pub most_n: f64,
    /// Where the target exceeds the friction that the drive can give, and is clamped.
    pub above: OutOfReach,
    /// Where the target is less than the friction at no voltage, and is clamped.
    pub below: OutOfReach,
}

/// The part of a screen on one side of the reach.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct OutOfReach {
    /// Its area, in percent of the screen.
    pub screen_percent: f64,
    /// The layers that apply there.
    pub layers: Vec<String>,
}

impl TargetRange {
    /// Evaluates a grid of places all over the screen.
    pub fn of(program: &Program) -> Self {
        let reference = Reference::new(program);
        let pieces = reference.pieces();
        let reach = &program.reach;
        let slack_n = ROUNDING * reach.electric_friction_max_n;
        let places = Places::of(program);
        let mut range: Option<Interval<f64>> = None;
        let mut above = Counted::new(pieces.len());
        let mut below = Counted::new(pieces.len());
        for (x_m, y_m) in places.iter() {
            let interval = interval_at(pieces.iter(), x_m, y_m);
            range = Some(range.map_or(interval, |range| range.hull(interval)));
            above.count(interval.high > reach.electric_friction_max_n + slack_n, pieces, x_m, y_m);
            below.count(interval.low < -slack_n, pieces, x_m, y_m);
        }
        let Interval { low, high } = range.unwrap_or(ZERO);
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

/// Counts places on one side of the reach, and marks the layers that apply there.
struct Counted {
    places: usize,
    layers: Vec<bool>,
}

impl Counted {
    fn new(layers: usize) -> Self {
        Self { places: 0, layers: vec![false; layers] }
    }

    fn count(&mut self, is_outside: bool, pieces: &[Piece], x_m: f64, y_m: f64) {
        if !is_outside {
            return;
        }
        self.places += 1;
        for (piece, applies) in pieces.iter().zip(&mut self.layers).rev() {
            if piece.shape.covers(x_m, y_m) {
                *applies = true;
                if piece.blend == Blend::Replace {
                    break;
                }
            }
        }
    }

    fn share(self, program: &Program, places: usize) -> OutOfReach {
        let titles = program.titles.iter().zip(self.layers);
        OutOfReach {
            screen_percent: 100.0 * self.places as f64 / places.max(1) as f64,
            layers: titles.filter(|(_, applies)| *applies).map(|(title, _)| title.to_string()).collect(),
        }
    }
}
