//! The amounts of layers that the drive can give, for the ends of a slider.

use std::ops::Range;

use super::cover::{PLACES_MAX, beyond, excesses};
use super::kinds;
use super::layer::{Above, Layer};
use super::program::Program;
use super::reference::{Reference, ReferenceLayer};
use super::tables::FRACTION;

/// How far beyond an end is tried whether it is one, as a part of what the drive adds.
const BEYOND: f64 = 1e-3;
/// Multiples of what the drive adds at which an end is sought. Nothing bounds an amount that is in reach at all of
/// them.
const FARTHEST: [f64; 4] = [1.0, 2.0, 4.0, 8.0];
/// Steps of the bisection.
const STEPS: u32 = 16;

/// What an amount in newtons or as a fraction may be without its layer exceeding the reach, while all else stays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AmountReach {
    /// Number of the layer's table in messages, from one.
    pub table: usize,
    /// The field as the file has it, in whose unit both ends are.
    pub field: &'static str,
    /// The least amount.
    pub least: f64,
    /// The largest amount.
    pub most: f64,
}

/// The amounts in reach of all fields that the file has. `layers` are those of the program's records.
pub(super) fn amounts_in_reach(program: &Program, layers: &[&Layer]) -> Vec<AmountReach> {
    let reference = Reference::new(program);
    let mut found = Vec::new();
    let mut first = 0;
    for copies in layers.chunk_by(|one, other| one.number().table == other.number().table) {
        let records = first..first + copies.len();
        first = records.end;
        let Some(layer) = copies.first() else { continue };
        for (amount, fields) in layer.kind.amounts().iter().enumerate() {
            let [newtons, fraction, _] = fields.names();
            let Some(field) = [newtons, fraction].into_iter().find(|field| layer.places.has(field)) else { continue };
            let pieces = reference.pieces().to_vec();
            let mut search = Search { program, pieces, records: records.clone(), amount };
            let [least, most] = search.ends(layer.gain).map(|electric_n| {
                if field == fraction {
                    (electric_n / program.reach.electric_friction_max_n).clamp(FRACTION.min, FRACTION.max)
                } else {
                    electric_n + zero_n(layer, field, program)
                }
            });
            found.push(AmountReach { table: layer.number().table, field, least, most });
        }
    }
    found
}

/// The value in newtons of a field whose electric friction is zero.
fn zero_n(layer: &Layer, field: &str, program: &Program) -> f64 {
    let record = program.records.iter().zip(&program.titles).find(|(_, title)| title.number() == layer.number());
    let clicked = record.and_then(|(record, _)| layer.kind.clicked(&layer.places, &record.layer));
    // A click counts from what it is added to.
    let is_click = clicked.is_some_and(|clicked| clicked.click == field);
    if layer.above == Above::Zero && !is_click { program.reach.natural_friction_n } else { 0.0 }
}

/// A search for the ends of one amount of a layer, and of its copies.
struct Search<'p> {
    program: &'p Program,
    pieces: Vec<ReferenceLayer>,
    records: Range<usize>,
    /// Its index in [`kinds::amounts`].
    amount: usize,
}

impl Search<'_> {
    /// The least and the largest electric friction of the amount, N.
    fn ends(&mut self, gain: f64) -> [f64; 2] {
        let reach_n = self.program.reach.electric_friction_max_n;
        // Without a gain, nothing is asked for.
        let drive_n = if gain == 0.0 { reach_n } else { reach_n / gain };
        let now_n = self.program.records.get(self.records.start).and_then(|record| {
            let mut layer = record.layer;
            kinds::amounts(&mut layer).get(self.amount).map(|amount| f64::from(**amount))
        });
        match now_n.into_iter().chain([0.0]).find(|start_n| self.is_in_reach(*start_n)) {
            Some(start_n) => [-1.0, 1.0].map(|side| self.end(start_n, side, drive_n)),
            None => [drive_n.min(0.0), drive_n.max(0.0)],
        }
    }

    /// The farthest amount in reach on a side of one that is.
    fn end(&mut self, start_n: f64, side: f64, drive_n: f64) -> f64 {
        let size_n = drive_n.abs();
        // Mostly it is bare glass or what the drive adds.
        for usual_n in [0.0, side * size_n] {
            let is_outwards = side * (usual_n - start_n) >= 0.0;
            if is_outwards && self.is_in_reach(usual_n) && !self.is_in_reach(usual_n + side * BEYOND * size_n) {
                return usual_n;
            }
        }
        let mut inside_n = start_n;
        for times in FARTHEST {
            let mut outside_n = start_n + side * times * size_n;
            if self.is_in_reach(outside_n) {
                inside_n = outside_n;
                continue;
            }
            for _ in 0..STEPS {
                let middle_n = f64::midpoint(inside_n, outside_n);
                if self.is_in_reach(middle_n) { inside_n = middle_n } else { outside_n = middle_n }
            }
            return inside_n;
        }
        // Nothing bounds it: the drive's amount, or the present one if that is larger.
        side * size_n.max(side * start_n)
    }

    /// Whether no place is out of reach where the layer applies, with this electric friction as its amount.
    fn is_in_reach(&mut self, electric_n: f64) -> bool {
        let Self { program, pieces, records, amount } = self;
        for number in records.clone() {
            let (Some(record), Some(piece)) = (program.records.get(number), pieces.get_mut(number)) else { continue };
            let mut record = *record;
            if let Some(amount) = kinds::amounts(&mut record.layer).into_iter().nth(*amount) {
                *amount = electric_n as f32;
            }
            *piece = ReferenceLayer::new(&record, program);
        }
        let within = program.within_reach();
        let found = excesses(&program.header, pieces, within, PLACES_MAX);
        let is_own = |layers: &[usize]| layers.iter().any(|number| records.contains(number));
        !found.iter().any(|excess| is_own(&excess.layers) && beyond(excess.found, within) > 0.0)
    }
}
