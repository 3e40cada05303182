//! The part of the script that shows what disables the amplifier without the firmware: the monostable outside of the
//! processor, which SYNC feeds, and the arm switch's second pole. Everything else works without them, so that nothing
//! else would show that one of them is bridged. The amplifier cannot be enabled meanwhile: its enable and its ready are
//! unplugged, and the DAC is at zero.

use super::dialogue::{ask_while, await_inputs, confirm, expect_inputs};
use super::script::{CLOSED, DONE, IDLE, check};
use super::{Bench, Check, Stop, Sync, TestOutput};

/// The word that the person types when the amplifier cannot be enabled.
const UNPLUGGED: &str = "unplugged";
/// A gate's low level, V. The voltmeter may be off by some millivolts.
const LOW_V: (f32, f32) = (-0.1, 0.4);
/// A gate's high level, V: 3.3 V that fall no tenth of the time. A monostable that takes no new trigger before its
/// pulse is over, and so falls once in each, still shows this.
const HIGH_V: (f32, f32) = (3.0, 3.6);
/// Falling edges in a second of a level that is high for good.
const NO_EDGES: (f32, f32) = (-0.5, 0.5);
/// The mean of 3.3 V that last 0.5 to 1 ms every 2 ms, V.
const PULSE_MEAN_V: (f32, f32) = (0.8, 1.65);

/// Everything that lets the amplifier be enabled but the switch.
const ALL: TestOutput = TestOutput::Enable { kicked: true, sync: Sync::EveryPeriod };

pub(super) fn check_enable_path(bench: &mut impl Bench) -> Result<(), Stop> {
    confirm(
        bench,
        format_args!(
            "Connect monostable and gate (U3, U4), the switch's second pole and R7. The amplifier's supply is off, \
             and its ENABLE and READY are unplugged. The voltmeter on ENABLE_LOGIC, the gate's output."
        ),
        UNPLUGGED,
    );
    expect_inputs(bench, IDLE, "switch released, ready in the air")?;
    // The last code was not zero, and only CLEAR holds it off.
    check(bench, Check::Dac)?;
    for (kicked, sync, what, expected) in [
        (true, Sync::Never, "ENABLE_LOGIC with PB6 high and no SYNC, V", LOW_V),
        (false, Sync::EveryPeriod, "ENABLE_LOGIC with SYNC and PB6 low, V", LOW_V),
        (true, Sync::EveryPeriod, "ENABLE_LOGIC with both, V", HIGH_V),
        (true, Sync::EveryPeriod, "ENABLE_LOGIC with both: falling edges in a second, by an oscilloscope", NO_EDGES),
        (true, Sync::Every2Ms, "ENABLE_LOGIC, its mean with one SYNC every 2 ms, V", PULSE_MEAN_V),
    ] {
        ask_while(bench, TestOutput::Enable { kicked, sync }, what, expected)?;
        expect_inputs(bench, IDLE, "switch released, ready in the air")?;
    }
    confirm(
        bench,
        format_args!("Take the oscilloscope off. The voltmeter on ENABLE, at R7, behind the switch's second pole."),
        DONE,
    );
    ask_while(bench, ALL, "ENABLE, switch released, ENABLE_LOGIC high, V", LOW_V)?;
    expect_inputs(bench, IDLE, "switch released, ready in the air")?;
    await_inputs(bench, IDLE, CLOSED, "Hold the switch")?;
    // Two poles that touch each other let 3.3 V past everything else.
    ask_while(bench, TestOutput::Zero, "ENABLE, switch held, ENABLE_LOGIC low, V", LOW_V)?;
    expect_inputs(bench, CLOSED, "switch held, ready in the air")?;
    ask_while(bench, ALL, "ENABLE, switch held, ENABLE_LOGIC high, V", HIGH_V)?;
    expect_inputs(bench, CLOSED, "switch held, ready in the air")?;
    await_inputs(bench, CLOSED, IDLE, "Release the switch")
}
