//! Intervals by bootstrap: independent values are drawn again and again, with replacement, and each draw is evaluated.
//!
//! Of a recording, strokes are drawn: the noise of natural friction is correlated within a stroke, so rows are not
//! independent, and intervals that take them to be are too narrow. Of a score, people are, or strokes of one finger.

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

impl Estimate {
    /// Whether both ends lie within this share of the value.
    pub(crate) fn is_within(&self, share: f64) -> bool {
        let room = share * self.value.abs();
        self.high - self.value <= room && self.value - self.low <= room
    }
}

/// Values in groups, from each of which as many are drawn as it has.
pub(crate) struct Draws {
    groups: Vec<Vec<usize>>,
    random: Pcg64,
    expansion: Expansion,
}

/// By what intervals are wider than the spread of the draws.
enum Expansion {
    /// The draws are of values: few of them vary less than they should.
    Values,
    /// The draws are of errors, and vary as much as they should.
    Errors,
}

impl Draws {
    /// Groups values by a key, so that each draw has as many of each as there are, as of strokes with the same highest
    /// voltage. With fewer than three values of a key, all values are one group.
    pub(crate) fn new<K: Ord>(keys: &[K], seed: u64) -> Self {
        let mut distinct: Vec<&K> = keys.iter().collect();
        distinct.sort_unstable();
        distinct.dedup();
        let members = |key| {
            let numbered = keys.iter().enumerate().filter(move |(_, other)| *other == key);
            numbered.map(|(index, _)| index).collect::<Vec<_>>()
        };
        let mut groups: Vec<_> = distinct.into_iter().map(members).collect();
        if groups.iter().any(|group| group.len() < 3) {
            groups = vec![(0..keys.len()).collect()];
        }
        Self { groups, random: Pcg64::seed_from_u64(seed), expansion: Expansion::Values }
    }

    /// For values that were drawn from the distributions of their errors.
    pub(crate) fn of_errors() -> Self {
        Self { groups: Vec::new(), random: Pcg64::seed_from_u64(0), expansion: Expansion::Errors }
    }

    /// Draws the indices of values, with replacement.
    pub(crate) fn draw(&mut self) -> Vec<usize> {
        let Self { groups, random, .. } = self;
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

    /// How many standard deviations of the draws make an interval as wide as that of the Gaussian quantile `z` for many
    /// values: Student's quantile, and the variance that draws from few values lack.
    ///
    /// The degrees of freedom are those of one group: nearly all that is known of electric friction comes from the
    /// strokes of the highest voltage.
    pub(crate) fn expanded(&self, z: f64) -> f64 {
        match self.expansion {
            Expansion::Values => {}
            Expansion::Errors => return z,
        }
        let per_group = self.groups.iter().map(Vec::len).sum::<usize>() as f64 / self.groups.len() as f64;
        (per_group / (per_group - 1.0)).sqrt() * student_quantile(z, per_group - 1.0)
    }
}
