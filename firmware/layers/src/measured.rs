//! Core cycles on a Cortex-M4F at the worst input, estimated. Written by `FRIXEL_BLESS=1 cargo xtask bench`;
//! `cargo xtask test` measures again and fails when it finds others.
#![allow(dead_code, reason = "a kind whose feature is off costs nothing")]

// A tick that looks at layers and finds none.
pub(crate) const EMPTY: u32 = 832;

// What a sine carrier adds.
pub(crate) const SINE_CARRIER: u32 = 37;

// Layers, in a rectangle.
pub(crate) const CONSTANT: u32 = 72;
pub(crate) const SINE: u32 = 139;
pub(crate) const SQUARE: u32 = 145;
pub(crate) const TRIANGLE: u32 = 123;
pub(crate) const SAW: u32 = 118;
pub(crate) const RINGS: u32 = 58;
pub(crate) const BITMAP: u32 = 223;
pub(crate) const BITMAP_TILED: u32 = 274;
pub(crate) const NOISE: u32 = 402;
pub(crate) const EDGE: u32 = 253;
pub(crate) const BUTTON: u32 = 281;
pub(crate) const VIBRATION_SINE: u32 = 178;
pub(crate) const VIBRATION_SQUARE: u32 = 147;

// A curve, and each of its points.
pub(crate) const SPEED: u32 = 147;
pub(crate) const SPEED_POINT: u32 = 11;
pub(crate) const STREAM: u32 = 97;

// The stream's own work, wherever the finger is.
pub(crate) const STREAM_ELSEWHERE: u32 = 143;

// What other regions add to a rectangle.
pub(crate) const ELLIPSE: u32 = 8;

// A polygon, each of its edges, and what each of those adds that are level with the finger.
pub(crate) const POLYGON: u32 = 33;
pub(crate) const POLYGON_EDGE: u32 = 19;
pub(crate) const POLYGON_EDGE_LEVEL: u32 = 26;
