//! A scene with a disabled kind or region is refused, and the error distinguishes it from an unknown one. Run it with
//! `cargo test -p frixel-layers --no-default-features --test disabled`.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "helpers of tests fail as tests do")]

use frixel_layers::{FEATURES, KIND_FEATURES, KindFeature, Record, Region, disabled_record};
use frixel_testkit::constant;
use frixel_wire::hello::feature;
use frixel_wire::scene::SceneError;

const RECORD: Record = constant(0.01);

#[test]
fn a_kind_is_read_or_known_to_be_disabled() {
    for KindFeature { number: kind, bit, .. } in KIND_FEATURES.iter().copied() {
        let mut bytes = RECORD.write();
        bytes[0] = kind;
        let found = Record::parse(&bytes, 3).err();
        let unknown = SceneError::UnknownKind { record: 3, kind };
        let is_on = FEATURES & bit == bit;
        assert_eq!(found == Some(unknown), !is_on, "kind {kind}: {found:?}");
        assert_eq!(disabled_record(&unknown), Some(3));
    }
    for kind in [0, 200, 255] {
        assert_eq!(disabled_record(&SceneError::UnknownKind { record: 3, kind }), None);
    }
}

#[test]
fn a_polygon_is_read_or_known_to_be_disabled() {
    let record = Record { region: Region::Polygon { first: 0, count: 3 }, ..RECORD };
    let unknown = SceneError::UnknownChoice { record: 3, offset: 1, value: 3 };
    let is_on = FEATURES & feature::POLYGON != 0;
    assert_eq!(Record::parse(&record.write(), 3).err(), (!is_on).then_some(unknown));
    assert_eq!(disabled_record(&unknown), Some(3));
    assert_eq!(disabled_record(&SceneError::UnknownChoice { record: 3, offset: 1, value: 4 }), None);
    assert_eq!(disabled_record(&SceneError::UnknownChoice { record: 3, offset: 3, value: 3 }), None);
}
