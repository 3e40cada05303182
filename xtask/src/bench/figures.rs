//! The results of the measurements.

use std::collections::BTreeMap;
use std::fmt::Write;

use serde_json::Value;

/// Figures by name: instructions of `m4f.…` and `m3.…` at the worst input, and bytes of images. A name that ends in
/// [`CYCLES`] is the estimated number of cycles at the same input, and one that ends in [`MEAN`] is the mean over all
/// inputs.
pub(crate) type Figures = BTreeMap<String, u64>;

/// Suffix of the names of cycle estimates.
pub(crate) const CYCLES: &str = "_cycles";

/// Suffix of the names of means.
pub(crate) const MEAN: &str = "_mean";

/// The figures as a table of text.
pub(crate) fn table(figures: &Figures) -> String {
    let mut table = format!("{:28} {:>8} {:>8} {:>12}\n", "", "worst", "mean", "cycles, est.");
    for (name, value) in figures.iter().filter(|(name, _)| !name.ends_with(CYCLES) && !name.ends_with(MEAN)) {
        let beside = |end| figures.get(&format!("{name}{end}")).map(u64::to_string).unwrap_or_default();
        // Writing to a string cannot fail.
        let _ = writeln!(table, "{name:28} {value:>8} {:>8} {:>12}", beside(MEAN), beside(CYCLES));
    }
    table
}

/// The figures as JSON, with the date of their source.
pub(crate) fn json(figures: &Figures, date: &str) -> Result<String, String> {
    let mut object: BTreeMap<&str, Value> =
        figures.iter().map(|(name, value)| (name.as_str(), (*value).into())).collect();
    object.insert("date", date.into());
    serde_json::to_string_pretty(&object).map(|json| json + "\n").map_err(|error| error.to_string())
}
