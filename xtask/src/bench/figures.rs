//! The results of the measurements.

use std::collections::BTreeMap;
use std::fmt::Write;

use serde_json::Value;

/// Figures by name: instructions of `m4f.…` and `m3.…` at the worst input, and bytes of images. A name that ends in
/// [`CYCLES`] is the estimated number of cycles at the same input, and one that ends in [`MEAN`] is the mean over all
/// inputs.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Figures(BTreeMap<String, u64>);

/// Suffix of the names of cycle estimates.
pub(crate) const CYCLES: &str = "_cycles";

/// Suffix of the names of means.
pub(crate) const MEAN: &str = "_mean";

impl Figures {
    /// Adds a figure, or replaces the one of this name.
    pub(crate) fn put(&mut self, name: String, value: u64) {
        self.0.insert(name, value);
    }

    /// The figure with this name.
    pub(crate) fn get(&self, name: &str) -> Option<u64> {
        self.0.get(name).copied()
    }

    /// The names of all figures.
    pub(crate) fn names(&self) -> impl Iterator<Item = &str> {
        self.0.keys().map(String::as_str)
    }

    /// The figures as a table of text.
    pub(crate) fn table(&self) -> String {
        let mut table = format!("{:28} {:>8} {:>8} {:>12}\n", "", "worst", "mean", "cycles, est.");
        for (name, value) in self.0.iter().filter(|(name, _)| !name.ends_with(CYCLES) && !name.ends_with(MEAN)) {
            let beside = |end| self.get(&format!("{name}{end}")).map(|value| value.to_string()).unwrap_or_default();
            // Writing to a string cannot fail.
            let _ = writeln!(table, "{name:28} {value:>8} {:>8} {:>12}", beside(MEAN), beside(CYCLES));
        }
        table
    }

    /// The figures as JSON, with the date of their source.
    pub(crate) fn json(&self, date: &str) -> Result<String, String> {
        let mut object: BTreeMap<&str, Value> =
            self.0.iter().map(|(name, value)| (name.as_str(), (*value).into())).collect();
        object.insert("date", date.into());
        serde_json::to_string_pretty(&object).map(|json| json + "\n").map_err(|error| error.to_string())
    }
}

#[cfg(test)]
impl<const N: usize> From<[(&str, u64); N]> for Figures {
    fn from(figures: [(&str, u64); N]) -> Self {
        Self(figures.into_iter().map(|(name, value)| (name.to_owned(), value)).collect())
    }
}
