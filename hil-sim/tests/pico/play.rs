//! From power-on to a play: the hello, what is on the wires, and what the finger feels.

use std::time::Duration;

use frixel_control::Drive;
use frixel_driver::{DeviceError, Event, ignore_progress};
use frixel_hil_sim::emulated::{Stamped, StartCause, WireEvent};
use frixel_layers::Header;
use frixel_scene::Program;
use frixel_wire::fault::State;
use frixel_wire::hello::{BoardKind, BoardLimits, ResetCause};
use frixel_wire::message::{ConfigField, Refusal, TELEMETRY_MAX_HZ, telemetry_period_ticks};

use super::bench::{BOARD, Bench, CONSTANT, TICK, program_for};
use crate::emulator;

/// Longest time for which SYNC may be low. 24 clocks of 6.25 MHz take 3.84 us.
const FRAME_MAX: Duration = Duration::from_micros(5);
/// Largest deviation of the time between two frames from a tick: two cycles of the core.
const JITTER_MAX: Duration = Duration::from_nanos(10);
/// Longest time from a new code to the reading of the monitor. The ADC has sampled it 2 us before, or 4; the supervisor
/// tolerates 2 us of the newest code.
const MONITOR_READ_MAX: Duration = Duration::from_micros(4);

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
    assert_eq!(hello.limits, BOARD.limits, "those that are stored");
    bench.pass(Duration::from_millis(100));
    assert!(bench.take_records().iter().all(|record| record.drive == Drive::default()));
    let events = bench.take_events();
    assert_eq!(events[0].event, WireEvent::Start(StartCause::Power));
    assert!(!events.iter().any(|stamped| stamped.event == WireEvent::Enable(true)), "the enable stays low");
    assert!(frames(&events).len() > 1000);
}

#[test]
fn telemetry_comes_a_thousand_times_a_second() {
    let Some(image) = emulator::pico_image() else { return };
    let mut host = Bench::new(&image).play(CONSTANT);
    let period_ticks = telemetry_period_ticks(BOARD.tick_hz, TELEMETRY_MAX_HZ);
    let refused = host.subscribe(period_ticks - 1).unwrap_err();
    assert!(matches!(refused, DeviceError::Refused { refusal: Refusal::TelemetryTooFast { .. }, .. }), "{refused}");
    host.subscribe(period_ticks).unwrap();
    let mut messages = 0;
    let mut count = |event| messages += u32::from(matches!(event, Event::Telemetry(_)));
    host.wait(Duration::from_millis(100), &mut count).unwrap();
    assert!((99..=101).contains(&messages), "{messages}");
}

/// A board that has stored no limits was never measured.
#[test]
fn a_board_that_was_never_brought_up_drives_ten_volts_at_most() {
    let Some(image) = emulator::pico_image() else { return };
    let bench = Bench::factory_new(&image);
    bench.pass(Duration::from_millis(50));
    let mut host = bench.connect();
    let limits = host.hello().limits;
    assert_eq!(limits, BoardLimits { voltage_max_v_peak: 10.0, ..BOARD.limits });
    let within = program_for(CONSTANT, &limits);
    let above = Program { header: Header { voltage_max_v_peak: 10.5, ..within.header }, ..within.clone() };
    let refused = frixel_play::start(&mut host, &above, &mut ignore_progress).unwrap_err();
    let DeviceError::Refused { refusal: Refusal::Config(refusal), .. } = refused else { panic!("{refused:?}") };
    assert_eq!((refusal.field, refusal.max), (ConfigField::VoltagePeak, 10.0), "{refusal}");
    let records = bench.take_records();
    assert!(records.iter().all(|record| record.drive == Drive::default()), "a refused scene drives");

    bench.start_program(&mut host, &within);
    host.wait(Duration::from_millis(200), &mut |_| ()).unwrap();
    let codes = bench.take_records().into_iter().map(|record| record.drive.dac_code.bits().unsigned_abs());
    let largest_v = f32::from(codes.max().unwrap()) / f32::from(i16::MAX) * limits.full_scale_v_peak;
    assert!((9.0..=10.0).contains(&largest_v), "the largest voltage is {largest_v} V");
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

/// The monitor is compared with the code before the newest one, and the amplifier follows that within some 8 us. So it
/// is read soon after the newest code is out, whatever else the tick has to do.
#[test]
fn the_monitor_is_read_before_the_newest_code_has_moved_it() {
    let Some(image) = emulator::pico_image() else { return };
    let bench = Bench::new(&image);
    let mut host = bench.play(CONSTANT);
    bench.take_events();
    host.wait(Duration::from_millis(200), &mut |_| ()).unwrap();
    host.stop().unwrap();
    let late =
        |event: &WireEvent| if let WireEvent::MonitorRead { since_frame } = event { Some(*since_frame) } else { None };
    let reads: Vec<Duration> = bench.take_events().iter().filter_map(|stamped| late(&stamped.event)).collect();
    assert!(reads.len() >= 1_600, "{} reads", reads.len());
    let latest = reads.iter().max().unwrap();
    assert!(*latest <= MONITOR_READ_MAX, "the monitor is read {latest:?} after a code was latched");
}
