//! Inputs and outputs of a tick.

use frixel_wire::dac_code::DacCode;

/// The board's inputs at a tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sense {
    /// The amplifier signals a fault.
    pub amplifier_fault: bool,
    /// Voltage on the electrode at the end of the previous tick, measured by the amplifier's monitor, in volts.
    pub monitor_v: f32,
    /// The arm switch is held.
    pub arm_switch: bool,
}

/// The board's outputs at a tick.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Drive {
    /// Bipolar DAC code, a fraction of the board's full-scale voltage.
    pub dac_code: DacCode,
    /// The amplifier may drive the electrode.
    pub amplifier_enable: bool,
}
