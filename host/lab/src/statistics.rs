//! The statistics that fits and scores need.

use core::f64::consts::SQRT_2;

use crate::bootstrap::Z_95;

/// Median; not-a-number without values.
pub(crate) fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    quantile(&values, 0.5)
}

/// Quantile of sorted values, interpolated between neighbours; not-a-number without values.
pub(crate) fn quantile(sorted: &[f64], part: f64) -> f64 {
    let place = part.clamp(0.0, 1.0) * sorted.len().saturating_sub(1) as f64;
    let below = place.floor();
    let at = |index: f64| sorted.get(index as usize).copied().unwrap_or(f64::NAN);
    let (low, high) = (at(below), at(place.ceil()));
    low + (place - below) * (high - low)
}

/// Mean; not-a-number without values.
pub(crate) fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
    sum / count
}

/// Mean and standard error of independent values.
pub(crate) fn mean_and_error(values: &[f64]) -> (f64, f64) {
    let (centre, count) = (mean(values.iter().copied()), values.len() as f64);
    let variance = values.iter().map(|value| (value - centre).powi(2)).sum::<f64>() / (count - 1.0);
    (centre, (variance / count).sqrt())
}

/// 95 % interval of a share of `count` out of `of` (Wilson 1927, doi:10.1080/01621459.1927.10502953).
pub(crate) fn share_interval(count: usize, of: usize) -> [f64; 2] {
    let (count, of, z) = (count as f64, of as f64, Z_95);
    let middle = (count + 0.5 * z * z) / (of + z * z);
    let half = z / (of + z * z) * (count * (of - count) / of + 0.25 * z * z).sqrt();
    [(middle - half).max(0.0), (middle + half).min(1.0)]
}

/// Probability that a Gaussian number of mean 0 and standard deviation 1 is below `z`.
pub(crate) fn normal_probability(z: f64) -> f64 {
    0.5 * libm::erfc(-z / SQRT_2)
}

/// The quantile of Student's distribution for a whole number of degrees of freedom, one or more, where the Gaussian one
/// is `z`, above zero.
pub(crate) fn student_quantile(z: f64, freedom: f64) -> f64 {
    let part = normal_probability(z);
    let (mut low, mut high) = (0.0, core::f64::consts::FRAC_PI_2);
    // Each step halves the interval: 52 are the bits of a number.
    for _ in 0..52 {
        let middle = 0.5 * (low + high);
        if student_probability(middle, freedom) < part { low = middle } else { high = middle }
    }
    freedom.sqrt() * libm::tan(0.5 * (low + high))
}

/// Probability that a number of Student's distribution is below `sqrt(freedom) tan(angle)`, for an angle from 0 to a
/// quarter turn and a whole number of degrees of freedom (Abramowitz and Stegun 26.7.3, 26.7.4).
fn student_probability(angle: f64, freedom: f64) -> f64 {
    let (sine, cosine) = (libm::sin(angle), libm::cos(angle));
    let freedom = freedom.round().max(1.0) as u32;
    let is_odd = !freedom.is_multiple_of(2);
    let (mut term, mut sum) = (if is_odd { cosine } else { 1.0 }, 0.0);
    for order in (if is_odd { 3 } else { 2 }..=freedom).step_by(2) {
        sum += term;
        term *= cosine * cosine * f64::from(order - 1) / f64::from(order);
    }
    let within = if is_odd { (angle + sine * sum) * core::f64::consts::FRAC_2_PI } else { sine * sum };
    0.5 + 0.5 * within
}

#[cfg(test)]
mod tests {
    use super::{median, normal_probability, quantile, share_interval, student_quantile};

    /// The examples of Newcombe 1998, `doi:10.1002/(SICI)1097-0258(19980430)17:8<857::AID-SIM777>3.0.CO;2-E`, table I.
    #[test]
    fn intervals_of_shares_are_those_of_the_tables() {
        for (count, of, low, high) in
            [(81, 263, 0.2553, 0.3662), (15, 148, 0.0624, 0.1605), (0, 20, 0.0, 0.1611), (1, 29, 0.0061, 0.1718)]
        {
            let found = share_interval(count, of);
            assert!((found[0] - low).abs() < 1e-4 && (found[1] - high).abs() < 1e-4, "{count} of {of}: {found:?}");
        }
    }

    #[test]
    fn quantiles_of_students_distribution_are_those_of_the_tables() {
        // Abramowitz and Stegun, table 26.10.
        for (freedom, of_95, of_999) in [
            (1.0, 12.706, 636.619),
            (2.0, 4.303, 31.598),
            (3.0, 3.182, 12.924),
            (4.0, 2.776, 8.610),
            (5.0, 2.571, 6.869),
            (10.0, 2.228, 4.587),
            (30.0, 2.042, 3.646),
            (120.0, 1.980, 3.373),
        ] {
            for (z, expected) in [(1.959_964, of_95), (3.290_527, of_999)] {
                let found = student_quantile(z, freedom);
                assert!((found / expected - 1.0).abs() < 3e-4, "{freedom}: {found} for {expected}");
            }
        }
        assert!((normal_probability(1.959_964) - 0.975).abs() < 1e-6);
    }

    #[test]
    fn quantiles_interpolate() {
        assert!((quantile(&[1.0, 2.0, 4.0], 0.75) - 3.0).abs() < 1e-12);
        assert!((median([4.0, 1.0, 3.0, 2.0].into_iter()) - 2.5).abs() < 1e-12);
        assert!(median(core::iter::empty()).is_nan());
    }
}
