//! Percentiles of signals.

/// The values below which these percentages of the values lie; `None` without values.
pub(crate) fn percentiles<const N: usize>(mut values: Vec<f64>, percents: [usize; N]) -> Option<[f64; N]> {
    values.sort_by(f64::total_cmp);
    let last = values.len().checked_sub(1)?;
    Some(percents.map(|percent| values.get(last * percent / 100).copied().unwrap_or(f64::NAN)))
}
