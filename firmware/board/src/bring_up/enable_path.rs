//! The part of the script that tests how the amplifier is disabled without the firmware: by the monostable outside the
//! processor, which SYNC triggers, and by the arm switch's second pole. Only this test reveals a bridged one, since
//! everything works without them. The amplifier cannot be enabled during the test: its enable and its ready are
//! unplugged, and the DAC is at zero.

use super::dialogue::{ask_while, await_inputs, confirm, expect_inputs};
use super::script::{CLOSED, DONE, IDLE, check};
use super::{Bench, Check, Stop, Sync, TestOutput};

/// The word typed when the amplifier cannot be enabled.
const UNPLUGGED: &str = "unplugged";
/// A gate's low level, V, with a tolerance of some millivolts for the voltmeter.
const LOW_V: (f32, f32) = (-0.1, 0.4);
/// A gate's high level, V: 3.3 V that fall for less than a tenth of the time. A monostable that ignores triggers during
/// its pulse, and thus falls after each, still passes this.
const HIGH_V: (f32, f32) = (3.0, 3.6);
/// Falling edges per second of a constant high level.
const NO_EDGES: (f32, f32) = (-0.5, 0.5);
/// The mean of pulses of 3.3 V that last 0.5 to 1 ms, every 2 ms, V.
const PULSE_MEAN_V: (f32, f32) = (0.8, 1.65);

/// Enables the amplifier except for the switch.
const ALL: TestOutput = TestOutput::Enable { kicked: true, sync: Sync::EveryPeriod };

pub(super) fn check_enable_path(bench: &mut impl Bench) -> Result<(), Stop> {
    confirm(
        bench,
        format_args!(
            "Connect monostable and gate (U3, U4), the switch's second pole and R7. The amplifier's supply is off, and \
             its ENABLE and READY are unplugged. Put the voltmeter on ENABLE_LOGIC, the gate's output."
        ),
        UNPLUGGED,
    );
    expect_inputs(bench, IDLE, "switch released, ready unconnected")?;
    // The last code was not zero, and only CLEAR holds the output at zero.
    check(bench, Check::Dac)?;
    for (kicked, sync, what, expected) in [
        (true, Sync::Never, "ENABLE_LOGIC with PB6 high and no SYNC, V", LOW_V),
        (false, Sync::EveryPeriod, "ENABLE_LOGIC with SYNC and PB6 low, V", LOW_V),
        (true, Sync::EveryPeriod, "ENABLE_LOGIC with both, V", HIGH_V),
        (true, Sync::EveryPeriod, "ENABLE_LOGIC with both: falling edges in a second, by an oscilloscope", NO_EDGES),
        (true, Sync::Every2Ms, "ENABLE_LOGIC, its mean with one SYNC every 2 ms, V", PULSE_MEAN_V),
    ] {
        ask_while(bench, TestOutput::Enable { kicked, sync }, what, expected)?;
        expect_inputs(bench, IDLE, "switch released, ready unconnected")?;
    }
    confirm(
        bench,
        format_args!("Take the oscilloscope off. Put the voltmeter on ENABLE, at R7, behind the switch's second pole."),
        DONE,
    );
    ask_while(bench, ALL, "ENABLE, switch released, ENABLE_LOGIC high, V", LOW_V)?;
    expect_inputs(bench, IDLE, "switch released, ready unconnected")?;
    await_inputs(bench, IDLE, CLOSED, "Hold the switch")?;
    // Touching poles bypass everything else with 3.3 V.
    ask_while(bench, TestOutput::Zero, "ENABLE, switch held, ENABLE_LOGIC low, V", LOW_V)?;
    expect_inputs(bench, CLOSED, "switch held, ready unconnected")?;
    ask_while(bench, ALL, "ENABLE, switch held, ENABLE_LOGIC high, V", HIGH_V)?;
    expect_inputs(bench, CLOSED, "switch held, ready unconnected")?;
    await_inputs(bench, CLOSED, IDLE, "Release the switch")
}
