//! Instructions on a Cortex-M4F at the worst input. Written by `cargo xtask bench --bless`; `cargo xtask test` measures
//! again and fails when it finds others.

// A tick that looks at layers and finds none.
pub(super) const EMPTY: u32 = 259;

// What a sine carrier adds.
pub(super) const SINE_CARRIER: u32 = 23;

// Layers, in a rectangle.
pub(super) const CONSTANT: u32 = 38;
pub(super) const SINE: u32 = 89;
pub(super) const SQUARE: u32 = 92;
pub(super) const TRIANGLE: u32 = 83;
pub(super) const SAW: u32 = 78;
pub(super) const BITMAP: u32 = 152;
pub(super) const BITMAP_TILED: u32 = 176;
pub(super) const NOISE: u32 = 235;
pub(super) const EDGE: u32 = 171;
pub(super) const BUTTON: u32 = 177;
pub(super) const VIBRATION_SINE: u32 = 116;
pub(super) const VIBRATION_SQUARE: u32 = 87;

// A curve, and each of its points.
pub(super) const SPEED: u32 = 108;
pub(super) const SPEED_POINT: u32 = 7;
pub(super) const STREAM: u32 = 75;

// The stream's own work, wherever the finger is.
pub(super) const STREAM_ELSEWHERE: u32 = 129;

// What other regions add to a rectangle.
pub(super) const ELLIPSE: u32 = 23;

// A polygon, each of its edges, and what each of those adds that are level with the finger.
pub(super) const POLYGON: u32 = 43;
pub(super) const POLYGON_EDGE: u32 = 16;
pub(super) const POLYGON_EDGE_LEVEL: u32 = 22;
