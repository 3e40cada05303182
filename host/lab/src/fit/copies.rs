//! Rows that stand in a recording twice, as of a file that was appended to itself: they would narrow the intervals.

use std::collections::HashMap;
use std::hash::{DefaultHasher, Hash, Hasher};

use super::error::FitError;
use super::table::Row;

/// Number of consecutive rows that are compared. The noise of a sensor does not repeat them by chance.
pub(super) const ROWS: usize = 8;

/// Fails if consecutive rows of different measurements return later, whatever their time and stroke.
pub(super) fn check(rows: &[Row]) -> Result<(), FitError> {
    let mut seen = HashMap::<u64, usize>::new();
    for (first, window) in rows.windows(ROWS).enumerate() {
        let hash = hash(window);
        if let Some(before) = seen.get(&hash).and_then(|index| rows.get(*index..index + ROWS))
            && window.iter().zip(before).all(|(one, other)| measured(one) == measured(other))
            && are_different(window)
            && let ([row, ..], [of, ..]) = (window, before)
        {
            return Err(FitError::RowsTwice { row: row.number, of: of.number });
        }
        // Windows side by side are enough: a copy of them is found wherever it begins.
        if first.is_multiple_of(ROWS) {
            seen.entry(hash).or_insert(first);
        }
    }
    Ok(())
}

fn measured(row: &Row) -> [u64; 3] {
    [row.voltage_v_rms, row.normal_force_n, row.friction_n].map(f64::to_bits)
}

fn hash(rows: &[Row]) -> u64 {
    let mut hasher = DefaultHasher::new();
    for row in rows {
        measured(row).hash(&mut hasher);
    }
    hasher.finish()
}

/// Whether no two of the rows are alike. A sensor that rests, or has no noise, repeats itself.
fn are_different(rows: &[Row]) -> bool {
    rows.iter().enumerate().all(|(index, row)| rows.iter().take(index).all(|other| measured(row) != measured(other)))
}
