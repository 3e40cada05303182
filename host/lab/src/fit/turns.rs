//! Divides a recorded stroke where the finger turns.

use super::table::Row;
use crate::statistics::median;

/// Friction of the other sign that counts as a turn, not as noise, as a fraction of the median size of friction.
const TURN_SHARE: f64 = 0.25;
/// A finger slower than this, in mm/s, turns or stands still.
pub(crate) const STILL_MM_S: f64 = 5.0;

/// A finger that turns does not turn back within this time, in seconds; noise does.
const TURN_BACK_S: f64 = 0.1;
/// The same in rows, where there are no times.
const TURN_BACK_ROWS: usize = 5;

/// The rows at which a signed quantity changes its sign and stays beyond the noise, which is smaller than `least`.
fn turns(rows: &[Row], least: f64, value: impl Fn(&Row) -> Option<f64>) -> Vec<usize> {
    let (mut turns, mut sign, mut first) = (Vec::new(), None, None);
    for (index, value) in rows.iter().enumerate().filter_map(|(index, row)| Some((index, value(row)?))) {
        if sign == Some(value > 0.0) {
            first = None;
            continue;
        }
        let turn = *first.get_or_insert(index);
        if value.abs() < least {
            continue;
        }
        first = None;
        if sign.replace(value > 0.0).is_none() {
            continue;
        }
        match turns.last() {
            Some(before) if is_noise(rows, *before, turn) => {
                turns.pop();
            }
            _ => turns.push(turn),
        }
    }
    turns
}

/// Whether two turns follow each other faster than those of a finger.
fn is_noise(rows: &[Row], before: usize, turn: usize) -> bool {
    let time_s = |index: usize| rows.get(index).and_then(|row| row.time_s);
    let between_s = time_s(turn).zip(time_s(before)).map(|(now_s, then_s)| now_s - then_s);
    between_s.map_or(turn - before < TURN_BACK_ROWS, |between_s| between_s < TURN_BACK_S)
}

/// Divides rows where friction or speed turns.
pub(super) fn pieces(rows: Vec<Row>) -> Vec<Vec<Row>> {
    let friction_n = median(rows.iter().map(|row| row.friction_n.abs()));
    let mut turns_of_both = turns(&rows, TURN_SHARE * friction_n, |row| Some(row.friction_n));
    turns_of_both.extend(turns(&rows, STILL_MM_S, |row| row.speed_mm_s));
    turns_of_both.sort_unstable();
    turns_of_both.dedup();
    let mut rest = rows;
    let mut pieces: Vec<Vec<Row>> = turns_of_both.iter().rev().map(|turn| rest.split_off(*turn)).collect();
    pieces.push(rest);
    pieces.reverse();
    pieces.retain(|piece| !piece.is_empty());
    pieces
}
