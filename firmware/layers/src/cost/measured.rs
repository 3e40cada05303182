//! Core cycles on a Cortex-M4F at the worst input, estimated. Written by `cargo xtask bench --bless`; `cargo xtask
//! test` measures again and fails when it finds others.
#![allow(dead_code, reason = "a kind whose feature is off costs nothing")]

// A tick that looks at layers and finds none.
pub(crate) const EMPTY: u32 = 850;

// What a sine carrier adds.
pub(crate) const SINE_CARRIER: u32 = 55;

// Layers, in a rectangle.
pub(crate) const CONSTANT: u32 = 72;
pub(crate) const SINE: u32 = 158;
pub(crate) const SQUARE: u32 = 150;
pub(crate) const TRIANGLE: u32 = 146;
pub(crate) const SAW: u32 = 118;
pub(crate) const RINGS: u32 = 21;
pub(crate) const BITMAP: u32 = 223;
pub(crate) const BITMAP_TILED: u32 = 293;
pub(crate) const NOISE: u32 = 429;
pub(crate) const EDGE: u32 = 274;
pub(crate) const BUTTON: u32 = 302;
pub(crate) const VIBRATION_SINE: u32 = 199;
pub(crate) const VIBRATION_SQUARE: u32 = 166;

// A curve, and each of its points.
pub(crate) const SPEED: u32 = 172;
pub(crate) const SPEED_POINT: u32 = 8;
pub(crate) const STREAM: u32 = 97;

// The stream's own work, wherever the finger is.
pub(crate) const STREAM_ELSEWHERE: u32 = 137;

// What other regions add to a rectangle.
pub(crate) const ELLIPSE: u32 = 8;

// A polygon, each of its edges, and what each of those adds that are level with the finger.
pub(crate) const POLYGON: u32 = 19;
pub(crate) const POLYGON_EDGE: u32 = 21;
pub(crate) const POLYGON_EDGE_LEVEL: u32 = 29;
