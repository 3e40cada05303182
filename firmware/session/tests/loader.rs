//! The board's loader: its numbered refusals, and its behaviour and the tick's for arbitrary bytes.

use crate::support::{HEADER, TestBoard, constant, scene_with_points};
use frixel_layers::{Header, Record, Scene};
use frixel_testkit::samples::{POINTS, sample_records, with_bitmap_crc32};
use frixel_wire::message::Command;
use frixel_wire::scene::bitmap_crc32;
use proptest::prelude::*;

const SAMPLES: [u8; 6] = [0, 50, 100, 150, 200, 250];

/// The samples of all kinds, in every region.
fn records() -> Vec<Record> {
    let with_bitmap_crc32 = |layer| with_bitmap_crc32(layer, bitmap_crc32(3, 2, &SAMPLES));
    let records = sample_records().map(|sample| sample.record);
    records.map(|record| Record { layer: with_bitmap_crc32(record.layer), ..record }).collect()
}

// Uploading pictures and starting streams are the session's own features.
#[cfg(all(feature = "bitmap", feature = "stream"))]
mod whole {
    use crate::support::record;
    use frixel_layers::{Layer, Point, RECORD_LEN, Region, Speed};
    use frixel_wire::message::{ConfigField, ConfigRefusal, Refusal};

    use super::*;

    #[track_caller]
    fn record_that(is: impl Fn(&Record) -> bool) -> Record {
        records().into_iter().find(is).unwrap()
    }

    fn refusal(record: Record, points: &[Point]) -> Option<ConfigRefusal> {
        let mut board = TestBoard::connected();
        board.upload_bitmap(3, 2, &SAMPLES).unwrap();
        match board.load(&scene_with_points(&HEADER, &[record], points)) {
            Ok(_) => None,
            Err(Refusal::Config(refusal)) => Some(refusal),
            Err(other) => panic!("{other:?}"),
        }
    }

    /// Every parameter of every kind is validated: a record with NaN there is refused.
    #[test]
    fn nan_in_any_parameter_is_refused() {
        let parameters = |record: &Record| {
            let bytes = record.write();
            // The bitmap's name and the noise's seed are not `f32`; the points of a curve are tested below.
            let end = if matches!(record.layer, Layer::Edge(_)) { RECORD_LEN } else { 52 };
            let starts = if matches!(record.region, Region::Polygon { .. }) { 20 } else { 4 };
            (starts..end).step_by(4).filter(|at| bytes[*at..at + 4] != [0; 4]).collect::<Vec<_>>()
        };
        let mut judged = 0;
        for record in records() {
            assert_eq!(refusal(record, &POINTS), None, "{record:?}");
            for at in parameters(&record) {
                let mut bytes = record.write();
                bytes[at..at + 4].copy_from_slice(&f32::NAN.to_le_bytes());
                let record = Record::parse(&bytes, 0).unwrap();
                assert!(
                    refusal(record, &POINTS).is_some_and(|refusal| refusal.found.is_nan()),
                    "byte {at}: {record:?}"
                );
                judged += 1;
            }
        }
        assert!(judged > 80, "{judged}");
        let is_polygon = |record: &Record| matches!(record.region, Region::Polygon { .. });
        // A curve of the first two points, and a triangle of the others.
        let users = [record_that(|record| matches!(record.layer, Layer::Speed(_))), record_that(is_polygon)];
        for at in 0..POINTS.len() {
            for axis in 0..2 {
                let mut points = POINTS;
                let number = if axis == 0 { &mut points[at].x } else { &mut points[at].y };
                *number = f32::NAN;
                let user = users[usize::from(at >= 2)];
                assert!(refusal(user, &points).is_some(), "point {at}");
            }
        }
    }

    #[test]
    fn speeds_of_a_curve_rise() {
        let curve = record(Layer::Speed(Speed { first: 0, count: 2 }));
        let refusal = refusal(curve, &[(0.1, 1.0), (0.1, 2.0)].map(|(x, y)| Point { x, y })).unwrap();
        assert_eq!((refusal.field, refusal.found), (ConfigField::CurveSpeed, 0.1));
    }

    #[test]
    fn side_tables_are_refused_by_what_they_hold() {
        let of = |layer, count: usize| {
            let mut board = TestBoard::connected();
            // Side by side, since overlapping layers would be too costly.
            let beside = |number: usize| {
                let (x_m, y_m) = (1e-3 + 7.5e-3 * (number % 16) as f32, 0.01 + 0.01 * (number / 16) as f32);
                let region = Region::Rectangle { x_m, y_m, width_m: 4e-3, height_m: 4e-3 };
                Record { region, ..record(layer) }
            };
            let records: Vec<Record> = (0..count).map(beside).collect();
            board.load(&scene_with_points(&HEADER, &records, &[])).err()
        };
        let noise = record_that(|record| matches!(record.layer, Layer::Noise(_))).layer;
        assert_eq!(of(noise, 8), None);
        let full = |field, max: f32| {
            Some(Refusal::Config(ConfigRefusal { field, found: max + 1.0, min: 0.0, max, layer: max as u8 }))
        };
        assert_eq!(of(noise, 9), full(ConfigField::NoiseLayers, 8.0));
        let edge = record_that(|record| matches!(record.layer, Layer::Edge(_))).layer;
        assert_eq!(of(edge, 16), None);
        assert_eq!(of(edge, 17), full(ConfigField::ClickLayers, 16.0));
    }
}

/// A layer over a friction out of reach of any voltage, as a scene with some of its bytes changed.
fn nearly() -> impl Strategy<Value = Vec<u8>> {
    let good = |record: Record, voltage_max_v_peak: f32| {
        let header = Header { voltage_max_v_peak, ..HEADER };
        scene_with_points(&header, &[constant(1.0), record], &POINTS)
    };
    let byte = (any::<prop::sample::Index>(), any::<u8>()).prop_map(|(at, byte)| (at, vec![byte]));
    let small = (any::<prop::sample::Index>(), 0..12u8).prop_map(|(at, byte)| (at, vec![byte]));
    let number =
        (any::<prop::sample::Index>(), any::<f32>()).prop_map(|(at, number)| (at, number.to_le_bytes().to_vec()));
    let changes = prop::collection::vec(prop_oneof![byte, small, number], 0..6);
    (prop::sample::select(records()), 1.0_f32..220.0, changes).prop_map(move |(record, peak_v, changes)| {
        let mut bytes = good(record, peak_v);
        for (at, change) in changes {
            // Numbers stand at multiples of four.
            let at = at.index(bytes.len() / 4) * 4 + if change.len() == 1 { usize::from(change[0] % 4) } else { 0 };
            bytes[at..at + change.len()].copy_from_slice(&change);
        }
        bytes
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 192, ..ProptestConfig::default() })]

    #[test]
    fn nearly_valid_scenes_neither_panic_nor_drive_beyond_their_limits(scene in nearly()) {
        let mut board = TestBoard::connected();
        let _ = board.upload_bitmap(3, 2, &SAMPLES);
        if board.load(&scene).is_ok() {
            board.command(Command::Arm).unwrap();
            board.command(Command::Play).unwrap();
            let code_max = (Scene::parse(&scene).unwrap().header().voltage_max_v_peak * 32_767.0 / 250.0) as i32;
            for drive in board.slide(1_500) {
                prop_assert!(i32::from(drive.dac_code.bits()).abs() <= code_max, "{drive:?}");
            }
            prop_assert_eq!(board.status().counters.clamped_loads, 0, "an accepted scene is within the ceilings");
        }
    }
}
