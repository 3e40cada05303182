//! Instructions on a Cortex-M4F at the worst input. Written by `cargo xtask bench --bless`; `cargo xtask test` measures
//! again and fails when it finds others.

// A tick that looks at layers and finds none.
pub(super) const EMPTY: u32 = 264;

// What a sine carrier adds.
pub(super) const SINE_CARRIER: u32 = 49;

// Layers, in a rectangle.
pub(super) const CONSTANT: u32 = 64;
pub(super) const SINE: u32 = 114;
pub(super) const SQUARE: u32 = 121;
pub(super) const TRIANGLE: u32 = 91;
pub(super) const SAW: u32 = 101;
pub(super) const BITMAP: u32 = 184;
pub(super) const BITMAP_TILED: u32 = 208;
pub(super) const NOISE: u32 = 272;
pub(super) const EDGE: u32 = 194;
pub(super) const BUTTON: u32 = 200;
pub(super) const VIBRATION_SINE: u32 = 147;
pub(super) const VIBRATION_SQUARE: u32 = 126;

// A curve, and each of its points.
pub(super) const SPEED: u32 = 130;
pub(super) const SPEED_POINT: u32 = 7;

// The stream's own work included.
pub(super) const STREAM: u32 = 228;

// What other regions add to a rectangle.
pub(super) const ELLIPSE: u32 = 15;
pub(super) const POLYGON: u32 = 83;
pub(super) const POLYGON_EDGE: u32 = 18;
