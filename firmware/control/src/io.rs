//! What goes into a tick and what comes out.

use frixel_wire::dac_code::DacCode;

/// What the board sees at a tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sense {
    /// The amplifier says that something is wrong with it.
    pub amplifier_fault: bool,
    /// Voltage on the electrode as the amplifier's monitor has it, at the end of the tick before, in volts.
    pub monitor_v: f32,
    /// The arm switch is held.
    pub arm_switch: bool,
}

/// What the board puts out at a tick.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Drive {
    /// Bipolar DAC code, a fraction of the board's full-scale voltage.
    pub dac_code: DacCode,
    /// The amplifier may drive the electrode.
    pub amplifier_enable: bool,
}
