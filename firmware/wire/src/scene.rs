//! What messages say of scenes and bitmaps: limits of the layout, why bytes are not a scene, and the name of a bitmap.
//! The layout itself is in `frixel-layers`.

mod error;

pub use error::SceneError;

use crate::frame::Crc32;

/// Most records that the layout allows.
pub const RECORDS_MAX: usize = 64;
/// Most points that the layout allows, those of all polygons and curves together.
pub const POINTS_MAX: usize = 128;
/// Most vertices of a polygon.
pub const POLYGON_POINTS_MAX: usize = 32;
/// Most points of a curve of speed.
pub const CURVE_POINTS_MAX: usize = 16;

/// CRC-32 that names a bitmap: of its width and height, each little-endian in two bytes, and its samples. The shape is
/// part of the name, since the same bytes in another shape are another picture.
pub fn bitmap_crc32(width: u16, height: u16, samples: &[u8]) -> u32 {
    bitmap_digest(width, height).update(samples).finish()
}

/// [`bitmap_crc32`] of samples that come piece by piece.
pub fn bitmap_digest(width: u16, height: u16) -> Crc32 {
    let mut digest = Crc32::new();
    digest.update(&width.to_le_bytes()).update(&height.to_le_bytes());
    digest
}
