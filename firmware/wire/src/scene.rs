//! Definitions for messages about scenes and bitmaps: limits of the scene layout, errors in a scene, and the CRC-32
//! that identifies a bitmap. The layout itself is in `frixel-layers`.

mod error;

pub use error::SceneError;

use crate::frame::Crc32;

/// Maximum number of records in a scene.
pub const RECORDS_MAX: usize = 64;
/// Maximum number of points in a scene, over all polygons and curves.
pub const POINTS_MAX: usize = 128;
/// Maximum number of vertices of a polygon.
pub const POLYGON_POINTS_MAX: usize = 32;
/// Maximum number of points of a speed curve.
pub const CURVE_POINTS_MAX: usize = 16;

/// CRC-32 that identifies a bitmap, computed over its width and height, each two bytes little-endian, and its samples.
/// The dimensions distinguish bitmaps with the same samples.
pub fn bitmap_crc32(width: u16, height: u16, samples: &[u8]) -> u32 {
    bitmap_digest(width, height).update(samples).finish()
}

/// Starts a [`bitmap_crc32`] for samples that arrive in pieces.
pub fn bitmap_digest(width: u16, height: u16) -> Crc32 {
    let mut digest = Crc32::new();
    digest.update(&width.to_le_bytes()).update(&height.to_le_bytes());
    digest
}
