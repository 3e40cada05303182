//! Instruction counts on emulated boards, as written by `cargo xtask bench`.

use std::collections::BTreeMap;
use std::path::Path;

use serde_json::{Error, Value, from_slice, from_value};

use super::error::ReportError;
use crate::input;

/// The counts of this version, which `FRIXEL_BLESS=1 cargo xtask bench` writes.
const COMMITTED: &str = include_str!("bench.json");

/// Counts by name: `CORE.WHAT` is the largest number of instructions, `CORE.WHAT_mean` their mean, and
/// `CORE.WHAT_cycles` an estimate in cycles.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Counts {
    /// Date of the source that was counted; empty if the file does not state it.
    date: String,
    counts: BTreeMap<String, f64>,
}

impl Counts {
    /// Reads a file of counts.
    pub(super) fn read(path: &Path) -> Result<Self, ReportError> {
        let text = input::read(path, input::TOML_MAX_BYTES)
            .map_err(|source| ReportError::ReadBench { path: path.to_owned(), source })?;
        Self::parse(&text).map_err(|source| ReportError::Bench { path: path.to_owned(), source })
    }

    /// The counts of this version.
    pub(super) fn committed() -> Result<Self, ReportError> {
        Self::parse(COMMITTED.as_bytes()).map_err(|source| ReportError::Bench { path: "bench.json".into(), source })
    }

    fn parse(text: &[u8]) -> Result<Self, Error> {
        let mut object: BTreeMap<String, Value> = from_slice(text)?;
        let date = object.remove("date").map(from_value).transpose()?.unwrap_or_default();
        let counts = object.into_iter().map(|(name, value)| Ok((name, from_value(value)?)));
        Ok(Self { date, counts: counts.collect::<Result<_, Error>>()? })
    }

    /// Origin of the counts, for the page: tool and date.
    pub(super) fn origin(&self) -> String {
        let date = if self.date.is_empty() { String::new() } else { format!(", source of {}", self.date) };
        format!("counted by cargo xtask bench in an emulator{date}")
    }

    /// The count of this name.
    pub(super) fn get(&self, name: &str) -> Option<f64> {
        self.counts.get(name).copied()
    }
}
