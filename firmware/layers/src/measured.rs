//! Core cycles on a Cortex-M4F at the worst input, estimated. Written by `FRIXEL_BLESS=1 cargo xtask bench`;
//! `cargo xtask test` measures again and fails when it finds others.
#![allow(dead_code, reason = "a kind whose feature is off costs nothing")]

// A tick that looks at layers and finds none.
pub(crate) const EMPTY: u32 = 863;

// What a sine carrier adds.
pub(crate) const SINE_CARRIER: u32 = 37;

// A curve, and each of its points.
pub(crate) const SPEED: u32 = 147;
pub(crate) const SPEED_POINT: u32 = 11;

// The stream's own work, wherever the finger is.
pub(crate) const STREAM_ELSEWHERE: u32 = 158;

// What other regions add to a rectangle.
pub(crate) const ELLIPSE: u32 = 8;

// A polygon, each of its edges, and what each of those adds that are level with the finger.
pub(crate) const POLYGON: u32 = 36;
pub(crate) const POLYGON_EDGE: u32 = 19;
pub(crate) const POLYGON_EDGE_LEVEL: u32 = 26;

/// Layers, in a rectangle; `kind::core_cycles` finds one by its name.
pub(crate) const LAYERS: &[(&str, u32)] = &[
    ("bitmap", 223),
    ("bitmap_tiled", 274),
    ("button", 281),
    ("constant", 72),
    ("direction", 170),
    ("drift", 14),
    ("drifting_rings", 56),
    ("edge", 253),
    ("noise", 402),
    ("rings", 40),
    ("saw", 136),
    ("sine", 139),
    ("spokes", 91),
    ("square", 145),
    ("stream", 97),
    ("triangle", 123),
    ("vibration_sine", 183),
    ("vibration_square", 150),
];
