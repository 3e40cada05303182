//! Percentiles of signals.

/// The values below which these percentages of the values lie, such as `[50]` for the median; `None` without values. Of
/// an even number of values, the median is the lower one in the middle.
pub fn percentiles<const N: usize>(mut values: Vec<f64>, percents: [usize; N]) -> Option<[f64; N]> {
    values.sort_by(f64::total_cmp);
    let last = values.len().checked_sub(1)?;
    Some(percents.map(|percent| values.get(last * percent / 100).copied().unwrap_or(f64::NAN)))
}
