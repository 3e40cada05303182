//! The statistics that a fit needs.

use core::f64::consts::SQRT_2;

/// Median; not-a-number of no values.
pub(crate) fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    quantile(&values, 0.5)
}

/// The quantile of sorted values, interpolated between neighbours; not-a-number of no values.
pub(crate) fn quantile(sorted: &[f64], part: f64) -> f64 {
    let place = part.clamp(0.0, 1.0) * sorted.len().saturating_sub(1) as f64;
    let below = place.floor();
    let at = |index: f64| sorted.get(index as usize).copied().unwrap_or(f64::NAN);
    let (low, high) = (at(below), at(place.ceil()));
    low + (place - below) * (high - low)
}

/// Mean; not-a-number of no values.
pub(crate) fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
    sum / count
}

/// Probability that a Gaussian number of mean 0 and standard deviation 1 is below `z`.
pub(crate) fn normal_probability(z: f64) -> f64 {
    0.5 * libm::erfc(-z / SQRT_2)
}

/// The quantile of Student's distribution for `freedom` degrees of freedom where the Gaussian one is `z`: the first
/// terms of its expansion (Abramowitz and Stegun 26.7.5), within 1 % for 5 degrees and more at the 97.5 % point.
pub(crate) fn student_quantile(z: f64, freedom: f64) -> f64 {
    let square = z * z;
    let first = z * (square + 1.0) / 4.0;
    let second = z * ((5.0 * square + 16.0) * square + 3.0) / 96.0;
    let third = z * (((3.0 * square + 19.0) * square + 17.0) * square - 15.0) / 384.0;
    z + (first + (second + third / freedom) / freedom) / freedom
}

#[cfg(test)]
mod tests {
    use super::{median, normal_probability, quantile, student_quantile};

    #[test]
    fn quantiles_of_students_distribution_are_those_of_the_tables() {
        for (freedom, expected) in [(5.0, 2.571), (10.0, 2.228), (30.0, 2.042)] {
            let found = student_quantile(1.959_964, freedom);
            assert!((found / expected - 1.0).abs() < 0.01, "{freedom}: {found}");
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
