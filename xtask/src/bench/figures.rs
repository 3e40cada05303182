//! What was measured.

use std::collections::BTreeMap;
use std::fmt::Write;

/// Figures by name: instructions of `m4f.…` and `m3.…`, bytes of images. A name that ends in [`CYCLES`] is the estimate
/// in cycles that belongs to the name before it.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Figures(BTreeMap<String, u64>);

/// End of the name of an estimate in cycles.
pub(crate) const CYCLES: &str = "_cycles";

impl Figures {
    /// Adds a figure.
    pub(crate) fn put(&mut self, name: String, value: u64) {
        self.0.insert(name, value);
    }

    /// A figure.
    pub(crate) fn get(&self, name: &str) -> Option<u64> {
        self.0.get(name).copied()
    }

    /// A table for a person.
    pub(crate) fn table(&self) -> String {
        let mut table = format!("{:32} {:>12} {:>12}\n", "", "count", "cycles, est.");
        for (name, value) in self.0.iter().filter(|(name, _)| !name.ends_with(CYCLES)) {
            let cycles = self.get(&format!("{name}{CYCLES}")).map(|cycles| cycles.to_string()).unwrap_or_default();
            // A string takes what is written to it.
            let _ = writeln!(table, "{name:32} {value:>12} {cycles:>12}");
        }
        table
    }

    /// All of it for a program.
    pub(crate) fn json(&self) -> Result<String, String> {
        serde_json::to_string_pretty(&self.0).map(|json| json + "\n").map_err(|error| error.to_string())
    }
}

#[cfg(test)]
impl<const N: usize> From<[(&str, u64); N]> for Figures {
    fn from(figures: [(&str, u64); N]) -> Self {
        Self(figures.into_iter().map(|(name, value)| (name.to_owned(), value)).collect())
    }
}
