//! Scenes that are refused, each with its reason; `golden.rs` has those that are read.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "helpers of tests fail as tests do")]

mod support;

use std::collections::BTreeSet;

use frixel_wire::scene::{
    Blend, HEADER_LEN, Header, Layer, RECORD_LEN, RECORDS_MAX, Record, Region, SCENE_MAX_LEN, Scene, SceneError,
};
use support::samples;

fn refused(bytes: &[u8]) -> SceneError {
    Scene::parse(bytes).map(|_| ()).unwrap_err()
}

fn changed(at: usize, value: u8) -> Vec<u8> {
    let mut bytes = samples::scene();
    bytes[at] = value;
    bytes
}

#[test]
fn another_version_is_refused_whatever_its_length() {
    assert_eq!(refused(&changed(0, 2)), SceneError::Version { found: 2 });
    assert_eq!(refused(&changed(1, 1)), SceneError::Version { found: 0x0101 });
    assert_eq!(refused(&[2, 0]), SceneError::Version { found: 2 });
}

/// Cut anywhere or longer by a byte or a record.
#[test]
fn another_length_is_refused() {
    let mut bytes = samples::scene();
    let expected = bytes.len() as u32;
    for found in 0..HEADER_LEN {
        assert_eq!(refused(&bytes[..found]), SceneError::Length { found: found as u32, expected: HEADER_LEN as u32 });
    }
    for found in HEADER_LEN..bytes.len() {
        assert_eq!(refused(&bytes[..found]), SceneError::Length { found: found as u32, expected });
    }
    bytes.push(0);
    assert_eq!(refused(&bytes), SceneError::Length { found: expected + 1, expected });
    bytes.resize(bytes.len() - 1 + RECORD_LEN, 0);
    assert_eq!(refused(&bytes), SceneError::Length { found: expected + RECORD_LEN as u32, expected });
}

#[test]
fn the_largest_scene_is_read_and_a_larger_one_refused() {
    let record = samples::records()[0].write();
    let mut bytes = samples::header().write(RECORDS_MAX as u8).to_vec();
    bytes.extend(record.repeat(RECORDS_MAX));
    assert_eq!(bytes.len(), SCENE_MAX_LEN);
    assert_eq!(Scene::parse(&bytes).unwrap().records().count(), RECORDS_MAX);

    let mut bytes = samples::header().write(RECORDS_MAX as u8 + 1).to_vec();
    bytes.extend(record.repeat(RECORDS_MAX + 1));
    assert_eq!(refused(&bytes), SceneError::TooManyRecords { found: RECORDS_MAX as u8 + 1 });
}

#[test]
fn a_scene_without_layers_is_read() {
    let bytes = samples::header().write(0);
    let scene = Scene::parse(&bytes).unwrap();
    assert_eq!((*scene.header(), scene.record_count()), (samples::header(), 0));
}

#[test]
fn unknown_flags_and_carriers_are_refused() {
    for flags in 4..=u8::MAX {
        assert_eq!(refused(&changed(3, flags)), SceneError::UnknownFlags(flags));
    }
    for shape in 2..=u8::MAX {
        assert_eq!(refused(&changed(52, shape)), SceneError::UnknownCarrier(shape));
    }
}

/// Every value of kind, region, blend and wave is either refused by name or one that has golden bytes.
#[test]
fn unknown_choices_are_refused() {
    let golden: Vec<_> = samples::records().iter().map(Record::write).collect();
    for offset in 0..4 {
        let known: BTreeSet<u8> = golden.iter().map(|record| record[usize::from(offset)]).collect();
        for value in 0..=u8::MAX {
            // A record that uses everything: a grating on a rectangle.
            let mut record = golden[1];
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

/// Offsets of the bytes that a record uses, from the table in `PROTOCOL.md`.
fn used(record: &Record) -> BTreeSet<usize> {
    let mut used: BTreeSet<usize> = [0, 1, 2].into_iter().chain(20..24).collect();
    if matches!(record.region, Region::Rectangle { .. }) {
        used.extend(4..20);
    }
    match record.layer {
        Layer::Constant { .. } => used.extend(24..28),
        Layer::Grating { .. } => used.extend([3].into_iter().chain(24..44)),
        Layer::Bitmap { .. } => used.extend((24..44).chain(52..56)),
    }
    used
}

#[test]
fn bytes_that_nothing_uses_are_zero() {
    for record in samples::records() {
        for offset in 0..RECORD_LEN {
            let mut bytes = record.write();
            if used(&record).contains(&offset) {
                continue;
            }
            assert_eq!(bytes[offset], 0);
            bytes[offset] = 0x80;
            let refused = Record::parse(&bytes, 5);
            assert_eq!(refused, Err(SceneError::NotZero { record: 5, offset: offset as u8 }), "{record:?}");
        }
    }
    for offset in 53..HEADER_LEN {
        let not_zero = SceneError::NotZero { record: SceneError::HEADER, offset: offset as u8 };
        assert_eq!(refused(&changed(offset, 1)), not_zero);
    }
}

/// Every used byte matters: changing it changes the record or refuses it.
#[test]
fn bytes_that_something_uses_are_read() {
    for record in samples::records() {
        for offset in used(&record) {
            let mut bytes = record.write();
            bytes[offset] ^= 1;
            assert_ne!(Record::parse(&bytes, 0), Ok(record), "offset {offset} of {record:?}");
        }
    }
    for offset in 3..53 {
        let mut bytes = samples::header().write(0);
        bytes[offset] ^= 1;
        assert_ne!(Header::parse(&bytes), Ok((samples::header(), 0)), "offset {offset}");
    }
}

/// The record that is wrong is the one that is named.
#[test]
fn errors_name_the_record() {
    for number in 0..4u8 {
        let at = HEADER_LEN + usize::from(number) * RECORD_LEN;
        assert_eq!(refused(&changed(at, 0)), SceneError::UnknownKind { record: number, kind: 0 });
    }
}

/// Numbers are the board's to judge: any bits go through.
#[test]
fn any_number_goes_through() {
    for bits in [0x7fc0_0000, 0x7f80_0001, 0xffff_ffff, 0x7f80_0000, 0x8000_0000, 1] {
        let record = Record {
            region: Region::Screen,
            blend: Blend::Add,
            gain: f32::from_bits(bits),
            layer: Layer::Constant { electric_friction_n: f32::from_bits(bits) },
        };
        let read = Record::parse(&record.write(), 0).unwrap();
        assert_eq!(read.gain.to_bits(), bits);
    }
}
