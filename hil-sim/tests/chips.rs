//! The drivers of `frixel-drivers` against models of their chips.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "helpers of tests fail as tests do")]

use std::cell::Cell;
use std::collections::VecDeque;
use std::convert::Infallible;
use std::pin::pin;
use std::task::Poll;

use embedded_hal::delay::DelayNs;
use embedded_hal::digital::OutputPin;
use embedded_hal::spi::SpiDevice;
use embedded_io::{ErrorType, Read, ReadReady, Write, WriteReady};
use frixel_drivers::ad5761r::{self, Ad5761r};
use frixel_drivers::amplifier::{Amplifier, KickedEnable};
use frixel_drivers::arm_switch::ArmSwitch;
use frixel_drivers::bus_handover::BusHandover;
use frixel_drivers::i2c_bus_clear::clear_bus;
use frixel_drivers::polling::poll_once;
use frixel_drivers::serial::SerialLink;
use frixel_drivers::state_light::StateLight;
use frixel_drivers::zforce::{self, Touch, ZForce};
use frixel_hil_sim::chips::{
    Ad5761rChip, BouncingContact, BusFault, ChipDelay, ChipSpi, HeldBus, PolledDelay, TouchEvent, Transfer,
    ZForceModule,
};
use frixel_wire::dac_code::DacCode;
use frixel_wire::fault::State;

const TICK_HZ: u32 = 40_000;
/// A step of the DAC, in volts.
const STEP_V: f64 = 10.0 / 32_768.0;

fn dac(chip: &Ad5761rChip) -> Ad5761r<ChipSpi, ChipDelay> {
    Ad5761r::new(chip.spi(), chip.delay())
}

/// A frame that the tick sends by hardware of its own.
fn tick_frame(chip: &Ad5761rChip, code: i16) {
    chip.spi().write(&ad5761r::output(DacCode::from_bits(code))).unwrap();
}

#[test]
fn codes_are_volts_once_the_dac_is_prepared() {
    let chip = Ad5761rChip::new();
    tick_frame(&chip, 16_384);
    assert!(chip.output_v().abs() < f64::EPSILON, "clamped until it is configured");
    let mut dac = dac(&chip);
    dac.prepare().unwrap();
    assert!(chip.output_v().abs() < f64::EPSILON);
    for code in [i16::MIN, -i16::MAX, -16_384, -1, 0, 1, 16_384, i16::MAX] {
        tick_frame(&chip, code);
        assert!((chip.output_v() - f64::from(code) * STEP_V).abs() < 1e-9, "{code}: {} V", chip.output_v());
        dac.check().unwrap();
    }
}

#[test]
fn preparing_sets_the_output_to_zero() {
    let chip = Ad5761rChip::new();
    let mut dac = dac(&chip);
    dac.prepare().unwrap();
    tick_frame(&chip, 30_000);
    dac.prepare().unwrap();
    assert!(chip.output_v().abs() < f64::EPSILON);
}

#[test]
fn the_falling_edge_of_clear_sets_the_output_to_zero() {
    let chip = Ad5761rChip::new();
    dac(&chip).prepare().unwrap();
    tick_frame(&chip, 30_000);
    chip.set_clear(false);
    assert!(chip.output_v().abs() < f64::EPSILON);
}

/// Without configuration, zero in two's complement would be minus full scale in straight binary.
#[test]
fn a_dac_that_lost_its_configuration_is_noticed_and_configured_again() {
    let chip = Ad5761rChip::new();
    let mut dac = dac(&chip);
    dac.prepare().unwrap();
    chip.supply(false);
    chip.supply(true);
    assert!(matches!(dac.check(), Err(ad5761r::Error::Configuration(_))));
    tick_frame(&chip, 16_384);
    assert!(chip.output_v().abs() < f64::EPSILON);
    dac.prepare().unwrap();
    tick_frame(&chip, 16_384);
    assert!((chip.output_v() - 5.0).abs() < 1e-9);
}

#[test]
fn a_dac_that_does_not_answer_is_an_error() {
    let chip = Ad5761rChip::new();
    chip.supply(false);
    let error = dac(&chip).prepare().unwrap_err();
    assert!(matches!(error, ad5761r::Error::Configuration(_)), "{error}");
    chip.supply(true);
    chip.connect_sdo(false);
    let error = dac(&chip).prepare().unwrap_err();
    assert_eq!(error.detail(), 0xffff);
    chip.connect_sdo(true);
    dac(&chip).prepare().unwrap();
}

#[test]
fn a_brown_out_is_reported_until_the_dac_is_prepared_again() {
    let chip = Ad5761rChip::new();
    let mut dac = dac(&chip);
    dac.prepare().unwrap();
    chip.brown_out();
    assert!(matches!(dac.check(), Err(ad5761r::Error::BrownOut(_))));
    dac.prepare().unwrap();
}

#[test]
fn a_short_circuit_is_reported_as_long_as_it_lasts() {
    let chip = Ad5761rChip::new();
    let mut dac = dac(&chip);
    chip.short_circuit(true);
    assert!(matches!(dac.prepare(), Err(ad5761r::Error::ShortCircuit(_))));
    chip.short_circuit(false);
    dac.prepare().unwrap();
}

/// Time from a panic until the DAC must be at zero.
const ZERO_WITHIN_NS: u64 = 30_000;

/// What happens on the DAC's wires in a period of the tick.
#[derive(Clone, Copy, Debug)]
enum Edge {
    SyncLow,
    Clock(bool),
    /// The timer's edge; it does not reach the wire once software has taken the pin.
    SyncHigh,
}

/// The edges of a period of 25 us with a frame, with their times: the tick begins the frame after 5 us at 21.25 MHz, and
/// the timer latches it after 24.1 us. DMA sends the clocks, whatever the processor does meanwhile.
fn period(code: i16) -> Vec<(u64, Edge)> {
    let [address, high, low] = ad5761r::output(DacCode::from_bits(code));
    let bits = u32::from_be_bytes([0, address, high, low]);
    let mut edges = vec![(5_000, Edge::SyncLow)];
    edges.extend((0..24).map(|clock| (5_100 + 47 * clock, Edge::Clock(bits >> (23 - clock) & 1 != 0))));
    edges.push((24_118, Edge::SyncHigh));
    edges
}

fn apply(chip: &Ad5761rChip, edge: Edge) {
    match edge {
        Edge::SyncLow => chip.set_sync(false),
        Edge::Clock(bit) => chip.clock(bit),
        Edge::SyncHigh => chip.set_sync(true),
    }
}

fn wait_until(chip: &Ad5761rChip, at_ns: u64) {
    chip.delay().delay_ns(u32::try_from(at_ns.saturating_sub(chip.now_ns())).unwrap());
}

/// A prepared DAC that has put a code out, in the middle of a frame with the next code: the first `edges_before` edges of
/// a period have occurred, and `part` of the time until the following one has passed. Returns the edges to come, too.
fn in_mid_frame(edges_before: usize, part: f64) -> (Ad5761rChip, Vec<(u64, Edge)>) {
    let chip = Ad5761rChip::new();
    dac(&chip).prepare().unwrap();
    tick_frame(&chip, 30_000);
    let from_ns = chip.now_ns();
    let mut edges: Vec<_> = period(-30_000).into_iter().map(|(at_ns, edge)| (from_ns + at_ns, edge)).collect();
    let to_come = edges.split_off(edges_before);
    for (at_ns, edge) in edges {
        wait_until(&chip, at_ns);
        apply(&chip, edge);
    }
    let next_ns = to_come.first().map_or(from_ns + 25_000, |(at_ns, _)| *at_ns);
    wait_until(&chip, chip.now_ns() + ((next_ns - chip.now_ns()) as f64 * part) as u64);
    (chip, to_come)
}

/// Every phase of a period: before and after each edge, and between.
fn phases() -> impl Iterator<Item = (usize, f64)> {
    (0..=period(0).len()).flat_map(|edges_before| [0.0, 0.5, 1.0].map(|part| (edges_before, part)))
}

/// The clocks that DMA still sends, while software has the pins.
fn send_rest(chip: &Ad5761rChip, to_come: &[(u64, Edge)]) {
    for (at_ns, edge) in to_come {
        if matches!(edge, Edge::Clock(_)) {
            wait_until(chip, *at_ns);
            apply(chip, *edge);
        }
    }
}

#[test]
fn a_panic_at_any_phase_of_a_frame_puts_the_dac_at_zero_within_30_us() {
    for phase in phases() {
        let (chip, to_come) = in_mid_frame(phase.0, phase.1);
        let (from_ns, from_v) = (chip.now_ns(), chip.output_v());
        assert!(from_v.abs() > 9.0, "{phase:?}");
        let mut enable = OneShot { left_ticks: 1 };
        ad5761r::zero_output(&mut &mut enable, &mut chip.sync_pin(), &mut chip.clear_pin());
        send_rest(&chip, &to_come);
        wait_until(&chip, from_ns + 100_000);
        assert!(chip.output_v().abs() < f64::EPSILON, "{phase:?}: {} V", chip.output_v());
        assert!(chip.settled_at_ns() - from_ns <= ZERO_WITHIN_NS, "{phase:?}: {} ns", chip.settled_at_ns() - from_ns);
        assert_eq!(enable.left_ticks, 0);
    }
}

/// The amplifier is disabled before the frame in flight is put out.
#[test]
fn the_amplifier_is_disabled_before_the_dac_changes() {
    struct Enable<'a>(&'a Ad5761rChip, Option<(u64, f64)>);
    impl embedded_hal::digital::ErrorType for Enable<'_> {
        type Error = Infallible;
    }
    impl OutputPin for Enable<'_> {
        fn set_low(&mut self) -> Result<(), Infallible> {
            self.1 = Some((self.0.now_ns(), self.0.output_v()));
            Ok(())
        }
        fn set_high(&mut self) -> Result<(), Infallible> {
            panic!("enabled")
        }
    }
    for phase in phases() {
        let (chip, _) = in_mid_frame(phase.0, phase.1);
        let at_panic = (chip.now_ns(), chip.output_v());
        let mut enable = Enable(&chip, None);
        ad5761r::zero_output(&mut enable, &mut chip.sync_pin(), &mut chip.clear_pin());
        assert_eq!(enable.1, Some(at_panic), "{phase:?}");
    }
}

/// What [`ad5761r::zero_output`] is for: a complete frame is latched when SYNC rises after CLEAR has fallen.
#[test]
fn a_frame_that_is_latched_after_clear_puts_its_code_out() {
    let stays_at_zero = |edges_before| {
        let (chip, _) = in_mid_frame(edges_before, 0.5);
        chip.set_clear(false);
        assert!(chip.output_v().abs() < f64::EPSILON);
        chip.set_sync(true);
        chip.output_v().abs() < f64::EPSILON
    };
    assert_eq!((0..=25).filter(|edges| !stays_at_zero(*edges)).collect::<Vec<_>>(), [25], "SYNC low and 24 clocks");
}

/// In reset the pins float: one resistor pulls SYNC up, another CLEAR down, whichever comes first.
#[test]
fn a_reset_at_any_phase_of_a_frame_leaves_the_dac_at_zero_once_the_board_starts() {
    let mut kept_a_code = 0;
    for phase in phases() {
        for clear_first in [false, true] {
            let (chip, to_come) = in_mid_frame(phase.0, phase.1);
            if clear_first {
                chip.set_clear(false);
                chip.set_sync(true);
            } else {
                chip.set_sync(true);
                chip.set_clear(false);
            }
            kept_a_code += usize::from(chip.output_v().abs() > 9.0);
            // The clock's wire floats, too.
            send_rest(&chip, &to_come);
            let from_ns = chip.now_ns();
            let mut enable = OneShot::default();
            ad5761r::zero_output(&mut &mut enable, &mut chip.sync_pin(), &mut chip.clear_pin());
            assert!(chip.output_v().abs() < f64::EPSILON, "{phase:?}, {clear_first}: {} V", chip.output_v());
            assert!(chip.settled_at_ns() <= from_ns + ZERO_WITHIN_NS, "{phase:?}, {clear_first}");
            dac(&chip).prepare().unwrap();
            assert!(chip.output_v().abs() < f64::EPSILON);
        }
    }
    assert!(kept_a_code > 0, "the pull-downs alone do not put the DAC at zero");
}

/// The one-shot has let CLEAR fall before the panic, so that the panic must make an edge.
#[test]
fn a_dac_whose_clear_is_low_already_is_set_to_zero() {
    let chip = Ad5761rChip::new();
    dac(&chip).prepare().unwrap();
    chip.set_clear(false);
    tick_frame(&chip, 30_000);
    assert!(chip.output_v() > 9.0);
    ad5761r::zero_output(&mut &mut OneShot::default(), &mut chip.sync_pin(), &mut chip.clear_pin());
    assert!(chip.output_v().abs() < f64::EPSILON);
}

#[test]
fn a_frame_that_is_cut_short_is_ignored_and_of_a_longer_one_the_last_24_bits_count() {
    let code = |bits: &[bool]| {
        let chip = Ad5761rChip::new();
        dac(&chip).prepare().unwrap();
        chip.set_sync(false);
        for bit in bits {
            chip.clock(*bit);
        }
        chip.set_sync(true);
        chip.output_v()
    };
    let frame: Vec<bool> = period(30_000)
        .into_iter()
        .filter_map(|(_, edge)| if let Edge::Clock(bit) = edge { Some(bit) } else { None })
        .collect();
    assert!((code(&frame) - 30_000.0 * STEP_V).abs() < 1e-9);
    for cut in 0..24 {
        assert!(code(&frame[..cut]).abs() < f64::EPSILON, "{cut} clocks");
    }
    for extra in 1..50 {
        let longer: Vec<bool> = vec![true; extra].into_iter().chain(frame.iter().copied()).collect();
        assert!((code(&longer) - 30_000.0 * STEP_V).abs() < 1e-9, "{extra} more clocks");
    }
}

/// A supply that dips between Arm and Play: the DAC is read back before it plays.
#[test]
fn a_dac_that_lost_its_configuration_while_armed_is_found_before_play() {
    let chip = Ad5761rChip::new();
    let mut dac = dac(&chip);
    let bus = BusHandover::new();
    let bus = &bus;
    let ticks = || move || _ = bus.tick_sends(true);
    bus.while_frames_rest(ticks(), || dac.prepare()).unwrap();
    bus.while_frames_rest(ticks(), || dac.check()).unwrap();
    chip.brown_out();
    assert!(matches!(bus.while_frames_rest(ticks(), || dac.check()), Err(ad5761r::Error::BrownOut(_))));
    bus.while_frames_rest(ticks(), || dac.prepare()).unwrap();
    chip.supply(false);
    chip.supply(true);
    assert!(matches!(bus.while_frames_rest(ticks(), || dac.check()), Err(ad5761r::Error::Configuration(_))));
    assert!(chip.output_v().abs() < f64::EPSILON);
}

/// Before it arms, the main loop configures the DAC and reads it back in the middle of the tick's frames.
#[test]
fn the_dac_is_prepared_between_the_frames_of_the_tick() {
    let chip = Ad5761rChip::new();
    let mut dac = dac(&chip);
    let bus = BusHandover::new();
    let frames = Cell::new(0);
    let tick = || {
        if bus.tick_sends(true) {
            tick_frame(&chip, 0);
            frames.set(frames.get() + 1);
        }
    };
    tick();
    let mut polls = 0;
    let poll = || {
        tick();
        polls += 1;
        assert!(polls < 10, "the main loop waits in vain");
    };
    let prepared = bus.while_frames_rest(poll, || {
        let before = frames.get();
        tick();
        dac.read_control().unwrap();
        tick();
        let prepared = dac.prepare();
        assert_eq!(frames.get(), before, "the tick sent a frame in between");
        prepared
    });
    assert_eq!(prepared, Ok(()));
    let before = frames.get();
    tick();
    assert_eq!(frames.get(), before + 1);
    tick_frame(&chip, 16_384);
    assert!((chip.output_v() - 5.0).abs() < 1e-9);
}

/// Polls until the future is ready, at most so many times.
fn poll_for<F: Future>(mut future: std::pin::Pin<&mut F>, polls: usize) -> Option<F::Output> {
    (0..polls).find_map(|_| match poll_once(future.as_mut()) {
        Poll::Ready(output) => Some(output),
        Poll::Pending => None,
    })
}

#[test]
fn the_touch_frame_is_set_up_and_reports_fingers() {
    let module = ZForceModule::new(3);
    let mut frame = ZForce::new(module.bus(), module.data_ready(), PolledDelay);
    {
        let mut touch = pin!(frame.next_touch());
        assert!(poll_for(touch.as_mut(), 1000).is_none(), "nobody touches it");
        assert_eq!(module.frequency_hz(), Some(200));
        module.touch(TouchEvent::Invalid, 1, 1);
        module.touch(TouchEvent::Down, 1234, 56);
        let Some(Ok(Touch::Down { x_m, y_m })) = poll_for(touch, 1000) else { panic!("no report") };
        assert!((x_m - 0.1234).abs() < 1e-6 && (y_m - 0.0056).abs() < 1e-6);
    }
    module.touch(TouchEvent::Move, 2000, 0);
    module.touch(TouchEvent::Up, 2000, 0);
    assert!(matches!(poll_for(pin!(frame.next_touch()), 1000), Some(Ok(Touch::Down { .. }))));
    assert_eq!(poll_for(pin!(frame.next_touch()), 1000), Some(Ok(Touch::Up)));
}

#[test]
fn a_touch_frame_that_restarts_is_set_up_again() {
    let module = ZForceModule::new(0);
    let mut frame = ZForce::new(module.bus(), module.data_ready(), PolledDelay);
    assert!(poll_for(pin!(frame.next_touch()), 100).is_none());
    module.restart();
    let mut touch = pin!(frame.next_touch());
    assert!(poll_for(touch.as_mut(), 100).is_none());
    module.touch(TouchEvent::Down, 10, 20);
    assert!(matches!(poll_for(touch, 100), Some(Ok(Touch::Down { .. }))));
}

#[test]
fn a_touch_frame_that_fails_is_left_alone_for_a_while_and_set_up_again() {
    let module = ZForceModule::new(0);
    module.connect(false);
    let mut frame = ZForce::new(module.bus(), module.data_ready(), PolledDelay);
    {
        let mut touch = pin!(frame.next_touch());
        assert!(poll_for(touch.as_mut(), 100).is_none(), "100 ms of pause");
        assert_eq!(poll_for(touch, 2), Some(Err(zforce::Error::I2c(BusFault::NoAcknowledge))));
    }
    module.connect(true);
    assert!(poll_for(pin!(frame.next_touch()), 100).is_none());
    module.corrupt_length();
    module.touch(TouchEvent::Down, 10, 20);
    assert_eq!(poll_for(pin!(frame.next_touch()), 200), Some(Err(zforce::Error::Length([0xee, 0]))));
    module.forget_settings();
    let mut touch = pin!(frame.next_touch());
    assert!(poll_for(touch.as_mut(), 100).is_none());
    module.touch(TouchEvent::Up, 10, 20);
    assert_eq!(poll_for(touch, 100), Some(Ok(Touch::Up)));
}

/// Clears a bus and returns whether that succeeded.
fn clear(bus: &HeldBus) -> bool {
    let (mut scl, mut sda, mut delay) = (bus.scl(), bus.sda(), PolledDelay);
    poll_for(pin!(clear_bus(&mut scl, &mut sda, &mut delay)), 1000).unwrap()
}

#[test]
fn nine_clocks_free_a_bus_that_a_reset_left_in_any_transfer() {
    let transfers = (0..=u8::MAX).map(Transfer::Sends).chain([Transfer::Receives, Transfer::Idle]);
    let mut held = 0;
    for (transfer, clock) in transfers.flat_map(|transfer| (0..9).map(move |clock| (transfer, clock))) {
        let bus = HeldBus::new(transfer, clock);
        held += usize::from(!HeldBus::new(transfer, clock).start());
        assert!(clear(&bus), "{transfer:?}, clock {clock}");
        assert!(bus.pulses() <= 9 && bus.start(), "{transfer:?}, clock {clock}");
    }
    assert!(held > 1000, "most of them could not begin a transfer before");
}

#[test]
fn a_bus_that_is_free_gets_no_clocks_and_one_that_is_shorted_is_reported() {
    let bus = HeldBus::new(Transfer::Idle, 0);
    assert!(clear(&bus) && bus.pulses() == 0);
    bus.short_sda();
    assert!(!clear(&bus) && bus.pulses() == 9);
}

/// Presses or releases the button, and returns the ticks until the driver agrees, and how often it changed its mind.
fn change(
    contact: &BouncingContact,
    switch: &mut ArmSwitch<impl embedded_hal::digital::InputPin>,
    press: bool,
) -> (usize, usize) {
    contact.press(press);
    let mut held = !press;
    let (mut at_tick, mut changes) = (0, 0);
    for tick in 1..=2000 {
        contact.tick();
        let now = switch.is_held();
        if now != held {
            (held, at_tick) = (now, tick);
            changes += 1;
        }
    }
    (at_tick, changes)
}

/// A contact bounces for up to 5 ms, 200 ticks.
#[test]
fn a_bouncing_switch_is_pressed_and_released_once() {
    for seed in 0..50 {
        let contact = BouncingContact::new(false, 200, seed);
        let mut switch = ArmSwitch::new(contact.pin(), TICK_HZ);
        for _ in 0..100 {
            contact.tick();
            assert!(!switch.is_held());
        }
        let (tick, changes) = change(&contact, &mut switch, true);
        assert!(changes == 1 && (800..=1000).contains(&tick), "seed {seed}: {changes} changes, last after {tick}");
        let (tick, changes) = change(&contact, &mut switch, false);
        assert!(changes == 1 && (32..=232).contains(&tick), "seed {seed}: {changes} changes, last after {tick}");
    }
}

#[test]
fn a_welded_switch_is_never_held() {
    let contact = BouncingContact::new(true, 200, 1);
    let mut switch = ArmSwitch::new(contact.pin(), TICK_HZ);
    for _ in 0..40_000 {
        contact.tick();
        assert!(!switch.is_held());
    }
    change(&contact, &mut switch, false);
    assert_eq!(change(&contact, &mut switch, true).1, 1, "once it has been open it is a switch like any other");
}

/// An output that lives for one tick after it was set.
#[derive(Default)]
struct OneShot {
    left_ticks: u32,
}

impl embedded_hal::digital::ErrorType for &mut OneShot {
    type Error = Infallible;
}

impl embedded_hal::digital::OutputPin for &mut OneShot {
    fn set_high(&mut self) -> Result<(), Infallible> {
        self.left_ticks = 1;
        Ok(())
    }

    fn set_low(&mut self) -> Result<(), Infallible> {
        self.left_ticks = 0;
        Ok(())
    }
}

impl KickedEnable for &mut OneShot {
    fn kick(&mut self) {
        self.left_ticks = 1;
    }

    fn disable(&mut self) {
        self.left_ticks = 0;
    }
}

#[test]
fn an_amplifier_whose_wire_is_off_has_a_fault() {
    let ready = BouncingContact::new(true, 0, 1);
    let mut enable = OneShot::default();
    let mut amplifier = Amplifier::new(&mut enable, ready.pin());
    assert!(!amplifier.has_fault());
    amplifier.set_enabled(true);
    ready.press(false);
    ready.tick();
    assert!(amplifier.has_fault());
    assert_eq!(enable.left_ticks, 1);
    Amplifier::new(&mut enable, ready.pin()).set_enabled(false);
    assert_eq!(enable.left_ticks, 0);
}

#[test]
fn the_light_shows_the_state() {
    let mut pin = OneShot::default();
    let mut is_on = |state, tick| {
        StateLight::new(&mut pin, TICK_HZ).show(state, tick);
        pin.left_ticks > 0
    };
    assert!(!is_on(State::Disarmed, 0) && is_on(State::Armed, 0) && is_on(State::Active, 0));
    assert!(is_on(State::Faulted, 0) && !is_on(State::Faulted, 5_000) && is_on(State::Faulted, 10_000));
}

/// A port that sends what it has received, `room` bytes a tick.
#[derive(Default)]
struct Loopback {
    bytes: VecDeque<u8>,
    room: usize,
}

impl ErrorType for Loopback {
    type Error = Infallible;
}

impl ReadReady for Loopback {
    fn read_ready(&mut self) -> Result<bool, Infallible> {
        Ok(!self.bytes.is_empty())
    }
}

impl Read for Loopback {
    fn read(&mut self, bytes: &mut [u8]) -> Result<usize, Infallible> {
        let len = bytes.len().min(self.bytes.len());
        for (to, from) in bytes.iter_mut().zip(self.bytes.drain(..len)) {
            *to = from;
        }
        Ok(len)
    }
}

impl WriteReady for Loopback {
    fn write_ready(&mut self) -> Result<bool, Infallible> {
        Ok(self.room > 0)
    }
}

impl Write for Loopback {
    fn write(&mut self, bytes: &[u8]) -> Result<usize, Infallible> {
        let len = bytes.len().min(self.room);
        self.room -= len;
        self.bytes.extend(bytes.iter().take(len));
        Ok(len)
    }

    fn flush(&mut self) -> Result<(), Infallible> {
        Ok(())
    }
}

#[test]
fn a_slow_port_loses_and_repeats_nothing() {
    let mut link = SerialLink::new(Loopback::default());
    let sent: Vec<u8> = (0..3_000_u32).map(|number| (number % 251) as u8).collect();
    let (mut next, mut received) = (0, Vec::new());
    for tick in 0..3_000 {
        link.port_mut().room = [0, 1, 7, 64][tick % 4];
        let Ok(()) = link.transmit(|bytes| {
            let len = bytes.len().min(sent.len() - next).min(100);
            bytes[..len].copy_from_slice(&sent[next..next + len]);
            next += len;
            len
        });
        let Ok(()) = link.receive(|bytes| received.extend_from_slice(bytes));
    }
    assert_eq!(received, sent);
}
