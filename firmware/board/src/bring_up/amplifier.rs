//! The part of the script that connects the amplifier: isolation, series resistors and enable are measured before its
//! supply is switched on for the first time.

use frixel_wire::hello::BoardLimits;

use super::dialogue::{ask, await_inputs, confirm, expect_inputs};
use super::script::{CLOSED, DONE, IDLE, PULL_DOWN_KOHM, READY, check};
use super::{Bench, Check, Stop};

/// Least resistance between the board's ground and protective earth: more than any connection, less than any isolator.
const ISOLATION_MIN_MOHM: f32 = 10.0;

/// Smallest and largest ratio of each half of the series resistance, measured by an ohmmeter of 0.5 %, to the built-in
/// half. The touch bound depends on the sum, and its margin includes a sum that is 1.5 % low. It is not measured later:
/// a shorted resistor would halve the sum and let twice the current through a person.
const SERIES_RATIO: (f32, f32) = (0.99, 1.02);

/// Resistance between the two sides of the switch's second pole while it is closed, Ohm.
const CLOSED_POLE_OHM: (f32, f32) = (-1.0, 100.0);

/// Checks that ready follows the amplifier's supply, and that the tick runs with the output at zero.
pub(super) fn check_amplifier(bench: &mut impl Bench, built_in: &BoardLimits) -> Result<(), Stop> {
    bench.say(format_args!("4. The amplifier, with its supply off."));
    check_rails(bench);
    confirm(
        bench,
        format_args!(
            "Connect the amplifier; the series resistor, and the capacitor in place of the electrode. \
             No oscilloscope is connected yet."
        ),
        DONE,
    );
    expect_inputs(bench, IDLE, "amplifier off, switch released")?;
    check_isolation(bench)?;
    check_plug(bench)?;
    let half_kohm = 0.5e-3 * built_in.series_resistance_ohm;
    let half_kohm = (SERIES_RATIO.0 * half_kohm, SERIES_RATIO.1 * half_kohm);
    ask(bench, "series resistor R1, at its own ends, kOhm", half_kohm)?;
    ask(bench, "series resistor R2, at its own ends, kOhm", half_kohm)?;
    confirm(
        bench,
        format_args!(
            "Take the ohmmeter's leads off. Put the high-voltage probe on the capacitor, an ordinary one on the \
             monitor. Close the box."
        ),
        DONE,
    );
    await_inputs(bench, IDLE, READY, "Switch the amplifier's supply on")?;
    await_inputs(bench, READY, IDLE, "Switch it off")?;
    await_inputs(bench, IDLE, READY, "Switch it on")?;
    check(bench, Check::Dac)?;
    check(bench, Check::Ticks)
}

/// Asks the person to measure the rails, which may still be charged, before touching anything near them.
pub(super) fn check_rails(bench: &mut impl Bench) {
    confirm(
        bench,
        format_args!(
            "Wait ten seconds, open the box with one hand, and measure each rail against the common, and rail to rail: \
             all below 1 V."
        ),
        DONE,
    );
}

/// Checks that the common has no connection to protective earth. Call it while no oscilloscope is connected.
pub(super) fn check_isolation(bench: &mut impl Bench) -> Result<(), Stop> {
    ask(
        bench,
        "GND to protective earth, with USB in its isolator, MOhm (999 for no reading)",
        (ISOLATION_MIN_MOHM, f32::MAX),
    )?;
    Ok(())
}

/// Checks that the amplifier's enable, which was unplugged for the previous step, is connected after the switch's
/// second pole. Connected before the pole, everything would still work, but the switch would no longer stop the
/// amplifier by itself.
fn check_plug(bench: &mut impl Bench) -> Result<(), Stop> {
    ask(bench, "released: ENABLE_LOGIC to ENABLE at the amplifier's own terminal, kOhm", PULL_DOWN_KOHM)?;
    await_inputs(bench, IDLE, CLOSED, "Hold the switch")?;
    ask(bench, "held: the same, Ohm", CLOSED_POLE_OHM)?;
    expect_inputs(bench, CLOSED, "switch held, amplifier off")?;
    await_inputs(bench, CLOSED, IDLE, "Release the switch")
}
