//! Core cycles on a Cortex-M4F and on a Cortex-M0+ at the worst input, estimated. Written by
//! `FRIXEL_BLESS=1 cargo xtask bench`; `cargo xtask ci budgets` measures again and fails when it finds others.
#![allow(dead_code, reason = "a kind whose feature is off costs nothing")]

use crate::cost::Cost;

// A tick that looks at layers and finds none.
pub(crate) const EMPTY: Cost = Cost::new(991, 9936);

// Extra cost of a sine carrier.
pub(crate) const SINE_CARRIER: Cost = Cost::new(32, 2649);

// A curve, and each of its points.
pub(crate) const SPEED: Cost = Cost::new(157, 3885);
pub(crate) const SPEED_POINT: Cost = Cost::new(8, 116);

// The stream's own work, wherever the finger is.
pub(crate) const STREAM_ELSEWHERE: Cost = Cost::new(94, 983);

// Extra cost of regions other than a rectangle.
pub(crate) const ELLIPSE: Cost = Cost::new(8, 1138);

// A polygon, each of its edges, and what each of those adds that are level with the finger.
pub(crate) const POLYGON: Cost = Cost::new(33, 563);
pub(crate) const POLYGON_EDGE: Cost = Cost::new(19, 80);
pub(crate) const POLYGON_EDGE_LEVEL: Cost = Cost::new(26, 969);

/// Layers, in a rectangle; `kind::measured_cost` finds one by its name.
pub(crate) const LAYERS: &[(&str, Cost)] = &[
    ("bitmap", Cost::new(227, 4515)),
    ("bitmap_tiled", Cost::new(282, 7100)),
    ("button", Cost::new(228, 4431)),
    ("constant", Cost::new(76, 242)),
    ("direction", Cost::new(178, 4555)),
    ("drift", Cost::new(44, 429)),
    ("drifting_rings", Cost::new(84, 3402)),
    ("edge", Cost::new(184, 4587)),
    ("noise", Cost::new(406, 23347)),
    ("rings", Cost::new(40, 2904)),
    ("saw", Cost::new(122, 2060)),
    ("sine", Cost::new(143, 3436)),
    ("spokes", Cost::new(91, 3748)),
    ("square", Cost::new(135, 1911)),
    ("stream", Cost::new(101, 1012)),
    ("triangle", Cost::new(127, 2373)),
    ("vibration_sine", Cost::new(187, 3669)),
    ("vibration_square", Cost::new(150, 1539)),
];
