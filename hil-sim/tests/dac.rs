//! The driver of the DAC against the chip's model, and the order of edges that puts the DAC at zero from any state.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "helpers of tests fail as tests do")]

use std::convert::Infallible;

use embedded_hal::delay::DelayNs;
use embedded_hal::digital::{ErrorType, OutputPin};
use embedded_hal::spi::SpiDevice;
use frixel_drivers::ad5761r::{self, Ad5761r};
use frixel_hil_sim::chips::Ad5761rChip;
use frixel_wire::dac_code::DacCode;

/// A step of the DAC, in volts.
const STEP_V: f64 = 10.0 / 32_768.0;

fn dac(chip: &Ad5761rChip) -> Ad5761r<Ad5761rChip, Ad5761rChip> {
    Ad5761r::new(chip.clone(), chip.clone())
}

/// A frame that the tick sends by hardware of its own.
fn tick_frame(chip: &Ad5761rChip, code: i16) {
    chip.clone().write(&ad5761r::output(DacCode::from_bits(code))).unwrap();
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

/// Without configuration, the DAC would take zero in two's complement for minus full scale in straight binary.
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

/// The amplifier's enable.
struct Enable<'a> {
    chip: &'a Ad5761rChip,
    /// Time and output of the DAC when it fell.
    fell: Option<(u64, f64)>,
}

impl ErrorType for Enable<'_> {
    type Error = Infallible;
}

impl OutputPin for Enable<'_> {
    fn set_low(&mut self) -> Result<(), Infallible> {
        self.fell = Some((self.chip.now_ns(), self.chip.output_v()));
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        panic!("enabled")
    }
}

/// Puts the output to zero, and returns when the enable fell.
fn zero_output(chip: &Ad5761rChip) -> Option<(u64, f64)> {
    let mut enable = Enable { chip, fell: None };
    ad5761r::zero_output(&mut enable, &mut chip.sync_pin(), &mut chip.clear_pin());
    enable.fell
}

/// What happens on the DAC's wires in a period of the tick.
#[derive(Clone, Copy, Debug)]
enum Edge {
    SyncLow,
    Clock(bool),
    /// The timer's edge; it does not reach the wire once software has taken the pin.
    SyncHigh,
}

/// The edges of a period of 25 us with a frame, with their times: the tick begins the frame after 5 us at 21.25 MHz,
/// and the timer latches it after 24.1 us. DMA sends the clocks, whatever the processor does meanwhile.
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
    chip.clone().delay_ns(u32::try_from(at_ns.saturating_sub(chip.now_ns())).unwrap());
}

/// A prepared DAC that has put a code out, in the middle of a frame with the next code: the first `edges_before` edges
/// of a period have occurred, and `part` of the time until the following one has passed. Returns the edges to come,
/// too.
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

/// The amplifier is disabled before the frame in flight is put out.
#[test]
fn a_panic_at_any_phase_of_a_frame_disables_the_amplifier_and_puts_the_dac_at_zero_within_30_us() {
    for phase in phases() {
        let (chip, to_come) = in_mid_frame(phase.0, phase.1);
        let (from_ns, from_v) = (chip.now_ns(), chip.output_v());
        assert!(from_v.abs() > 9.0, "{phase:?}");
        assert_eq!(zero_output(&chip), Some((from_ns, from_v)), "{phase:?}");
        send_rest(&chip, &to_come);
        wait_until(&chip, from_ns + 100_000);
        assert!(chip.output_v().abs() < f64::EPSILON, "{phase:?}: {} V", chip.output_v());
        assert!(chip.settled_at_ns() - from_ns <= ZERO_WITHIN_NS, "{phase:?}: {} ns", chip.settled_at_ns() - from_ns);
    }
}

/// The reason for the order in [`ad5761r::zero_output`]: a complete frame is latched when SYNC rises after CLEAR has
/// fallen.
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
            zero_output(&chip);
            assert!(chip.output_v().abs() < f64::EPSILON, "{phase:?}, {clear_first}: {} V", chip.output_v());
            assert!(chip.settled_at_ns() <= from_ns + ZERO_WITHIN_NS, "{phase:?}, {clear_first}");
            dac(&chip).prepare().unwrap();
            assert!(chip.output_v().abs() < f64::EPSILON);
        }
    }
    assert!(kept_a_code > 0, "the pull-downs alone do not put the DAC at zero");
}

/// RESET of the DAC is tied to the processor's reset.
#[test]
fn a_reset_at_any_phase_of_a_frame_clamps_a_dac_that_is_reset_with_the_processor() {
    for phase in phases() {
        let (chip, to_come) = in_mid_frame(phase.0, phase.1);
        chip.set_reset(false);
        chip.set_clear(false);
        chip.set_sync(true);
        send_rest(&chip, &to_come);
        chip.set_reset(true);
        assert!(chip.output_v().abs() < f64::EPSILON, "{phase:?}: {} V", chip.output_v());
    }
}

/// The one-shot has let CLEAR fall before the panic, so that the panic must make an edge.
#[test]
fn a_dac_whose_clear_is_low_already_is_set_to_zero() {
    let chip = Ad5761rChip::new();
    dac(&chip).prepare().unwrap();
    chip.set_clear(false);
    tick_frame(&chip, 30_000);
    assert!(chip.output_v() > 9.0);
    zero_output(&chip);
    assert!(chip.output_v().abs() < f64::EPSILON);
}
