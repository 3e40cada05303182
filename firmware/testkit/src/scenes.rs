//! The basic scene for tests, and the bytes of a scene.

use frixel_layers::{
    Blend, Constant, HEADER_LEN, Header, Layer, Leader, POINT_LEN, Point, RECORD_LEN, Record, Region, SCENE_MAX_LEN,
    Waveform,
};
#[cfg(feature = "samples")]
use frixel_layers::{FingerLaw, LawPoint};

/// The example finger under a load of 0.5 N, with at most 150 V rms.
pub const HEADER: Header = Header {
    screen_width_m: 0.12,
    screen_height_m: 0.11,
    finger_radius_m: 8e-3,
    stiffness_pa_per_m: 1.8e7,
    friction_coefficient: 0.5,
    normal_load_n: 0.5,
    effective_gap_m: 1e-5,
    voltage_max_v_rms: 150.0,
    voltage_max_v_peak: 200.0,
    slew_v_per_s: 5e6,
    carrier_hz: 1000.0,
    host_timeout_s: 0.25,
    waveform: Waveform::Square,
    prediction: true,
    leader: Leader::First,
    layers_fixed: false,
    electric_friction_max_n: None,
    law: None,
};

/// A law of the most points, with a bend at each of them: rms voltage in V, electric friction in N.
#[cfg(feature = "samples")]
const LAW: [(f32, f32); 16] = [
    (20.0, 4.99e-4),
    (22.9, 5.72e-4),
    (26.2, 8.56e-4),
    (29.9, 9.52e-4),
    (34.2, 1.86e-3),
    (39.1, 2.28e-3),
    (44.8, 2.47e-3),
    (51.2, 4.22e-3),
    (58.6, 5.52e-3),
    (67.0, 6.07e-3),
    (76.6, 0.0135),
    (87.6, 0.0159),
    (100.2, 0.0466),
    (114.7, 0.0506),
    (131.1, 0.0706),
    (150.0, 0.09),
];

/// [`HEADER`] with a finger that has an empirical law of the most points.
#[cfg(feature = "samples")]
#[must_use]
pub fn empirical_header() -> Header {
    let points = LAW.map(|(voltage_v_rms, electric_friction_n)| LawPoint { voltage_v_rms, electric_friction_n });
    let law = FingerLaw::new(2.0, &points);
    Header { finger_radius_m: 0.0, stiffness_pa_per_m: 0.0, effective_gap_m: 0.0, law, ..HEADER }
}

/// A layer on the whole screen that replaces those below.
#[must_use]
pub const fn record(layer: Layer) -> Record {
    Record { region: Region::Screen, blend: Blend::Replace, gain: 1.0, layer }
}

/// Constant friction on the whole screen.
#[must_use]
pub const fn constant(electric_friction_n: f32) -> Record {
    record(Layer::Constant(Constant { electric_friction_n }))
}

/// The bytes of a scene.
#[cfg(feature = "std")]
pub type SceneBytes = std::vec::Vec<u8>;
/// The bytes of a scene.
#[cfg(not(feature = "std"))]
pub type SceneBytes = heapless::Vec<u8, SCENE_MAX_LEN>;

/// The bytes of a scene without points.
#[must_use]
pub fn scene(header: &Header, records: &[Record]) -> SceneBytes {
    scene_with_points(header, records, &[])
}

/// The bytes of a scene.
///
/// # Panics
///
/// If a scene cannot have this many records and points.
#[must_use]
pub fn scene_with_points(header: &Header, records: &[Record], points: &[Point]) -> SceneBytes {
    let law_points = header.law.map_or(0, |law| usize::from(law.point_count()));
    let len = HEADER_LEN + RECORD_LEN * records.len() + POINT_LEN * (points.len() + law_points);
    assert!(len <= SCENE_MAX_LEN, "a scene of {} records and {} points", records.len(), points.len());
    let head = header.write(records.len() as u8, points.len() as u8);
    let body = records.iter().flat_map(Record::write);
    let law = header.law.into_iter().flat_map(|law| law.write_points());
    head.into_iter().chain(body).chain(points.iter().flat_map(Point::write)).chain(law).collect()
}
