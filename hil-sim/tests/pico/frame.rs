//! A board that takes the finger's place from an optical frame on I2C, with a frame that does not answer, holds the
//! bus, or stops in the middle of a report.

use std::time::Duration;

use frixel_driver::ignore_progress;
use frixel_hil_sim::chips::{HeldBus, Transfer};
use frixel_hil_sim::emulated::{Image, TouchFrame, WireEvent};
use frixel_hil_sim::{Point, Stroke, WorldConfig};
use frixel_wire::fault::State;

use super::bench::{BOARD, Bench, CONSTANT, Host, TICK, program};
use crate::emulator;

/// From the last report to zero: 40 ms until it is stale, the tick that begins meanwhile, and the one that puts out
/// zero.
const ZERO_WITHIN: Duration = Duration::from_millis(40).saturating_add(TICK.saturating_mul(2));
/// Time from a repaired frame to the drive: a pause of the driver of 100 ms, at most 50 until it has discarded waiting
/// messages, and 60 until reports have arrived.
const BACK_WITHIN: Duration = Duration::from_millis(210);
/// Time for which a frame is broken: two and a half pauses of the driver.
const BROKEN_FOR: Duration = Duration::from_millis(250);
/// Bytes of a report of one finger on the bus.
const REPORT_LEN: u32 = 21;
/// Distance of the finger from the top edge, m, and tolerance of its place.
const PLACE_Y_M: f32 = 0.03;
const PLACE_TOLERANCE_M: f32 = 1e-3;
/// Number of the order that is a track.
const TRACK: u32 = 1;

fn frame<R>(bench: &Bench, work: impl FnOnce(&mut TouchFrame) -> R) -> R {
    bench.with(|rig| work(rig.frame_mut().unwrap()))
}

/// A board that drives, under a finger that slides to and fro at `PLACE_Y_M`.
fn playing(image: &Image) -> (Bench, Host) {
    let [left, right] = [(60e-3, f64::from(PLACE_Y_M)), (116e-3, f64::from(PLACE_Y_M))];
    let [left, right] = [left, right].map(|(x_m, y_m)| Point { x_m, y_m });
    let stroke = Stroke::constant_speed(left, right, 0.1).unwrap().looped(0.02).unwrap();
    let bench = Bench::in_world_with_frame(image, &WorldConfig::of(&BOARD), stroke, 1);
    bench.with(|rig| assert!(rig.watch_orders().unwrap(), "the image names what takes orders"));
    let mut host = bench.connect();
    frixel_play::start(&mut host, &program(CONSTANT), &mut ignore_progress).unwrap();
    bench.with(|rig| rig.world_mut().start_stroke());
    comes_back(&bench, &mut host);
    (bench, host)
}

/// Waits until the board drives.
fn comes_back(bench: &Bench, host: &mut Host) {
    let begin = bench.now();
    while bench.with(|rig| rig.zero_since()).is_some() {
        let late = bench.now().saturating_sub(begin);
        assert!(late <= BACK_WITHIN, "nothing is driven for {late:?}");
        host.wait(TICK, &mut |_| ()).unwrap();
    }
}

/// Breaks the frame for a while: the output falls to zero in time and stays there, the board does not restart, and it
/// drives again once the frame is repaired. Returns the events on the wires while the frame was broken.
fn break_and_repair(
    bench: &Bench,
    host: &mut Host,
    breaks: impl FnOnce(&mut TouchFrame),
    repairs: impl FnOnce(&mut TouchFrame),
) -> Vec<WireEvent> {
    let (begin, starts) = bench.with(|rig| (rig.now(), rig.starts()));
    bench.take_events();
    frame(bench, breaks);
    host.wait(BROKEN_FOR, &mut |_| ()).unwrap();
    let zero_since = bench.with(|rig| rig.zero_since()).unwrap();
    let late = zero_since.saturating_sub(begin);
    println!("zero after {late:?}");
    assert!(late <= ZERO_WITHIN, "the output was zero after {late:?}");
    let events = bench.take_events().into_iter().map(|stamped| stamped.event).collect();
    frame(bench, repairs);
    let begin = bench.now();
    comes_back(bench, host);
    println!("back after {:?}", bench.now().saturating_sub(begin));
    assert_eq!(bench.with(|rig| rig.starts()), starts, "the board has started again");
    events
}

/// Every track lies on the finger's line, and the board has no fault.
fn has_stayed_on_the_line(bench: &Bench, host: Host) {
    let watched = bench.with(|rig| rig.take_watched().unwrap());
    let tracks: Vec<_> = watched.orders.iter().filter(|order| order.words[0] == TRACK).collect();
    assert!(!tracks.is_empty());
    for track in tracks {
        let places = track.words[1..].iter().map(|word| f32::from_bits(*word));
        let is_there = places.clone().any(|place_m| (place_m - PLACE_Y_M).abs() <= PLACE_TOLERANCE_M);
        assert!(is_there, "no finger was at {:?}", places.collect::<Vec<_>>());
    }
    drop(host);
    // A new client disarms the board.
    let hello = *bench.connect().hello();
    assert_eq!((hello.state, hello.last_fault), (State::Disarmed, None));
}

fn count(events: &[WireEvent], event: WireEvent) -> usize {
    events.iter().filter(|other| **other == event).count()
}

#[test]
fn a_frame_that_does_not_acknowledge_stops_the_output_until_it_does() {
    let Some(image) = emulator::pico_image_with_frame() else { return };
    let (bench, mut host) = playing(&image);
    let events = break_and_repair(
        &bench,
        &mut host,
        |frame| frame.module().connect(false),
        |frame| frame.module().connect(true),
    );
    let asked = events.iter().filter(|event| matches!(event, WireEvent::I2cAddress { .. })).count();
    assert!((2..=3).contains(&asked), "it is asked again every 0.1 s, not {asked} times");
    has_stayed_on_the_line(&bench, host);
}

#[test]
fn a_board_without_its_frame_is_there_and_drives_nothing() {
    let Some(image) = emulator::pico_image_with_frame() else { return };
    let bench = Bench::just_on_with_frame(&image);
    frame(&bench, |frame| frame.module().connect(false));
    bench.pass(Duration::from_millis(60));
    let mut host = bench.connect();
    frixel_play::start(&mut host, &program(CONSTANT), &mut ignore_progress).unwrap();
    bench.with(|rig| rig.world_mut().start_stroke());
    host.wait(BROKEN_FOR, &mut |_| ()).unwrap();
    assert_eq!(bench.with(|rig| rig.zero_since()), Some(Duration::ZERO));
    frame(&bench, |frame| frame.module().connect(true));
    comes_back(&bench, &mut host);
}

#[test]
fn a_clock_that_is_held_stops_the_output_until_it_is_released() {
    let Some(image) = emulator::pico_image_with_frame() else { return };
    let (bench, mut host) = playing(&image);
    break_and_repair(&bench, &mut host, |frame| frame.holds_scl = true, |frame| frame.holds_scl = false);
    reads_a_report(&bench, &mut host);
    break_and_repair(&bench, &mut host, |frame| frame.holds_scl = true, |frame| frame.holds_scl = false);
    has_stayed_on_the_line(&bench, host);
}

/// Waits until the board is in the middle of a report.
fn reads_a_report(bench: &Bench, host: &mut Host) {
    let begin = bench.now();
    while !is_reading(bench) {
        assert!(bench.now().saturating_sub(begin) <= BACK_WITHIN, "no report is read");
        host.wait(TICK, &mut |_| ()).unwrap();
    }
}

/// Whether a byte was read in the last tick, and the transfer has not ended.
fn is_reading(bench: &Bench) -> bool {
    matches!(bench.take_events().iter().rev().map(|stamped| stamped.event).find(is_on_i2c), Some(WireEvent::I2cRead))
}

fn is_on_i2c(event: &WireEvent) -> bool {
    matches!(event, WireEvent::I2cAddress { .. } | WireEvent::I2cWrite(_) | WireEvent::I2cRead | WireEvent::I2cStop)
}

#[test]
fn a_short_of_the_data_line_stops_the_output_until_it_is_gone() {
    let Some(image) = emulator::pico_image_with_frame() else { return };
    let (bench, mut host) = playing(&image);
    let short = HeldBus::new(Transfer::Idle, 0);
    short.short_sda();
    let breaks = |frame: &mut TouchFrame| frame.holds_sda = Some(short.clone());
    let events = break_and_repair(&bench, &mut host, breaks, |frame| frame.holds_sda = None);
    let tries = short.pulses() / 9;
    assert!((2..=3).contains(&tries) && short.pulses().is_multiple_of(9), "{} clocks", short.pulses());
    assert_eq!(count(&events, WireEvent::Scl(true)), short.pulses() as usize);
    reads_a_report(&bench, &mut host);
    break_and_repair(&bench, &mut host, breaks, |frame| frame.holds_sda = None);
    has_stayed_on_the_line(&bench, host);
}

/// A frame that was left in the middle of a byte: by a disturbance of the clock, or by a reset of the board.
#[test]
fn a_frame_that_holds_the_data_line_is_freed_by_clocks() {
    let Some(image) = emulator::pico_image_with_frame() else { return };
    for (transfer, clock, resets) in [(Transfer::Sends(0), 4, false), (Transfer::Receives, 8, true)] {
        let (bench, mut host) = playing(&image);
        let left = HeldBus::new(transfer, clock);
        frame(&bench, |frame| frame.holds_sda = Some(left.clone()));
        if resets {
            drop(host);
            bench.with(|rig| rig.pull_run_pin().unwrap());
            bench.pass(Duration::from_millis(150));
            host = bench.connect();
            assert!(frame(&bench, |frame| frame.module().frequency_hz()).is_some());
        } else {
            host.wait(BACK_WITHIN, &mut |_| ()).unwrap();
            // The clocks come before a report is missed.
            assert_eq!(bench.with(|rig| rig.zero_since()), None, "the board drives on");
        }
        assert!((1..=9).contains(&left.pulses()), "{transfer:?}: {} clocks", left.pulses());
        if !resets {
            has_stayed_on_the_line(&bench, host);
        }
    }
}

/// The frame restarts after any byte of a report, of which the board reads the rest from a released bus.
#[test]
fn a_report_that_is_cut_off_moves_no_finger() {
    let Some(image) = emulator::pico_image_with_frame() else { return };
    let (bench, mut host) = playing(&image);
    for bytes in 0..REPORT_LEN {
        // Wait until the set-up after a restart is over, so that a report is cut off.
        let begin = bench.now();
        while frame(&bench, |frame| !frame.module().is_enabled() || frame.module().waiting() > 0) {
            assert!(bench.now().saturating_sub(begin) <= BACK_WITHIN, "the frame is not set up");
            host.wait(TICK, &mut |_| ()).unwrap();
        }
        frame(&bench, |frame| frame.restarts_after = Some(bytes));
        let begin = bench.now();
        while frame(&bench, |frame| frame.restarts_after).is_some() {
            let late = bench.now().saturating_sub(begin);
            assert!(late <= BACK_WITHIN, "no report of {bytes} bytes is read for {late:?}");
            host.wait(TICK, &mut |_| ()).unwrap();
        }
    }
    comes_back(&bench, &mut host);
    has_stayed_on_the_line(&bench, host);
}
