//! The layout common to the records of all kinds.

/// Bytes of a record.
pub const RECORD_LEN: usize = 56;

/// The bytes of a record.
pub(crate) type RecordBytes = [u8; RECORD_LEN];

pub(crate) const KIND_AT: usize = 0;
pub(crate) const REGION_AT: usize = 1;
pub(crate) const BLEND_AT: usize = 2;
/// The form of a kind: the wave of a grating, or whether a bitmap is tiled.
pub(crate) const FORM_AT: usize = 3;
/// The region's own numbers: four `f32` of a rectangle, two bytes of a polygon.
pub(crate) const REGION_NUMBERS_AT: usize = 4;
pub(crate) const GAIN_AT: usize = 20;
