//! Instructions on a Cortex-M4F at the worst input. Written by `cargo xtask bench --bless`; `cargo xtask test` measures
//! again and fails when it finds others.

// A tick that looks at layers and finds none.
pub(super) const EMPTY: u32 = 270;

// What a sine carrier adds.
pub(super) const SINE_CARRIER: u32 = 23;

// Layers, in a rectangle.
pub(super) const CONSTANT: u32 = 38;
pub(super) const SINE: u32 = 82;
pub(super) const SQUARE: u32 = 89;
pub(super) const TRIANGLE: u32 = 83;
pub(super) const SAW: u32 = 72;
pub(super) const BITMAP: u32 = 149;
pub(super) const BITMAP_TILED: u32 = 167;
pub(super) const NOISE: u32 = 232;
pub(super) const EDGE: u32 = 164;
pub(super) const BUTTON: u32 = 170;
pub(super) const VIBRATION_SINE: u32 = 113;
pub(super) const VIBRATION_SQUARE: u32 = 97;

// A curve, and each of its points.
pub(super) const SPEED: u32 = 105;
pub(super) const SPEED_POINT: u32 = 7;
pub(super) const STREAM: u32 = 75;

// The stream's own work, wherever the finger is.
pub(super) const STREAM_ELSEWHERE: u32 = 126;

// What other regions add to a rectangle.
pub(super) const ELLIPSE: u32 = 5;

// A polygon, each of its edges, and what each of those adds that are level with the finger.
pub(super) const POLYGON: u32 = 40;
pub(super) const POLYGON_EDGE: u32 = 16;
pub(super) const POLYGON_EDGE_LEVEL: u32 = 22;
