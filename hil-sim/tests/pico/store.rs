//! The power is cut while a scene is stored: the next start has the old scene or the new one.

use std::ops::ControlFlow;
use std::time::Duration;

use frixel_hil_sim::emulated::{Image, WireEvent};
use frixel_scene::Program;
use frixel_testkit::Random;
use frixel_wire::fault::State;
use frixel_wire::frame::crc32;

use super::bench::{Bench, CONSTANT, WEAKER, program};
use crate::emulator;

/// A scene is stored 2 s after its commit on a board that is disarmed, and erasing a sector takes 45 ms.
const STORED_AFTER: Duration = Duration::from_millis(2_800);
/// The watchdog's time, by the emulator's ring oscillator.
const WATCHDOG_MAX: Duration = Duration::from_millis(930);
/// Time to start.
const START: Duration = Duration::from_millis(30);

/// Uploads a scene, and waits until it is stored, or the power has been cut meanwhile.
fn store(bench: &Bench, text: &str) {
    let mut host = bench.connect();
    frixel_play::load(&mut host, &program(text), &mut |_| ControlFlow::Continue(())).unwrap();
    drop(host);
    bench.pass(STORED_AFTER);
}

/// A scene that takes more than one sector of the flash, each of which takes 45 ms to erase.
fn large() -> Program {
    let layer = |index: u32| {
        let (x_mm, y_mm) = (12 * (index % 9), 10 * (index / 9));
        format!(
            "[[layer]]\nkind = \"constant\"\nfriction_fraction = 0.1\n\
             region = {{ x_mm = {x_mm}, y_mm = {y_mm}, width_mm = 5, height_mm = 5 }}\n"
        )
    };
    program(&(0..60).map(layer).fold("version = 2\n".to_owned(), |text, layer| text + &layer))
}

fn crc32_of(text: &str) -> u32 {
    crc32(&program(text).scene_bytes())
}

fn scene_crc32(bench: &Bench) -> u32 {
    let hello = *bench.connect().hello();
    assert_eq!(hello.state, State::Disarmed);
    hello.scene_crc32
}

/// A board that has stored a scene, and the flash operations that storing another one takes.
fn stored(image: &Image) -> (Bench, u32) {
    let bench = Bench::just_on(image);
    bench.pass(START);
    store(&bench, CONSTANT);
    let operations =
        bench.take_events().iter().filter(|stamped| matches!(stamped.event, WireEvent::Flash { .. })).count();
    assert!(operations > 2, "the scene was stored in {operations} operations");
    bench.with(|rig| rig.power_cycle(1).unwrap());
    bench.pass(START);
    (bench, operations as u32)
}

/// Cuts the power at operations of stores, the first one being 0; `choose` gets the number of operations of a store.
/// The scene that the board does not have is the one that it is given next.
fn cut_at(image: &Image, choose: impl FnOnce(u32) -> Vec<u32>) {
    let crc32s = [CONSTANT, WEAKER].map(crc32_of);
    let (bench, operations) = stored(image);
    let mut random = Random::new(11);
    let mut old = scene_crc32(&bench);
    assert_eq!(old, crc32s[0]);
    for operation in choose(operations) {
        let starts = bench.with(|rig| {
            rig.cut_at_flash_operation(operation, f64::from(random.below(1000)) / 1000.0).unwrap();
            rig.starts()
        });
        store(&bench, if old == crc32s[0] { WEAKER } else { CONSTANT });
        assert_eq!(bench.with(|rig| rig.starts()), starts + 1, "the power was cut at operation {operation}");
        let found = scene_crc32(&bench);
        assert!(crc32s.contains(&found), "after a cut at operation {operation} the scene is {found:#x}");
        old = found;
        println!("operation {} of {operations}: the board has the old scene or the new one", operation + 1);
        bench.with(|rig| rig.power_cycle(operation).unwrap());
        bench.pass(START);
    }
}

#[test]
fn a_power_cut_while_a_scene_is_stored_leaves_the_old_scene_or_the_new_one() {
    let Some(image) = emulator::pico_image() else { return };
    cut_at(&image, |operations| vec![0, operations / 2, operations - 1]);
}

#[test]
#[ignore = "takes minutes: `cargo xtask soak pico`"]
fn a_power_cut_at_any_operation_of_the_flash_leaves_the_old_scene_or_the_new_one() {
    let Some(image) = emulator::pico_image() else { return };
    cut_at(&image, |operations| (0..operations).collect());
}

/// Each operation of a store feeds the watchdog; without ticks, none does. One that did would put off the reset by the
/// time of an erasure at least.
#[test]
fn a_tick_that_stands_still_while_a_scene_is_stored_resets_the_board() {
    let Some(image) = emulator::pico_image() else { return };
    let bench = Bench::just_on(&image);
    bench.pass(START);
    let mut host = bench.connect();
    frixel_play::load(&mut host, &large(), &mut |_| ControlFlow::Continue(())).unwrap();
    drop(host);
    let operations = || {
        let events = bench.take_events();
        events.iter().filter(|stamped| matches!(stamped.event, WireEvent::Flash { .. })).count()
    };
    bench.pass(Duration::from_millis(100));
    operations();
    while operations() == 0 {
        bench.step();
    }
    let (begin, starts) = bench.with(|rig| {
        rig.stop_beat().unwrap();
        (rig.now(), rig.starts())
    });
    while bench.with(|rig| rig.starts()) == starts {
        bench.step();
        let late = bench.now().saturating_sub(begin);
        assert!(late < WATCHDOG_MAX, "the board was not reset for {late:?}");
    }
    assert!(operations() > 1, "the main loop went on to store");
}

#[test]
fn a_stored_scene_is_there_after_the_next_start() {
    let Some(image) = emulator::pico_image() else { return };
    let (bench, _) = stored(&image);
    assert_eq!(scene_crc32(&bench), crc32_of(CONSTANT));
}
