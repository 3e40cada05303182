//! The bytes of headers, records and points.
//!
//! A layout has one form for each value: what a kind does not use is zero. Parsing writes the value again and compares.

mod header;
mod layer;
mod record;
mod region;

/// Offset of the first byte in which two layouts differ.
fn first_difference<const LEN: usize>(found: &[u8; LEN], canonical: &[u8; LEN]) -> Option<u8> {
    found.iter().zip(canonical).position(|(a, b)| a != b).map(|offset| offset as u8)
}
