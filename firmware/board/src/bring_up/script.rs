//! The script. [`run`] is its table of contents.

use core::fmt;

use frixel_wire::hello::BoardLimits;

use super::amplifier::{check_amplifier, check_isolation, check_rails};
use super::dialogue::{ask, ask_while, await_inputs, confirm, expect, expect_inputs};
use super::enable_path::check_enable_path;
use super::{Bench, Check, DriveError, Inputs, Reading, TestOutput};

/// The word typed when a step without a reading is done.
pub(super) const DONE: &str = "done";
/// The word typed first, which shows that the board receives.
const GREETING: &str = "frixel";

/// Range of the pull-downs of amplifier enable (before and after the second pole) and DAC clear, kOhm; nominally 10. A
/// meter that supplies the processor through its protection diodes reads less.
pub(super) const PULL_DOWN_KOHM: (f32, f32) = (8.0, 12.0);
/// Each supply of the DAC, V: 15 V, regulated within 5 %. The DAC bears 16.5 V (AD5761R, table 1).
const DAC_SUPPLY_V: (f32, f32) = (14.25, 15.75);
/// Voltages output by the DAC, in V. Its error is some millivolts; the tolerance is for the voltmeter.
const DAC_VOLTAGES_V: [f32; 3] = [0.0, 5.0, -5.0];
const DAC_TOLERANCE_V: f32 = 0.15;

/// The first voltage at the amplifier's output, V peak.
const FIRST_V_PEAK: f32 = 10.0;
/// Largest step from a passed voltage to the next, V peak.
const STEP_V_PEAK: f32 = 25.0;
/// The voltage at which edges are measured, V peak; it has passed before.
const EDGES_V_PEAK: f32 = 25.0;
/// Largest deviation of probe and monitor from the driven peak: 5 % for the amplifier's gain, and 2 % each for level
/// shifter, ADC reference and probe.
const GAIN_TOLERANCE: f32 = 0.1;
/// Additional tolerance: the resolution of an oscilloscope with a 100:1 probe.
const READ_OFF_V: f32 = 1.0;
/// Resistance after the series resistor, Ohm: R3, which discharges the capacitor, in parallel with the probe's hundred
/// megohms. The probe shows the amplifier's output minus the voltage across the series resistor.
const SHUNT_OHM: f32 = 1.0 / (1.0 / 10e6 + 1.0 / 100e6);
/// Largest offset of the monitor: half of the supervisor's tolerance at 200 V full scale, which leaves the other half
/// for the edges.
const OFFSET_MAX_V: f32 = 4.0;

/// Factors by which the time constant of series resistance and capacitor may differ from that of the electrode assumed
/// by the limits: for a capacitor of 0.47 nF less 5 % in place of 0.53 nF, and the precision of an oscilloscope.
const EDGE_FACTOR: (f32, f32) = (0.7, 1.4);
/// Largest ratio of the amplifier's own time constant to the electrode's; more indicates an amplifier that is too slow,
/// or the same point measured twice.
const AMPLIFIER_SHARE_MAX: f32 = 0.5;
/// Smallest time constant of an amplifier with some tens of volts per microsecond.
const AMPLIFIER_MIN_US: f32 = 0.1;

/// Why bring-up has ended. The output is zero.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Stop {
    /// The limits, built in or measured, cannot be stored.
    Limits,
    /// A check has failed.
    Check(Check),
    /// A reading was out of its range.
    Reading {
        /// The measured quantity, with its unit.
        what: &'static str,
        /// The reading.
        found: f32,
        /// Its range.
        expected: (f32, f32),
    },
    /// An unexpected change of an input.
    Inputs {
        /// The preceding action.
        after: &'static str,
        /// Inputs expected after it.
        expected: Inputs,
        /// The inputs.
        found: Inputs,
    },
    /// The output was not driven to the end.
    Drive(DriveError),
    /// The limits were not stored.
    NotStored,
}

impl fmt::Display for Stop {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Limits => f.write_str(
                "a limit, built in or measured, exceeds what the board may store; build bring-up with another",
            ),
            Self::Check(check) => write!(f, "the check of {check:?} has failed"),
            Self::Reading { what, found, expected: (min, max) } => {
                write!(f, "{what} is {found}; it must be from {min} to {max}")
            }
            Self::Inputs { after, expected, found } => write!(
                f,
                "after \"{after}\": expected ready {} and switch {}, found ready {} and switch {}",
                level(expected.amplifier_ready),
                level(expected.switch_closed),
                level(found.amplifier_ready),
                level(found.switch_closed),
            ),
            Self::Drive(error) => error.fmt(f),
            Self::NotStored => f.write_str("storing the limits and reading them back failed, or delayed the tick"),
        }
    }
}

fn level(high: bool) -> &'static str {
    if high { "high" } else { "low" }
}

impl From<DriveError> for Stop {
    fn from(error: DriveError) -> Self {
        Self::Drive(error)
    }
}

/// Proof that the arm switch was released and then pressed. Each voltage consumes one.
#[derive(Debug)]
pub struct Pressed(());

/// The amplifier is off, and the switch is released.
pub(super) const IDLE: Inputs = Inputs { amplifier_ready: false, switch_closed: false };
/// The amplifier is on.
pub(super) const READY: Inputs = Inputs { amplifier_ready: true, ..IDLE };
/// The switch is closed.
pub(super) const CLOSED: Inputs = Inputs { switch_closed: true, ..IDLE };

/// Brings a board up, from nothing connected to stored limits, and returns the limits: `built_in`, with full scale and
/// edges as measured. Voltages go up to `built_in.voltage_max_v_peak`.
pub fn run(bench: &mut impl Bench, built_in: &BoardLimits) -> Result<BoardLimits, Stop> {
    let largest = BoardLimits { full_scale_v_peak: largest_full_scale_v_peak(built_in), ..*built_in };
    if ![built_in, &largest].into_iter().all(|limits| bench.may_store(limits)) {
        return Err(Stop::Limits);
    }
    greet(bench);
    check_processor(bench)?;
    check_dac(bench)?;
    check_inputs(bench)?;
    check_enable_path(bench)?;
    check_amplifier(bench, built_in)?;
    let full_scale_v_peak = drive_voltages(bench, built_in)?;
    let edge_time_constant_s = measure_edges(bench, built_in)?;
    let limits = BoardLimits { full_scale_v_peak, edge_time_constant_s, ..*built_in };
    store(bench, &limits)?;
    Ok(limits)
}

/// Waits for the greeting, which shows that the serial port works in both directions.
fn greet(bench: &mut impl Bench) {
    bench.say(format_args!(""));
    bench.say(format_args!("frixel bring-up. Read docs/board/hardware.md first: this board drives hundreds of volts."));
    bench.say(format_args!(
        "Nothing is driven before step 5. A wrong reading ends bring-up, and only a reset restarts it."
    ));
    confirm(bench, format_args!("0. Serial port."), GREETING);
}

fn check_processor(bench: &mut impl Bench) -> Result<(), Stop> {
    confirm(
        bench,
        format_args!("1. The amplifier's supply is off; on a new board, nothing is connected but USB, R6 and R8."),
        DONE,
    );
    expect_inputs(bench, IDLE, "amplifier off, switch released")?;
    check(bench, Check::Storage)?;
    check(bench, Check::OneShot)?;
    check(bench, Check::FaultsAreStored)?;
    ask(bench, "PB6 (enable) to ground, as measured with USB pulled, kOhm", PULL_DOWN_KOHM)?;
    ask(bench, "PB7 (CLEAR) to ground, as measured with USB pulled, kOhm", PULL_DOWN_KOHM)?;
    Ok(())
}

fn check_dac(bench: &mut impl Bench) -> Result<(), Stop> {
    bench.say(format_args!("2. Measure the DAC's supplies; on a new board, before the DAC is connected to them."));
    ask(bench, "the DAC's positive supply, V", DAC_SUPPLY_V)?;
    ask(bench, "the DAC's negative supply, V", (-DAC_SUPPLY_V.1, -DAC_SUPPLY_V.0))?;
    confirm(
        bench,
        format_args!("Connect the DAC, and a voltmeter to its output. The amplifier's supply stays off."),
        DONE,
    );
    expect_inputs(bench, IDLE, "amplifier off, switch released")?;
    check(bench, Check::Dac)?;
    for volts in DAC_VOLTAGES_V {
        let expected = (volts - DAC_TOLERANCE_V, volts + DAC_TOLERANCE_V);
        ask_while(bench, TestOutput::Dac(volts), "the voltmeter shows, V", expected)?;
        expect_inputs(bench, IDLE, "amplifier off, switch released")?;
    }
    bench.say(format_args!("The last code was {} V, and CLEAR has been low since then.", DAC_VOLTAGES_V[2]));
    ask(bench, "the voltmeter shows, V", (-DAC_TOLERANCE_V, DAC_TOLERANCE_V))?;
    Ok(())
}

/// Checks that each input changes, and changes alone.
fn check_inputs(bench: &mut impl Bench) -> Result<(), Stop> {
    confirm(
        bench,
        format_args!(
            "3. Connect the arm switch, R10, R11 and C1. Leave the ready wire unconnected. The amplifier's supply \
             stays off."
        ),
        DONE,
    );
    expect_inputs(bench, IDLE, "switch released, ready unconnected")?;
    for (what, from, to) in [
        ("Hold the switch", IDLE, CLOSED),
        ("Release the switch", CLOSED, IDLE),
        ("Pull the switch's wire off, and press the switch", IDLE, IDLE),
        ("Put the wire back, and hold the switch", IDLE, CLOSED),
        ("Release the switch", CLOSED, IDLE),
        ("Put the ready wire to 3.3 V", IDLE, READY),
        ("Take the ready wire off again", READY, IDLE),
    ] {
        if from == to {
            confirm(bench, format_args!("{what}."), DONE);
            expect_inputs(bench, to, what)?;
        } else {
            await_inputs(bench, from, to, what)?;
        }
    }
    Ok(())
}

/// Drives a series of voltages, and returns the full scale, in V peak, measured by probe and monitor.
fn drive_voltages(bench: &mut impl Bench, built_in: &BoardLimits) -> Result<f32, Stop> {
    bench.say(format_args!("5. Voltage. Hold the switch until the output is off: a release before that is a fault."));
    let mut full_scale_v_peak = built_in.full_scale_v_peak;
    let mut passed_v_peak = None;
    while let Some(peak_v) = next_voltage(passed_v_peak, built_in.voltage_max_v_peak) {
        let reading = drive(bench, peak_v)?;
        let probe_v = ask(bench, "half of the probe's peak-to-peak voltage, V", around(reading.driven_v_peak))?;
        let probe_v = probe_v * amplifier_v_per_probe_v(built_in);
        let monitor_v = 0.5 * (reading.high_v - reading.low_v);
        expect("the monitor, V, against the probe", monitor_v, around(probe_v))?;
        // The larger one: a low reading would raise every later voltage of the firmware, beyond the margin of the touch
        // bound.
        full_scale_v_peak = built_in.full_scale_v_peak * probe_v.max(monitor_v) / reading.driven_v_peak;
        passed_v_peak = Some(peak_v);
    }
    Ok(full_scale_v_peak)
}

/// The largest full scale that readings may give, V peak. The resulting current of a stuck amplifier is checked before
/// any voltage.
fn largest_full_scale_v_peak(built_in: &BoardLimits) -> f32 {
    let (_, most_v) = around(built_in.voltage_max_v_peak);
    built_in.full_scale_v_peak * amplifier_v_per_probe_v(built_in) * most_v / built_in.voltage_max_v_peak
}

/// The voltage before the series resistor, as a multiple of the voltage at the probe.
fn amplifier_v_per_probe_v(built_in: &BoardLimits) -> f32 {
    1.0 + built_in.series_resistance_ohm / SHUNT_OHM
}

/// The voltage after a passed one: 10 V, then multiples of [`STEP_V_PEAK`] up to `max_v_peak`, which is the last.
fn next_voltage(passed_v_peak: Option<f32>, max_v_peak: f32) -> Option<f32> {
    match passed_v_peak {
        None => Some(FIRST_V_PEAK.min(max_v_peak)),
        Some(passed) if passed >= max_v_peak => None,
        Some(passed) => Some((((passed / STEP_V_PEAK) as u32 + 1) as f32 * STEP_V_PEAK).min(max_v_peak)),
    }
}

/// Drives a voltage, and checks the monitor's readings.
fn drive(bench: &mut impl Bench, peak_v: f32) -> Result<Reading, Stop> {
    let pressed = press(bench, peak_v);
    let reading = bench.drive(pressed, peak_v)?;
    bench.say(format_args!(
        "Output off. Drove {:.1} V peak; the monitor read {:.1} V and {:.1} V, then {:.1} V after it.",
        reading.driven_v_peak, reading.high_v, reading.low_v, reading.rest_v
    ));
    expect("the driven voltage, V peak", reading.driven_v_peak, (peak_v - READ_OFF_V, peak_v + READ_OFF_V))?;
    let offset = (-OFFSET_MAX_V, OFFSET_MAX_V);
    expect("the monitor, V", 0.5 * (reading.high_v - reading.low_v), around(reading.driven_v_peak))?;
    expect("the monitor's mean, V", 0.5 * (reading.high_v + reading.low_v), offset)?;
    expect("the monitor afterwards, V", reading.rest_v, offset)?;
    Ok(reading)
}

/// Waits until the switch is released, and then until it is held.
fn press(bench: &mut impl Bench, peak_v: f32) -> Pressed {
    bench.say(format_args!("Release the switch, then hold it: {peak_v} V peak follow for three seconds."));
    while bench.switch_is_held() {}
    while !bench.switch_is_held() {}
    Pressed(())
}

/// Asks for the rise times at electrode and amplifier, and returns the single time constant with the same loss of the
/// carrier's mean square as amplifier and series resistor together ([`BoardLimits::edge_time_constant_s`]), in s.
fn measure_edges(bench: &mut impl Bench, built_in: &BoardLimits) -> Result<f32, Stop> {
    bench.say(format_args!("6. Edges: set both probes to trigger once, 20 us a division."));
    drive(bench, EDGES_V_PEAK.min(built_in.voltage_max_v_peak))?;
    let assumed_us = 1e6 * built_in.series_resistance_ohm * built_in.electrode_capacitance_max_f;
    let (least_us, most_us) = (EDGE_FACTOR.0 * assumed_us, EDGE_FACTOR.1 * assumed_us);
    let with_amplifier_us = (least_us, most_us / (1.0 - AMPLIFIER_SHARE_MAX));
    let electrode_us = ask(bench, "at the capacitor: time from the edge's start to 63 % of it, us", with_amplifier_us)?;
    let amplifier_us = (AMPLIFIER_MIN_US, AMPLIFIER_SHARE_MAX * electrode_us);
    let amplifier_us = ask(bench, "at the monitor: time from the edge's start to 63 % of it, us", amplifier_us)?;
    // For two successive lags, the rise to 63 % takes about as long as both together.
    let resistor_us = electrode_us - amplifier_us;
    expect("the time at the capacitor less that at the monitor, us", resistor_us, (least_us, most_us))?;
    Ok(1e-6 * (electrode_us - amplifier_us * resistor_us / electrode_us))
}

fn store(bench: &mut impl Bench, limits: &BoardLimits) -> Result<(), Stop> {
    await_inputs(bench, READY, IDLE, "7. Switch the amplifier's supply off")?;
    check_rails(bench);
    confirm(bench, format_args!("Take all probes off: the clip of one may have tied the common to earth."), DONE);
    check_isolation(bench)?;
    if !bench.may_store(limits) {
        return Err(Stop::Limits);
    }
    if bench.store(limits) { Ok(()) } else { Err(Stop::NotStored) }
}

/// The range within the tolerance of a gain.
fn around(volts: f32) -> (f32, f32) {
    let tolerance_v = GAIN_TOLERANCE * volts.abs() + READ_OFF_V;
    (volts - tolerance_v, volts + tolerance_v)
}

pub(super) fn check(bench: &mut impl Bench, check: Check) -> Result<(), Stop> {
    if bench.check(check) { Ok(()) } else { Err(Stop::Check(check)) }
}
