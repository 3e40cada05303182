//! What the firmware was built without is refused by name, and the rest plays.

mod support;

use frixel_wire::hello::feature;
use frixel_wire::message::{Command, ConfigRefusal, Refusal};
use frixel_wire::scene::{Carrier, Header, Layer, Wave};
use support::{Desk, HEADER, Memory, constant, record, scene};

const GRATING: Layer = Layer::Grating {
    wave: Wave::Sine,
    cycles_per_m_x: 500.0,
    cycles_per_m_y: 0.0,
    phase_turns: 0.0,
    trough_n: 0.0,
    crest_n: 0.02,
};

#[test]
fn the_hello_tells_what_there_is() {
    let mut memory = Memory::new();
    let hello = Desk::new(&mut memory).greet();
    for (present, bit) in [
        (cfg!(feature = "grating"), feature::GRATING),
        (cfg!(feature = "bitmap"), feature::BITMAP),
        (cfg!(feature = "sine-carrier"), feature::SINE_CARRIER),
        (cfg!(feature = "telemetry"), feature::TELEMETRY),
    ] {
        assert_eq!(hello.features & bit != 0, present, "{bit:#x}");
    }
    assert_eq!(hello.limits.bitmap_pool_bytes > 0, cfg!(feature = "bitmap"));
}

#[test]
fn a_layer_plays_or_is_refused_by_its_number() {
    let mut memory = Memory::new();
    let mut desk = Desk::new(&mut memory);
    desk.greet();
    let records = [record(Layer::Constant { electric_friction_n: 0.01 }), record(GRATING)];
    let found = desk.load(&scene(&HEADER, &records)).err();
    assert_eq!(found, (!cfg!(feature = "grating")).then_some(Refusal::LeftOut { layer: 1 }));

    let bitmap = Layer::Bitmap { crc32: 7, x_m: 0.0, y_m: 0.0, pitch_m: 1e-3, black_n: 0.0, white_n: 0.02 };
    let found = desk.load(&scene(&HEADER, &[record(bitmap)])).err();
    let expected =
        if cfg!(feature = "bitmap") { Refusal::BitmapMissing { crc32: 7 } } else { Refusal::LeftOut { layer: 0 } };
    assert_eq!(found, Some(expected));
}

#[test]
fn a_carrier_plays_or_is_refused() {
    let mut memory = Memory::new();
    let mut desk = Desk::new(&mut memory);
    desk.greet();
    let header = Header { carrier: Carrier::Sine, ..HEADER };
    let found = desk.load(&scene(&header, &[record(Layer::Constant { electric_friction_n: 0.01 })])).err();
    let refused = Refusal::LeftOut { layer: ConfigRefusal::WHOLE_SCENE };
    assert_eq!(found, (!cfg!(feature = "sine-carrier")).then_some(refused));
    desk.play(&constant(0.02));
    assert!(desk.slide(2000)[1000..].iter().all(|drive| drive.dac_code != 0));
}

#[test]
fn commands_of_what_there_is_not_are_refused() {
    let mut memory = Memory::new();
    let mut desk = Desk::new(&mut memory);
    desk.greet();
    let found = desk.command(Command::UploadBitmap { width: 20, height: 10, crc32: 7 }).err();
    let full = Refusal::BitmapPoolFull { len: 200, free: 0 };
    assert_eq!(found, (!cfg!(feature = "bitmap")).then_some(full));
    let found = desk.command(Command::Subscribe { period_ticks: 40 }).err();
    assert_eq!(found, (!cfg!(feature = "telemetry")).then_some(Refusal::UnknownCommand));
}
