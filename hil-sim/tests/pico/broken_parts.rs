//! Parts around the board that are broken, late or missing.

use std::time::Duration;

use frixel_driver::{DeviceError, ignore_progress};
use frixel_hil_sim::emulated::BrokenInputs;
use frixel_wire::fault::{Fault, State};

use super::bench::{Bench, CONSTANT, Host, TICK, program};
use crate::emulator;

/// Ticks that read a broken part until its fault, by `docs/board/safety.md`: the ready line (two samples), the monitor
/// (0.4 ms) and the arm switch (0.8 ms).
const READY_TICKS: u32 = 2;
const MONITOR_TICKS: u32 = 3;
const SWITCH_TICKS: u32 = 6;
/// Instructions of a tick after which it has read monitor, ready line and switch.
const READ_AFTER: u32 = 2_000;

/// Longest time from a defect to zero output, for a fault at the last of `reading_ticks` ticks that read the part. The
/// first of these is the next tick. The last one computes no friction; it disables the amplifier and clears the DAC in
/// its first half.
fn zero_deadline(reading_ticks: u32) -> Duration {
    reading_ticks * TICK + TICK / 2
}

fn try_to_play(host: &mut Host) -> Result<(), DeviceError> {
    frixel_play::start(host, &program(CONSTANT), &mut ignore_progress)
}

/// Plays a scene, breaks a part, and expects a fault at the last of `reading_ticks` ticks that read it.
fn check_fault(broken: BrokenInputs, fault: Fault, reading_ticks: u32) {
    let Some(image) = emulator::pico_image() else { return };
    let bench = Bench::new(&image);
    let host = bench.play(CONSTANT);
    let begin = bench.with(|rig| {
        assert!(rig.run_instructions(READ_AFTER).unwrap());
        rig.broken = broken;
        rig.now()
    });
    bench.pass(Duration::from_millis(5));
    let zero_since = bench.with(|rig| rig.zero_since()).unwrap_or_else(|| panic!("{fault:?}: the output is not zero"));
    let late = zero_since.saturating_sub(begin);
    println!("{fault:?}: the output was zero after {late:?}");
    assert!(late <= zero_deadline(reading_ticks), "{fault:?}: the output was zero after {late:?}");
    drop(host);
    let hello = *bench.connect().hello();
    assert_eq!((hello.state, hello.last_fault), (State::Faulted, Some(fault)));
}

#[test]
fn a_ready_line_that_falls_stops_the_output() {
    check_fault(BrokenInputs { ready: Some(false), ..BrokenInputs::default() }, Fault::Amplifier, READY_TICKS);
}

#[test]
fn a_monitor_that_shows_nothing_stops_the_output() {
    let broken = BrokenInputs { monitor_v: Some(0.0), ..BrokenInputs::default() };
    check_fault(broken, Fault::Monitor, MONITOR_TICKS);
}

/// The correct readings after a single disturbed one compensate it, so that many of them do not add up. With a monitor
/// that is a tick late, no correct reading would be left to compensate them.
#[test]
fn a_monitor_that_is_disturbed_now_and_then_does_not_stop_the_output() {
    let Some(image) = emulator::pico_image() else { return };
    let bench = Bench::new(&image);
    let mut host = bench.play(CONSTANT);
    // A number of ticks that is not a multiple of a half period's: each tick of it is hit.
    for _ in 0..10 {
        bench.with(|rig| rig.broken.monitor_v = Some(0.0));
        bench.step();
        bench.with(|rig| rig.broken.monitor_v = None);
        host.wait(Duration::from_micros(5_125), &mut |_| ()).unwrap();
    }
    assert_eq!(bench.with(|rig| rig.zero_since()), None, "the board drives");
}

#[test]
fn a_switch_that_is_let_go_stops_the_output() {
    let broken = BrokenInputs { arm_switch: Some(false), ..BrokenInputs::default() };
    check_fault(broken, Fault::ArmSwitch, SWITCH_TICKS);
}

/// The firmware disables the amplifier by its pin, too.
#[test]
fn a_one_shot_that_hangs_does_not_hold_the_enable() {
    let Some(image) = emulator::pico_image() else { return };
    let bench = Bench::new(&image);
    let mut host = bench.play(CONSTANT);
    bench.with(|rig| rig.stop_one_shot().unwrap());
    host.stop().unwrap();
    bench.pass(4 * TICK);
    assert!(bench.with(|rig| rig.zero_since()).is_some(), "the enable is low, and the code zero");
}

/// A DAC without supply is a fault when the board arms; once powered, it plays.
#[test]
fn a_dac_that_is_powered_late_is_missed_at_first_and_plays_then() {
    let Some(image) = emulator::pico_image() else { return };
    let bench = Bench::just_on(&image);
    bench.with(|rig| rig.dac().supply(false));
    bench.pass(Duration::from_millis(60));
    let mut host = bench.connect();
    let _ = try_to_play(&mut host);
    host.wait(Duration::from_millis(20), &mut |_| ()).ok();
    drop(host);
    let mut host = bench.connect();
    assert_eq!((host.hello().state, host.hello().last_fault), (State::Faulted, Some(Fault::Dac)));
    assert!(bench.with(|rig| rig.zero_since()).is_some());

    bench.with(|rig| rig.dac().supply(true));
    host.clear_fault().unwrap();
    press_again(&bench);
    bench.start(&mut host, CONSTANT);
}

/// Lets the arm switch go, and presses it again.
fn press_again(bench: &Bench) {
    bench.with(|rig| rig.broken.arm_switch = Some(false));
    bench.pass(Duration::from_millis(10));
    bench.with(|rig| rig.broken.arm_switch = None);
    bench.pass(Duration::from_millis(40));
}
