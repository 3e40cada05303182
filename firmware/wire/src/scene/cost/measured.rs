//! x

pub(super) const EMPTY: u32 = 1;
pub(super) const SINE_CARRIER: u32 = 1;
pub(super) const CONSTANT: u32 = 1;
pub(super) const SINE: u32 = 1;
pub(super) const SQUARE: u32 = 1;
pub(super) const TRIANGLE: u32 = 1;
pub(super) const SAW: u32 = 1;
pub(super) const BITMAP: u32 = 1;
pub(super) const BITMAP_TILED: u32 = 1;
pub(super) const NOISE: u32 = 1;
pub(super) const EDGE: u32 = 1;
pub(super) const BUTTON: u32 = 1;
pub(super) const VIBRATION_SINE: u32 = 1;
pub(super) const VIBRATION_SQUARE: u32 = 1;
pub(super) const SPEED: u32 = 1;
pub(super) const SPEED_POINT: u32 = 1;
pub(super) const STREAM: u32 = 1;
pub(super) const ELLIPSE: u32 = 1;
pub(super) const POLYGON: u32 = 1;
pub(super) const POLYGON_EDGE: u32 = 1;
