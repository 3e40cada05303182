//! Scenes that are refused, each with its reason; `golden.rs` has the accepted ones.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "helpers of tests fail as tests do")]

use crate::support;

use std::collections::BTreeSet;

use frixel_layers::{
    HEADER_LEN, Header, LAW_POINTS_MAX, Layer, POINT_LEN, Point, RECORD_LEN, Record, Region, SCENE_MAX_LEN, Scene,
    Speed,
};
use frixel_testkit::samples::{SampleRecord, sample_records};
use frixel_wire::scene::{POINTS_MAX, RECORDS_MAX, SceneError};

fn refused(bytes: &[u8]) -> SceneError {
    Scene::parse(bytes).map(|_| ()).unwrap_err()
}

fn changed(at: usize, value: u8) -> Vec<u8> {
    let mut bytes = support::scene();
    bytes[at] = value;
    bytes
}

#[test]
fn another_version_is_refused_whatever_its_length() {
    assert_eq!(refused(&changed(0, 2)), SceneError::Version { found: 2 });
    assert_eq!(refused(&changed(1, 1)), SceneError::Version { found: 0x0101 });
    assert_eq!(refused(&[3, 0]), SceneError::Version { found: 3 });
}

/// Truncated anywhere, or longer by a byte or a record.
#[test]
fn another_length_is_refused() {
    let mut bytes = support::scene();
    let expected = bytes.len() as u32;
    for found in 0..HEADER_LEN {
        assert_eq!(refused(&bytes[..found]), SceneError::Length { found: found as u32, expected: HEADER_LEN as u32 });
    }
    for found in HEADER_LEN..bytes.len() {
        assert_eq!(refused(&bytes[..found]), SceneError::Length { found: found as u32, expected });
    }
    bytes.push(0);
    assert_eq!(refused(&bytes), SceneError::Length { found: expected + 1, expected });
    for more in [POINT_LEN, RECORD_LEN] {
        bytes.resize(expected as usize + more, 0);
        assert_eq!(refused(&bytes), SceneError::Length { found: expected + more as u32, expected });
    }
}

#[test]
fn the_largest_scene_is_read_and_a_larger_one_refused() {
    let record = support::records()[0].write();
    let point = support::points()[0].write();
    let of = |records: usize, points: usize| {
        let mut bytes = support::header().write(records as u8, points as u8).to_vec();
        bytes.extend(record.repeat(records));
        bytes.extend(point.repeat(points));
        bytes
    };
    let bytes = of(RECORDS_MAX, POINTS_MAX);
    assert_eq!(bytes.len() + LAW_POINTS_MAX * POINT_LEN, SCENE_MAX_LEN);
    let scene = Scene::parse(&bytes).unwrap();
    assert_eq!((scene.records().count(), scene.points().count()), (RECORDS_MAX, POINTS_MAX));

    let found = RECORDS_MAX as u8 + 1;
    assert_eq!(refused(&of(RECORDS_MAX + 1, 0)), SceneError::TooManyRecords { found });
    let found = POINTS_MAX as u8 + 1;
    assert_eq!(refused(&of(1, POINTS_MAX + 1)), SceneError::TooManyPoints { found });
}

/// Polygons take 3 to 32 points and curves 2 to 16, all of them the scene's own.
#[test]
fn records_name_points_that_there_are() {
    let of = |record: Record, points: u8| {
        let mut bytes = support::header().write(1, points).to_vec();
        bytes.extend(record.write());
        bytes.extend(Point::default().write().repeat(usize::from(points)));
        Scene::parse(&bytes).map(|_| ())
    };
    let plain = support::records()[0];
    let polygon = |first, count| Record { region: Region::Polygon { first, count }, ..plain };
    let curve = |first, count| Record { layer: Layer::Speed(Speed { first, count }), ..plain };
    for points in [0, 2, 3, 16, 17, 32, 33, 100, 128] {
        for first in [0, 1, 95, 96, 97, 112, 126, 127, 255] {
            for count in [0, 1, 2, 3, 16, 17, 32, 33, 255] {
                let inside = usize::from(first) + usize::from(count) <= usize::from(points);
                let error = Err(SceneError::Points { record: 0, first, count });
                let expected = if inside && (3..=32).contains(&count) { Ok(()) } else { error };
                assert_eq!(of(polygon(first, count), points), expected);
                let expected = if inside && (2..=16).contains(&count) { Ok(()) } else { error };
                assert_eq!(of(curve(first, count), points), expected);
            }
        }
    }
}

#[test]
fn a_button_has_a_rectangle_or_an_ellipse() {
    let mut scene = support::scene();
    let number = support::records().iter().position(|record| matches!(record.layer, Layer::Button(_))).unwrap();
    for (region, plain) in [(Region::Screen, false), (Region::Polygon { first: 0, count: 3 }, false)]
        .into_iter()
        .chain(support::records().iter().map(|record| (record.region, true)))
    {
        let takes = plain && matches!(region, Region::Rectangle { .. } | Region::Ellipse { .. });
        let record = Record { region, ..support::records()[number] };
        scene[HEADER_LEN + number * RECORD_LEN..][..RECORD_LEN].copy_from_slice(&record.write());
        let error = Err(SceneError::ButtonRegion { record: number as u8 });
        assert_eq!(Scene::parse(&scene).map(|_| ()), if takes { Ok(()) } else { error }, "{region:?}");
    }
}

/// The number in the header is no less than the one that was written, and at most 1 % more.
#[test]
fn the_largest_friction_is_rounded_up() {
    for friction_n in [0.0, 1e-30, 0.003, 0.02, 0.025_024_414, 0.9999, 77.7] {
        let header = Header { electric_friction_max_n: Some(friction_n), ..support::header() };
        let (read, _, _) = Header::parse(&header.write(0, 0)).unwrap();
        let read_n = read.electric_friction_max_n.unwrap();
        assert!(read_n >= friction_n && read_n <= 1.01 * friction_n, "{friction_n} is read as {read_n}");
    }
}

#[test]
fn unknown_flags_and_carriers_are_refused() {
    for flags in 64..=u8::MAX {
        assert_eq!(refused(&changed(3, flags)), SceneError::UnknownFlags(flags));
    }
    for shape in 2..=u8::MAX {
        assert_eq!(refused(&changed(52, shape)), SceneError::UnknownCarrier(shape));
    }
}

/// Every value of kind, region, blend and form is either refused by name or one that has golden bytes.
#[test]
fn unknown_choices_are_refused() {
    let golden: Vec<_> = support::records().iter().map(Record::write).collect();
    let is_grating =
        |record: &&Record| matches!(record, Record { region: Region::Rectangle { .. }, layer: Layer::Grating(_), .. });
    let grating = support::records().iter().find(is_grating).unwrap().write();
    for offset in 0..4 {
        let known: BTreeSet<u8> = golden.iter().map(|record| record[usize::from(offset)]).collect();
        for value in 0..=u8::MAX {
            // A record that uses everything, of a kind with a form: a grating on a rectangle.
            let mut record = grating;
            record[usize::from(offset)] = value;
            let unknown = match offset {
                0 => SceneError::UnknownKind { record: 7, kind: value },
                offset => SceneError::UnknownChoice { record: 7, offset, value },
            };
            let refused = Record::parse(&record, 7).err();
            assert_eq!(refused == Some(unknown), !known.contains(&value), "offset {offset}: {value} gives {refused:?}");
        }
    }
}

/// Offsets of the bytes that a record uses, from the tables in `PROTOCOL.md`.
fn used(sample: &SampleRecord) -> BTreeSet<usize> {
    let mut used: BTreeSet<usize> = [0, 1, 2].into_iter().chain(20..24).collect();
    match sample.record.region {
        Region::Screen => {}
        Region::Rectangle { .. } | Region::Ellipse { .. } => used.extend(4..20),
        Region::Polygon { .. } => used.extend(4..6),
    }
    used.extend(sample.used.iter().cloned().flatten());
    used
}

#[test]
fn bytes_that_nothing_uses_are_zero() {
    for sample in sample_records() {
        let record = sample.record;
        for offset in 0..RECORD_LEN {
            let mut bytes = record.write();
            if used(sample).contains(&offset) {
                continue;
            }
            assert_eq!(bytes[offset], 0);
            bytes[offset] = 0x80;
            let refused = Record::parse(&bytes, 5);
            assert_eq!(refused, Err(SceneError::NotZero { record: 5, offset: offset as u8 }), "{record:?}");
        }
    }
    for offset in 54..HEADER_LEN {
        let not_zero = SceneError::NotZero { record: SceneError::HEADER, offset: offset as u8 };
        assert_eq!(refused(&changed(offset, 1)), not_zero);
    }
}

/// Every used byte matters: changing it changes the record or refuses it.
#[test]
fn bytes_that_something_uses_are_read() {
    for sample in sample_records() {
        let record = sample.record;
        for offset in used(sample) {
            let mut bytes = record.write();
            bytes[offset] ^= 1;
            assert_ne!(Record::parse(&bytes, 0), Ok(record), "offset {offset} of {record:?}");
        }
    }
    for offset in 3..54 {
        let mut bytes = support::header().write(0, 0);
        bytes[offset] ^= 1;
        assert_ne!(Header::parse(&bytes), Ok((support::header(), 0, 0)), "offset {offset}");
    }
}
