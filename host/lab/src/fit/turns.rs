//! Divides what was recorded as one stroke where the finger turns.

use super::table::Row;
use crate::statistics::median;

/// Friction of the other sign that is a turn and not noise, as a part of the median size of friction.
const TURN_SHARE: f64 = 0.25;
/// A finger slower than this, in mm/s, turns or stands still.
pub(super) const STILL_MM_S: f64 = 5.0;

/// A signed quantity that tells the direction of sliding.
struct Direction {
    /// A value of this size has a direction, a smaller one has that of the values before.
    least: f64,
    sign: Option<bool>,
    /// The first row of those that may belong to the next direction.
    first: Option<usize>,
}

impl Direction {
    fn new(least: f64) -> Self {
        Self { least, sign: None, first: None }
    }

    /// The row at which the direction changed, as row `index` with this value shows.
    fn turn(&mut self, index: usize, value: f64) -> Option<usize> {
        let sign = value > 0.0;
        if self.sign == Some(sign) {
            self.first = None;
            return None;
        }
        let first = *self.first.get_or_insert(index);
        if value.abs() < self.least {
            return None;
        }
        self.first = None;
        self.sign.replace(sign).map(|_| first)
    }
}

/// Divides rows where the sign of friction or speed changes, and stays changed beyond the noise.
pub(super) fn pieces(rows: Vec<Row>) -> Vec<Vec<Row>> {
    let mut friction = Direction::new(TURN_SHARE * median(rows.iter().map(|row| row.friction_n.abs())));
    let mut speed = Direction::new(STILL_MM_S);
    let mut turns: Vec<usize> = Vec::new();
    for (index, row) in rows.iter().enumerate() {
        turns.extend(friction.turn(index, row.friction_n));
        turns.extend(row.speed_mm_s.and_then(|speed_mm_s| speed.turn(index, speed_mm_s)));
    }
    turns.sort_unstable();
    turns.dedup();
    let mut rest = rows;
    let mut pieces: Vec<Vec<Row>> = turns.iter().rev().map(|turn| rest.split_off(*turn)).collect();
    pieces.push(rest);
    pieces.reverse();
    pieces.retain(|piece| !piece.is_empty());
    pieces
}
