//! Scenes that need a disabled feature are refused by name, and all others play.

use crate::support::{HEADER, TestBoard, constant, constant_scene, scene, scene_with_points};
use frixel_layers::{BITMAP_POOL_LEN, FEATURES, Header, KIND_FEATURES, Record, Region, Waveform};
use frixel_testkit::samples::{POINTS, sample_records};
use frixel_wire::hello::feature;
use frixel_wire::message::{Command, ConfigRefusal, Refusal};

#[test]
fn the_hello_lists_the_enabled_features() {
    let hello = TestBoard::new().hello();
    let of_the_session = [
        (cfg!(feature = "sine-carrier"), feature::SINE_CARRIER),
        (cfg!(feature = "telemetry"), feature::TELEMETRY),
        (cfg!(feature = "stream"), feature::STREAM),
        (FEATURES & feature::POLYGON != 0, feature::POLYGON),
    ];
    let kinds = KIND_FEATURES.iter().filter(|kind| kind.bit != feature::STREAM);
    for (present, bit) in kinds.map(|kind| (FEATURES & kind.bit != 0, kind.bit)).chain(of_the_session) {
        assert_eq!(hello.features & bit != 0, present, "{bit:#x}");
    }
    assert_eq!(hello.limits.bitmap_pool_bytes > 0, BITMAP_POOL_LEN > 0);
}

/// A kind is enabled or refused: Cargo builds the workspace's tests with the features of all crates together.
#[test]
fn a_layer_plays_or_is_refused_by_its_number() {
    let mut board = TestBoard::connected();
    for sample in sample_records() {
        let Record { layer, region, .. } = sample.record;
        let needed = layer.feature() | if matches!(region, Region::Polygon { .. }) { feature::POLYGON } else { 0 };
        let records = [constant(0.01), sample.record];
        let found = board.load(&scene_with_points(&HEADER, &records, &POINTS)).err();
        let missing = layer.bitmap_crc32().map(|crc32| Refusal::BitmapMissing { crc32 });
        let is_there = FEATURES & needed == needed;
        assert_eq!(found, if is_there { missing } else { Some(Refusal::FeatureDisabled { layer: 1 }) }, "{layer:?}");
    }
}

#[test]
fn a_carrier_plays_or_is_refused() {
    let mut board = TestBoard::connected();
    let header = Header { waveform: Waveform::Sine, ..HEADER };
    let found = board.load(&scene(&header, &[constant(0.01)])).err();
    let refused = Refusal::FeatureDisabled { layer: ConfigRefusal::WHOLE_SCENE };
    assert_eq!(found, (!cfg!(feature = "sine-carrier")).then_some(refused));
    board.play(&constant_scene(0.02));
    assert!(board.slide(2000)[1000..].iter().all(|drive| drive.dac_code.bits() != 0));
}

#[test]
fn commands_of_disabled_features_are_rejected() {
    let mut board = TestBoard::connected();
    let found = board.command(Command::UploadBitmap { width: 20, height: 10, crc32: 7 }).err();
    let full = Refusal::BitmapPoolFull { len: 200, free: 0 };
    assert_eq!(found, (!cfg!(feature = "bitmap")).then_some(full));
    let found = board.command(Command::Subscribe { period_ticks: 40 }).err();
    assert_eq!(found, (!cfg!(feature = "telemetry")).then_some(Refusal::UnknownCommand));
    let found = board.command(Command::TickTimes).err();
    assert_eq!(found, (!cfg!(feature = "telemetry")).then_some(Refusal::UnknownCommand));
}
