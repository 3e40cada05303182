//! Core cycles on a Cortex-M4F and on a Cortex-M0+ at the worst input, estimated. Written by
//! `FRIXEL_BLESS=1 cargo xtask bench`; `cargo xtask ci budgets` measures again and fails when it finds others.
#![allow(dead_code, reason = "a kind whose feature is off costs nothing")]

use crate::cost::Cost;

// A tick that looks at layers and finds none.
pub(crate) const EMPTY: Cost = Cost::new(1017, 9879);

// What a sine carrier adds.
pub(crate) const SINE_CARRIER: Cost = Cost::new(36, 2503);

// A curve, and each of its points.
pub(crate) const SPEED: Cost = Cost::new(156, 3891);
pub(crate) const SPEED_POINT: Cost = Cost::new(8, 127);

// The stream's own work, wherever the finger is.
pub(crate) const STREAM_ELSEWHERE: Cost = Cost::new(160, 975);

// What other regions add to a rectangle.
pub(crate) const ELLIPSE: Cost = Cost::new(7, 1233);

// A polygon, each of its edges, and what each of those adds that are level with the finger.
pub(crate) const POLYGON: Cost = Cost::new(34, 323);
pub(crate) const POLYGON_EDGE: Cost = Cost::new(19, 97);
pub(crate) const POLYGON_EDGE_LEVEL: Cost = Cost::new(27, 988);

/// Layers, in a rectangle; `kind::measured_cost` finds one by its name.
pub(crate) const LAYERS: &[(&str, Cost)] = &[
    ("bitmap", Cost::new(221, 4545)),
    ("bitmap_tiled", Cost::new(273, 7133)),
    ("button", Cost::new(227, 4458)),
    ("constant", Cost::new(71, 334)),
    ("direction", Cost::new(168, 4610)),
    ("drift", Cost::new(9, 378)),
    ("drifting_rings", Cost::new(52, 3413)),
    ("edge", Cost::new(173, 4651)),
    ("noise", Cost::new(400, 23326)),
    ("rings", Cost::new(35, 2898)),
    ("saw", Cost::new(116, 2098)),
    ("sine", Cost::new(142, 3464)),
    ("spokes", Cost::new(83, 3751)),
    ("square", Cost::new(192, 2012)),
    ("stream", Cost::new(95, 1091)),
    ("triangle", Cost::new(122, 2414)),
    ("vibration_sine", Cost::new(186, 3769)),
    ("vibration_square", Cost::new(149, 1519)),
];
