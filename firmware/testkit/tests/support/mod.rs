//! Headers, and a scene of all samples.
#![allow(unreachable_pub)]

use frixel_layers::{FingerLaw, Header, LawPoint, Leader, Point, Record, Waveform};
use frixel_testkit::samples::{POINTS, sample_records};

pub fn header() -> Header {
    Header {
        screen_width_m: 0.1,
        screen_height_m: 0.0625,
        finger_radius_m: 0.008,
        stiffness_pa_per_m: 1e8,
        friction_coefficient: 0.5,
        normal_load_n: 0.5,
        effective_gap_m: 250e-9,
        voltage_max_v_rms: 150.0,
        voltage_max_v_peak: 160.0,
        slew_v_per_s: 100_000.0,
        carrier_hz: 1_000.0,
        host_timeout_s: 0.25,
        waveform: Waveform::Square,
        prediction: true,
        leader: Leader::First,
        layers_fixed: false,
        electric_friction_max_n: None,
        law: None,
    }
}

pub fn headers() -> Vec<Header> {
    vec![
        header(),
        Header { waveform: Waveform::Sine, prediction: false, ..header() },
        Header { leader: Leader::Latest, ..header() },
        Header { layers_fixed: true, ..header() },
        Header { layers_fixed: true, electric_friction_max_n: Some(0.025_024_414), ..header() },
    ]
}

/// The scene of a finger with an empirical law, without layers.
pub fn law_scene() -> Vec<u8> {
    let points = [(50.0, 1e-3), (150.0, 27e-3)]
        .map(|(voltage_v_rms, electric_friction_n)| LawPoint { voltage_v_rms, electric_friction_n });
    let law = FingerLaw::new(2.0, &points);
    let header = Header { finger_radius_m: 0.0, stiffness_pa_per_m: 0.0, effective_gap_m: 0.0, law, ..header() };
    frixel_testkit::scene(&header, &[])
}

pub fn records() -> Vec<Record> {
    sample_records().map(|sample| sample.record).collect()
}

pub fn points() -> Vec<Point> {
    POINTS.to_vec()
}

/// A whole scene of [`header`], [`records`] and [`points`].
pub fn scene() -> Vec<u8> {
    let (records, points) = (records(), points());
    let mut bytes = header().write(records.len() as u8, points.len() as u8).to_vec();
    bytes.extend(records.iter().flat_map(Record::write));
    bytes.extend(points.iter().flat_map(Point::write));
    bytes
}
