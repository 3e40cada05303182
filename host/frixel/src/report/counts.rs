//! Instruction counts on emulated boards, as written by `cargo xtask bench`.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use super::error::ReportError;

/// Counts by name: `CORE.WHAT` is the largest number of instructions, `CORE.WHAT_mean` their mean, and
/// `CORE.WHAT_cycles` an estimate in cycles.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Counts(BTreeMap<String, f64>);

impl Counts {
    pub(super) fn read(path: &Path) -> Result<Self, ReportError> {
        let text =
            fs::read_to_string(path).map_err(|source| ReportError::ReadBench { path: path.to_owned(), source })?;
        let counts =
            serde_json::from_str(&text).map_err(|source| ReportError::Bench { path: path.to_owned(), source })?;
        Ok(Self(counts))
    }

    /// Largest number of instructions of one call on a core.
    pub(super) fn instructions(&self, core: &str, what: &str) -> Option<f64> {
        self.0.get(&format!("{core}.{what}")).copied()
    }

    /// Mean number of instructions over all calls.
    pub(super) fn mean(&self, core: &str, what: &str) -> Option<f64> {
        self.0.get(&format!("{core}.{what}_mean")).copied()
    }

    /// Estimated cycles of the call with the most instructions.
    pub(super) fn cycles(&self, core: &str, what: &str) -> Option<f64> {
        self.0.get(&format!("{core}.{what}_cycles")).copied()
    }
}
