//! Checks whether the drive can render changed layers during play.

use frixel_layers::{Interval, range};
use thiserror::Error;

use super::cover::{Excess, beyond, excesses};
use super::digits::{digits, down, up};
use super::program::Program;
use super::reference::{Reference, ReferenceLayer};
use super::titles::{LayerTitle, listed};

/// Largest number of places searched for an excess. Refusing a gain takes about forty searches, during which the host
/// does not serve the board.
const PLACES_MAX: usize = 4_000;
/// Steps of the search for a reachable gain.
const STEPS: u32 = 10;

/// Settings of a layer during play.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LayerSetting {
    /// Whether it is on.
    pub on: bool,
    /// Gain of the layer, in place of its record's.
    pub gain: f32,
}

/// Layers ask for friction out of reach, which is clamped.
#[derive(Clone, Debug, PartialEq, Error)]
#[error(
    "{} would ask for {} N above natural friction, and 0 to {reach_n} N can be reached", listed(&.layers.iter().collect::<Vec<_>>()),
    side(*.target_n, *.reach_n)
)]
pub struct Clamped {
    /// The layers, from bottom to top.
    pub layers: Vec<LayerTitle>,
    /// The friction they ask for, N above natural friction.
    pub target_n: f64,
    /// The largest reachable friction, rounded down, N above natural friction.
    pub reach_n: f64,
}

fn side(target_n: f64, reach_n: f64) -> String {
    format!("{} {target_n}", if target_n > reach_n { "up to" } else { "down to" })
}

impl Program {
    /// Returns the layers whose friction the board clamps with these settings, one per record; `None` if the search
    /// finds no excess. A stream counts with all its possible values.
    pub fn clamped_with(&self, settings: &[LayerSetting]) -> Option<Clamped> {
        let within = self.within_reach();
        let excess = self.worst_with(&pieces(&Reference::new(self), settings))?;
        let titles = excess.layers.iter().filter_map(|number| self.titles.get(*number));
        let Interval { low, high } = excess.found;
        let is_above = high - within.high > within.low - low;
        Some(Clamped {
            layers: titles.cloned().collect(),
            target_n: if is_above { digits(high, up) } else { digits(low, down) },
            reach_n: digits(self.reach.electric_friction_max_n, f64::floor),
        })
    }

    /// Returns the smallest and the largest common gain of some records for which the board clamps nothing, with all
    /// other settings unchanged; `None` if it clamps with every gain. The search starts from the first record's gain in
    /// `settings`.
    pub fn gains_in_reach(&self, records: &[u8], settings: &[LayerSetting]) -> Option<(f32, f32)> {
        let mut pieces = pieces(&Reference::new(self), settings);
        let mut is_in_reach = |gain: f64| {
            for record in records {
                if let Some(piece) = pieces.get_mut(usize::from(*record)) {
                    piece.gain = gain;
                }
            }
            self.worst_with(&pieces).is_none()
        };
        let start = f64::from(settings.get(usize::from(*records.first()?))?.gain);
        let start = [start, 1.0, 0.0].into_iter().find(|gain| is_in_reach(*gain))?;
        let [least, most] = [range::GAIN.min, range::GAIN.max].map(|limit| {
            if is_in_reach(limit) {
                return limit;
            }
            let (mut inside, mut outside) = (start, limit);
            // First near the start, then by bisection.
            for step in [0.1, 0.3, 1.0, 3.0, 10.0, 30.0] {
                let gain = start + step * (limit - start).signum();
                if !(start.min(limit)..=start.max(limit)).contains(&gain) {
                    break;
                }
                if is_in_reach(gain) {
                    inside = gain;
                } else {
                    outside = gain;
                    break;
                }
            }
            for _ in 0..STEPS {
                let middle = f64::midpoint(inside, outside);
                if is_in_reach(middle) { inside = middle } else { outside = middle }
            }
            // Round to hundredths, towards the inside where necessary. Adding zero avoids a negative zero.
            let rounded = (100.0 * inside).round() / 100.0;
            let towards_start = if limit > start { (100.0 * inside).floor() } else { (100.0 * inside).ceil() };
            0.0 + if is_in_reach(rounded) { rounded } else { towards_start / 100.0 }
        });
        Some((least as f32, most as f32))
    }

    fn worst_with(&self, pieces: &[ReferenceLayer]) -> Option<Excess> {
        let within = self.within_reach();
        let extent = |excess: &Excess| beyond(excess.found, within);
        let found = excesses(&self.header, pieces, within, PLACES_MAX).into_iter();
        found.filter(|excess| extent(excess) > 0.0).max_by(|one, other| extent(one).total_cmp(&extent(other)))
    }
}

/// The layers with their settings.
fn pieces(reference: &Reference, settings: &[LayerSetting]) -> Vec<ReferenceLayer> {
    let mut pieces = reference.pieces().to_vec();
    for (piece, setting) in pieces.iter_mut().zip(settings) {
        (piece.is_on, piece.gain) = (setting.on, f64::from(setting.gain));
    }
    pieces
}
