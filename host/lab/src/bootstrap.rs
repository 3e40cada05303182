//! Bootstrap intervals: independent values are drawn repeatedly with replacement, and each draw is evaluated.
//!
//! For a recording, whole strokes are drawn. The noise of natural friction is correlated within a stroke, so rows are
//! not independent, and intervals that assume they are would be too narrow. For a score, people are drawn, or strokes
//! of one finger.

use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng, SeedableRng};

use crate::statistics::{normal_probability, quantile, student_quantile};

/// Gaussian quantile of a two-sided interval of 95 %.
pub(crate) const Z_95: f64 = 1.959_964;
/// Gaussian quantile of a two-sided interval of 99.9 %.
pub(crate) const Z_999: f64 = 3.290_527;

/// An estimate with its 95 % interval.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Estimate {
    /// Best value.
    pub value: f64,
    /// Lower end of the interval.
    pub low: f64,
    /// Upper end of the interval.
    pub high: f64,
}

/// Largest number of standard deviations that a few hundred draws resolve: of 499, three lie beyond on either side.
const Z_SHOWN: f64 = 2.5;
/// Standard deviations from which an interval is extrapolated, because draws of few values end soon beyond.
const Z_STRETCHED: f64 = 2.0;

/// Minimum number of values in a group; draws from fewer are not informative.
pub(crate) const GROUP_MIN: usize = 3;

/// Values in groups. A draw takes as many values from each group as it has.
pub(crate) struct Draws {
    /// Empty if the draws are of errors, which vary as much as they should. Draws of few values vary less.
    groups: Vec<Vec<usize>>,
    random: Pcg64,
}

impl Draws {
    /// Groups values by a key, such as the highest voltage of a stroke.
    ///
    /// Each draw has as many values of each key as there are. Keys with fewer than three values join the group below
    /// theirs, or else the one above. If most keys have so few, as when each stroke has a voltage of its own, all
    /// values form one group.
    pub(crate) fn new<K: Ord>(keys: &[K], seed: u64) -> Self {
        let mut distinct: Vec<&K> = keys.iter().collect();
        distinct.sort_unstable();
        distinct.dedup();
        let members = |key| {
            let numbered = keys.iter().enumerate().filter(move |(_, other)| *other == key);
            numbered.map(|(index, _)| index).collect::<Vec<_>>()
        };
        let mut groups: Vec<_> = distinct.into_iter().map(members).collect();
        let many: usize = groups.iter().map(Vec::len).filter(|len| *len >= GROUP_MIN).sum();
        if 2 * many < keys.len() {
            groups = vec![(0..keys.len()).collect()];
        }
        while let Some(few) = groups.iter().position(|group| group.len() < GROUP_MIN).filter(|_| groups.len() > 1) {
            let joined = groups.remove(few);
            if let Some(group) = groups.get_mut(few.saturating_sub(1)) {
                group.extend(joined);
            }
        }
        Self { groups, random: Pcg64::seed_from_u64(seed) }
    }

    /// Creates draws of values from the distributions of their errors.
    pub(crate) fn of_errors() -> Self {
        Self { groups: Vec::new(), random: Pcg64::seed_from_u64(0) }
    }

    /// Draws the indices of values, with replacement.
    pub(crate) fn draw(&mut self) -> Vec<usize> {
        let Self { groups, random } = self;
        let mut drawn = Vec::new();
        for group in groups {
            // The product with a random number of 32 bits keeps its upper half, evenly spread to 1 in 2^32.
            let place = |random: &mut Pcg64| (((random.next_u64() >> 32) * group.len() as u64) >> 32) as usize;
            drawn.extend((0..group.len()).filter_map(|_| group.get(place(random)).copied()));
        }
        drawn
    }

    /// The two-sided interval of the values that the draws gave, for the Gaussian quantile `z`: the expanded percentile
    /// interval (Hesterberg 2015, doi:10.1080/00031305.2015.1089789), which corrects for the small number of values.
    pub(crate) fn interval(&self, values: &mut [f64], z: f64) -> (f64, f64) {
        values.sort_by(f64::total_cmp);
        let part = normal_probability(-self.expanded(z));
        (quantile(values, part), quantile(values, 1.0 - part))
    }

    /// Like [`Self::interval`], but extrapolated if one group has fewer than half as many values as another.
    ///
    /// An estimate that depends on the small group alone can lie beyond its values. The interval is therefore stretched
    /// about the median. It may leave the bounds of a bounded quantity.
    pub(crate) fn stretched_interval(&self, values: &mut [f64], z: f64) -> (f64, f64) {
        let expanded = self.expanded(z);
        if expanded <= Z_SHOWN || !self.is_uneven() {
            return self.interval(values, z);
        }
        values.sort_by(f64::total_cmp);
        let (part, median) = (normal_probability(-Z_STRETCHED), quantile(values, 0.5));
        let end = |part| median + expanded / Z_STRETCHED * (quantile(values, part) - median);
        (end(part), end(1.0 - part))
    }

    fn is_uneven(&self) -> bool {
        let sizes = || self.groups.iter().map(Vec::len);
        sizes().min().zip(sizes().max()).is_some_and(|(smallest, largest)| 2 * smallest < largest)
    }

    /// Number of standard deviations of the draws that correspond to the Gaussian quantile `z` for many values.
    ///
    /// Accounts for Student's quantile, and for the variance that draws from few values lack. The degrees of freedom
    /// are those of the smallest group: electric friction depends on the strokes of the highest voltage, and an
    /// exponent on those of the voltage with the fewest.
    pub(crate) fn expanded(&self, z: f64) -> f64 {
        let Some(smallest) = self.groups.iter().map(Vec::len).min() else { return z };
        let smallest = smallest as f64;
        (smallest / (smallest - 1.0)).sqrt() * student_quantile(z, smallest - 1.0)
    }
}

#[cfg(test)]
mod tests {
    use rand_pcg::Pcg64;
    use rand_pcg::rand_core::{Rng, SeedableRng};

    use super::{Draws, Z_95};
    use crate::statistics::mean;

    /// How many of 2,000 intervals contain the mean of Gaussian numbers that rests on four of them.
    fn covered(interval: impl Fn(&Draws, &mut [f64]) -> (f64, f64)) -> usize {
        let mut random = Pcg64::seed_from_u64(1);
        let mut uniform = || ((random.next_u64() >> 11) + 1) as f64 / (1_u64 << 53) as f64;
        let mut gaussian = || (-2.0 * uniform().ln()).sqrt() * (core::f64::consts::TAU * uniform()).cos();
        let keys = [1, 1, 1, 1, 2, 2, 2, 2, 2, 2, 2, 2, 2];
        let mut contains = |seed: u64| {
            let values: [f64; 4] = core::array::from_fn(|_| gaussian());
            let mut draws = Draws::new(&keys, seed);
            let mean_of = |drawn: Vec<usize>| mean(drawn.into_iter().filter_map(|index| values.get(index).copied()));
            let mut means: Vec<f64> = (0..499).map(|_| mean_of(draws.draw())).collect();
            let (low, high) = interval(&draws, &mut means);
            (low..=high).contains(&0.0)
        };
        (0..2_000).filter(|seed| contains(*seed)).count()
    }

    /// No draw lies beyond the four values, between which the mean is in 7 of 8 cases.
    #[test]
    fn intervals_that_rest_on_few_of_many_values_are_stretched_beyond_them() {
        let drawn = covered(|draws, values| draws.interval(values, Z_95));
        assert!((1_680..1_790).contains(&drawn), "{drawn}");
        let stretched = covered(|draws, values| draws.stretched_interval(values, Z_95));
        assert!((1_840..1_920).contains(&stretched), "{stretched}");
    }

    #[test]
    fn intervals_of_even_groups_are_those_of_the_draws() {
        let draws = Draws::new(&[1, 1, 1, 2, 2, 2, 2, 2], 1);
        let mut values: Vec<f64> = (0..499).map(f64::from).collect();
        assert_eq!(draws.stretched_interval(&mut values.clone(), Z_95), draws.interval(&mut values, Z_95));
    }

    #[test]
    fn few_values_of_a_key_join_the_group_beside_theirs() {
        let sizes = |keys: &[u8]| Draws::new(keys, 1).groups.iter().map(Vec::len).collect::<Vec<_>>();
        assert_eq!(sizes(&[1, 1, 1, 2, 2, 2, 2]), [3, 4]);
        assert_eq!(sizes(&[1, 1, 1, 2, 3, 3, 3]), [4, 3]);
        assert_eq!(sizes(&[1, 2, 2, 2, 2]), [5]);
        assert_eq!(sizes(&[1, 2]), [2]);
        assert_eq!(sizes(&[1, 2, 3, 4, 5, 6, 7, 8, 9]), [9], "a ramp has no groups");
    }
}
