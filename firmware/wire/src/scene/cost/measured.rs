//! Instructions on a Cortex-M4F at the worst input. Written by `cargo xtask bench --bless`; `cargo xtask test` measures
//! again and fails when it finds others.

// A tick that looks at layers and finds none.
pub(super) const EMPTY: u32 = 268;

// What a sine carrier adds.
pub(super) const SINE_CARRIER: u32 = 47;

// Layers, in a rectangle.
pub(super) const CONSTANT: u32 = 64;
pub(super) const SINE: u32 = 112;
pub(super) const SQUARE: u32 = 113;
pub(super) const TRIANGLE: u32 = 91;
pub(super) const SAW: u32 = 101;
pub(super) const BITMAP: u32 = 182;
pub(super) const BITMAP_TILED: u32 = 198;
pub(super) const NOISE: u32 = 256;
pub(super) const EDGE: u32 = 194;
pub(super) const BUTTON: u32 = 203;
pub(super) const VIBRATION_SINE: u32 = 145;
pub(super) const VIBRATION_SQUARE: u32 = 126;

// A curve, and each of its points.
pub(super) const SPEED: u32 = 130;
pub(super) const SPEED_POINT: u32 = 7;
pub(super) const STREAM: u32 = 98;

// The stream's own work, wherever the finger is.
pub(super) const STREAM_ELSEWHERE: u32 = 130;

// What other regions add to a rectangle.
pub(super) const ELLIPSE: u32 = 8;

// A polygon, each of its edges, and what each of those adds that are level with the finger.
pub(super) const POLYGON: u32 = 23;
pub(super) const POLYGON_EDGE: u32 = 17;
pub(super) const POLYGON_EDGE_LEVEL: u32 = 21;
