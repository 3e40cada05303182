//! The basic scene for tests, and the bytes of a scene.

use frixel_layers::{
    Blend, Constant, HEADER_LEN, Header, Layer, Leader, POINT_LEN, Point, RECORD_LEN, Record, Region, SCENE_MAX_LEN,
    Waveform,
};

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
    autonomous: false,
    prediction: true,
    leader: Leader::First,
    layers_fixed: false,
    electric_friction_max_n: None,
    law: None,
};

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
