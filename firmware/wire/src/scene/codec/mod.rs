//! The bytes of headers, records and points.
//!
//! A layout has one form for each value: what a kind does not use is zero. Parsing writes the value again and compares.

mod header;
mod layer;
mod record;
mod region;

use super::SceneError;
use layer::{KIND_CONSTANT, KIND_STREAM};
use region::{REGION_AT, REGION_POLYGON};

impl SceneError {
    /// Number of the record that is unknown only because this crate was built without a feature that it needs.
    pub const fn left_out(&self) -> Option<u8> {
        match *self {
            Self::UnknownKind { record, kind: KIND_CONSTANT..=KIND_STREAM } => Some(record),
            Self::UnknownChoice { record, offset, value: REGION_POLYGON } if offset as usize == REGION_AT => {
                Some(record)
            }
            _ => None,
        }
    }
}

/// Offset of the first byte in which two layouts differ.
fn first_difference<const LEN: usize>(found: &[u8; LEN], canonical: &[u8; LEN]) -> Option<u8> {
    found.iter().zip(canonical).position(|(a, b)| a != b).map(|offset| offset as u8)
}
