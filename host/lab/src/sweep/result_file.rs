//! The result of a cell as text: a line of JSON that begins with the hash of the rest.

use thiserror::Error;

use super::{CellResult, json};
use crate::hash::sha256;

/// Text before and after the digits of the hash.
const HEAD: &str = "{\"sha256\":\"";
const BEHIND: &str = "\",";
const DIGITS: usize = 64;

/// Why a text is not the result of a cell.
#[derive(Debug, Error)]
pub enum CellResultError {
    /// The text is not JSON of a result.
    #[error(transparent)]
    NoResult(#[from] serde_json::Error),
    /// Its hash is missing or does not match its content.
    #[error("its hash is missing or does not match its content: it was changed or damaged")]
    Changed,
}

impl CellResult {
    /// The text of a result, a line.
    pub fn to_json(&self) -> String {
        let content = json(self);
        let hash = sha256(content.as_bytes());
        format!("{HEAD}{hash}{BEHIND}{}", content.get(1..).unwrap_or_default())
    }

    /// Parses the text of a result.
    pub fn from_json(text: &str) -> Result<Self, CellResultError> {
        let hashed = || {
            let (hash, rest) = text.strip_prefix(HEAD)?.split_at_checked(DIGITS)?;
            Some((hash, format!("{{{}", rest.strip_prefix(BEHIND)?)))
        };
        let Some((hash, content)) = hashed() else {
            // Text that is not JSON at all gets a better message.
            let _: Self = serde_json::from_str(text)?;
            return Err(CellResultError::Changed);
        };
        if sha256(content.as_bytes()) != hash {
            return Err(CellResultError::Changed);
        }
        Ok(serde_json::from_str(&content)?)
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;

    fn result(cell: &str) -> CellResult {
        CellResult {
            cell: cell.to_owned(),
            scene: "a.toml".to_owned(),
            parameters: BTreeMap::new(),
            screen: None,
            touch: "100".to_owned(),
            person: 3,
            moisture: 0.25,
            voltage_v_rms: 150.0,
            layers: Vec::new(),
            means: BTreeMap::from([("nrmse".to_owned(), 0.1 + 0.2)]),
        }
    }

    #[test]
    fn a_result_is_read_as_it_was_written() {
        let text = result("a1").to_json();
        assert_eq!(CellResult::from_json(&text).unwrap(), result("a1"));
        assert!(serde_json::from_str::<CellResult>(&text).is_ok(), "it is JSON for other programs");
    }

    #[test]
    fn one_flipped_bit_is_refused() {
        let text = result("a1").to_json();
        for bit in 0..8 * text.len() {
            let mut bytes = text.clone().into_bytes();
            bytes[bit / 8] ^= 1 << (bit % 8);
            let refused = str::from_utf8(&bytes).map_or(true, |text| CellResult::from_json(text).is_err());
            assert!(refused, "bit {bit}");
        }
    }
}
