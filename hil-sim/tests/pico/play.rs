//! From power-on to a play: the hello, what is on the wires, and what the finger feels.

use std::time::Duration;

use frixel_control::Drive;
use frixel_hil_sim::emulated::{Stamped, StartCause, WireEvent};
use frixel_wire::fault::State;
use frixel_wire::hello::{BoardKind, ResetCause};

use super::bench::{BOARD, Bench, CONSTANT, TICK};
use crate::emulator;

/// Longest time for which SYNC may be low. 24 clocks of 6.25 MHz take 3.84 us.
const FRAME_MAX: Duration = Duration::from_micros(5);
/// How far the distance of two frames may be from a tick: two cycles of the core.
const JITTER_MAX: Duration = Duration::from_nanos(10);

/// The ends of the frames among events. Each has 24 clocks.
fn frames(events: &[Stamped]) -> Vec<Duration> {
    let mut ends = Vec::new();
    for stamped in events {
        if let WireEvent::Frame { clocks, lasted, .. } = stamped.event {
            assert_eq!(clocks, 24, "at {:?}", stamped.at);
            assert!(lasted <= FRAME_MAX, "SYNC was low for {lasted:?} at {:?}", stamped.at);
            ends.push(stamped.at);
        }
    }
    ends
}

#[test]
fn after_power_on_the_board_says_hello_and_its_output_is_zero() {
    let Some(image) = emulator::pico_image() else { return };
    let bench = Bench::just_on(&image);
    let hello = *bench.connect().hello();
    assert_eq!((hello.board, hello.tick_hz), (BoardKind::Pico, BOARD.tick_hz));
    assert_eq!((hello.reset_cause, hello.last_fault, hello.state), (ResetCause::PowerOn, None, State::Disarmed));
    assert_eq!(hello.limits, BOARD.limits);
    bench.pass(Duration::from_millis(100));
    assert!(bench.take_records().iter().all(|record| record.drive == Drive::default()));
    let events = bench.take_events();
    assert_eq!(events[0].event, WireEvent::Start(StartCause::Power));
    assert!(!events.iter().any(|stamped| stamped.event == WireEvent::Enable(true)), "the enable stays low");
    assert!(frames(&events).len() > 1000);
}

#[test]
fn frames_come_at_every_beat_and_the_enable_is_high_from_the_first_kick_to_the_stop() {
    let Some(image) = emulator::pico_image() else { return };
    let bench = Bench::new(&image);
    let mut host = bench.play(CONSTANT);
    bench.take_events();
    host.wait(Duration::from_millis(100), &mut |_| ()).unwrap();
    let events = bench.take_events();
    let ends = frames(&events);
    assert!(ends.len() >= 799);
    for pair in ends.windows(2) {
        let apart = pair[1].saturating_sub(pair[0]).abs_diff(TICK);
        assert!(apart <= JITTER_MAX, "frames at {pair:?} are {apart:?} from a tick apart");
    }
    let edges = |events: &[Stamped]| -> Vec<WireEvent> {
        let is_edge = |event: &WireEvent| matches!(event, WireEvent::Enable(_) | WireEvent::Clear(_));
        events.iter().map(|stamped| stamped.event).filter(is_edge).collect()
    };
    assert_eq!(edges(&events), [], "the one-shot is kicked before it ends");
    host.stop().unwrap();
    bench.pass(10 * TICK);
    assert_eq!(edges(&bench.take_events()), [WireEvent::Enable(false), WireEvent::Clear(false)]);
    assert!(bench.with(|rig| rig.zero_since()).is_some());
}

#[test]
fn a_finger_feels_the_friction_that_the_scene_asks_for() {
    let Some(image) = emulator::pico_image() else { return };
    let bench = Bench::new(&image);
    let mut host = bench.play(CONSTANT);
    let law = super::bench::program(CONSTANT).header.friction_law().unwrap();
    bench.take_records();
    host.wait(Duration::from_millis(200), &mut |_| ()).unwrap();
    let records = bench.take_records();
    let mean_n = records.iter().map(|record| record.felt.electric_friction_n).sum::<f64>() / records.len() as f64;
    let reach_n = law.electric_friction_n(f64::from(super::bench::program(CONSTANT).header.voltage_max_v_rms));
    let error = mean_n / (0.9 * reach_n) - 1.0;
    // The edges of the carrier take a part of the mean square that varies with the tick rate's rounding.
    assert!(error.abs() < 0.02, "{mean_n} N is {error} from what was asked for");
}
