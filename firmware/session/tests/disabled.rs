//! What the firmware was built without is refused by name, and the rest plays.

use crate::support;

use frixel_layers::{
    Beat, Burst, Button, Click, Constant, Edge, Grating, Header, Layer, Noise, Point, Record, Region, Speed, Stream,
    Vibration, Wave, Waveform,
};
use frixel_wire::hello::feature;
use frixel_wire::message::{Command, ConfigRefusal, Refusal};
use support::{HEADER, Memory, TestBoard, bitmap, constant, record, scene, scene_with_points};

const GRATING: Layer = Layer::Grating(Grating {
    wave: Wave::Sine,
    cycles_per_m_x: 500.0,
    cycles_per_m_y: 0.0,
    phase_turns: 0.0,
    trough_n: 0.0,
    crest_n: 0.02,
});

/// A kind of layer is built in. Cargo builds tests with the features of all crates together.
fn has(feature: u32) -> bool {
    frixel_layers::FEATURES & feature != 0
}

#[test]
fn the_hello_tells_what_there_is() {
    let mut memory = Memory::new();
    let hello = TestBoard::new(&mut memory).hello();
    for (present, bit) in [
        (has(feature::GRATING), feature::GRATING),
        (has(feature::BITMAP), feature::BITMAP),
        (cfg!(feature = "sine-carrier"), feature::SINE_CARRIER),
        (cfg!(feature = "telemetry"), feature::TELEMETRY),
        (has(feature::NOISE), feature::NOISE),
        (has(feature::EDGE), feature::EDGE),
        (has(feature::VIBRATION), feature::VIBRATION),
        (has(feature::SPEED), feature::SPEED),
        (cfg!(feature = "stream"), feature::STREAM),
        (has(feature::POLYGON), feature::POLYGON),
    ] {
        assert_eq!(hello.features & bit != 0, present, "{bit:#x}");
    }
    assert_eq!(hello.limits.bitmap_pool_bytes > 0, has(feature::BITMAP));
}

#[test]
fn a_layer_plays_or_is_refused_by_its_number() {
    let mut memory = Memory::new();
    let mut board = TestBoard::new(&mut memory);
    board.hello();
    let records = [record(Layer::Constant(Constant { electric_friction_n: 0.01 })), record(GRATING)];
    let found = board.load(&scene(&HEADER, &records)).err();
    assert_eq!(found, (!has(feature::GRATING)).then_some(Refusal::FeatureDisabled { layer: 1 }));

    let found = board.load(&scene(&HEADER, &[record(bitmap(7))])).err();
    let expected =
        if has(feature::BITMAP) { Refusal::BitmapMissing { crc32: 7 } } else { Refusal::FeatureDisabled { layer: 0 } };
    assert_eq!(found, Some(expected));
}

#[test]
fn a_kind_plays_or_is_refused() {
    let mut memory = Memory::new();
    let mut board = TestBoard::new(&mut memory);
    board.hello();
    let click = Click { height_n: 0.01, decay_s: 0.02 };
    let noise =
        Layer::Noise(Noise { seed: 1, wavelength_min_m: 1e-3, wavelength_max_m: 4e-3, low_n: 0.0, high_n: 0.02 });
    let edge =
        Layer::Edge(Edge { x_m: 0.05, y_m: 0.05, angle_turns: 0.0, width_m: 2e-3, level_n: 0.0, ridge_n: 0.02, click });
    let button = Layer::Button(Button { rim_width_m: 2e-3, rim_n: 0.02, face_n: 0.0, click });
    let vibration = Layer::Vibration(Vibration {
        beat: Beat::Sine,
        frequency_hz: 80.0,
        low_n: 0.0,
        high_n: 0.02,
        burst: Burst { period_s: 0.5, on_s: 0.2, ramp_s: 0.1 },
    });
    let constant = Layer::Constant(Constant { electric_friction_n: 0.01 });
    let rectangle = Region::Rectangle { x_m: 0.01, y_m: 0.02, width_m: 0.03, height_m: 0.04 };
    let polygon = Region::Polygon { first: 0, count: 3 };
    for (there, region, layer) in [
        (has(feature::NOISE), Region::Screen, noise),
        (has(feature::EDGE), Region::Screen, edge),
        (has(feature::EDGE), rectangle, button),
        (has(feature::VIBRATION), Region::Screen, vibration),
        (has(feature::SPEED), Region::Screen, Layer::Speed(Speed { first: 0, count: 3 })),
        (has(feature::STREAM), Region::Screen, Layer::Stream(Stream { low_n: 0.0, high_n: 0.02 })),
        (has(feature::POLYGON), polygon, constant),
    ] {
        let records = [record(constant), Record { region, ..record(layer) }];
        let points = [(0.0, 0.0), (0.05, 0.0), (0.1, 0.05)].map(|(x, y)| Point { x, y });
        let found = board.load(&scene_with_points(&HEADER, &records, &points)).err();
        assert_eq!(found, (!there).then_some(Refusal::FeatureDisabled { layer: 1 }), "{layer:?}");
    }
}

#[test]
fn a_carrier_plays_or_is_refused() {
    let mut memory = Memory::new();
    let mut board = TestBoard::new(&mut memory);
    board.hello();
    let header = Header { waveform: Waveform::Sine, ..HEADER };
    let found = board.load(&scene(&header, &[record(Layer::Constant(Constant { electric_friction_n: 0.01 }))])).err();
    let refused = Refusal::FeatureDisabled { layer: ConfigRefusal::WHOLE_SCENE };
    assert_eq!(found, (!cfg!(feature = "sine-carrier")).then_some(refused));
    board.play(&constant(0.02));
    assert!(board.slide(2000)[1000..].iter().all(|drive| drive.dac_code.bits() != 0));
}

#[test]
fn commands_of_disabled_features_are_rejected() {
    let mut memory = Memory::new();
    let mut board = TestBoard::new(&mut memory);
    board.hello();
    let found = board.command(Command::UploadBitmap { width: 20, height: 10, crc32: 7 }).err();
    let full = Refusal::BitmapPoolFull { len: 200, free: 0 };
    assert_eq!(found, (!has(feature::BITMAP)).then_some(full));
    let found = board.command(Command::Subscribe { period_ticks: 40 }).err();
    assert_eq!(found, (!cfg!(feature = "telemetry")).then_some(Refusal::UnknownCommand));
    let found = board.command(Command::TickTimes).err();
    assert_eq!(found, (!cfg!(feature = "telemetry")).then_some(Refusal::UnknownCommand));
}
