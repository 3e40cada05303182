//! Core cycles on a Cortex-M4F and on a Cortex-M0+ at the worst input, estimated. Written by
//! `FRIXEL_BLESS=1 cargo xtask bench`; `cargo xtask ci budgets` measures again and fails when it finds others.
#![allow(dead_code, reason = "a kind whose feature is off costs nothing")]

use crate::cost::Cost;

// A tick that looks at layers and finds none.
pub(crate) const EMPTY: Cost = Cost::new(863, 9658);

// What a sine carrier adds.
pub(crate) const SINE_CARRIER: Cost = Cost::new(37, 2518);

// A curve, and each of its points.
pub(crate) const SPEED: Cost = Cost::new(153, 3931);
pub(crate) const SPEED_POINT: Cost = Cost::new(8, 114);

// The stream's own work, wherever the finger is.
pub(crate) const STREAM_ELSEWHERE: Cost = Cost::new(156, 975);

// What other regions add to a rectangle.
pub(crate) const ELLIPSE: Cost = Cost::new(8, 1223);

// A polygon, each of its edges, and what each of those adds that are level with the finger.
pub(crate) const POLYGON: Cost = Cost::new(36, 361);
pub(crate) const POLYGON_EDGE: Cost = Cost::new(19, 99);
pub(crate) const POLYGON_EDGE_LEVEL: Cost = Cost::new(26, 997);

/// Layers, in a rectangle; `kind::measured_cost` finds one by its name.
pub(crate) const LAYERS: &[(&str, Cost)] = &[
    ("bitmap", Cost::new(223, 4548)),
    ("bitmap_tiled", Cost::new(274, 7143)),
    ("button", Cost::new(279, 4444)),
    ("constant", Cost::new(72, 334)),
    ("direction", Cost::new(170, 4584)),
    ("drift", Cost::new(14, 370)),
    ("drifting_rings", Cost::new(56, 3517)),
    ("edge", Cost::new(251, 4586)),
    ("noise", Cost::new(402, 23327)),
    ("rings", Cost::new(40, 2987)),
    ("saw", Cost::new(180, 2064)),
    ("sine", Cost::new(139, 3431)),
    ("spokes", Cost::new(91, 3892)),
    ("square", Cost::new(189, 2050)),
    ("stream", Cost::new(97, 1066)),
    ("triangle", Cost::new(123, 2415)),
    ("vibration_sine", Cost::new(183, 3729)),
    ("vibration_square", Cost::new(150, 1510)),
];
