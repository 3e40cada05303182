//! Inputs and outputs of a tick.

use frixel_wire::dac_code::DacCode;

/// The board's inputs at a tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sense {
    /// Whether the amplifier's ready line is low. Its meaning while the amplifier is disabled depends on the board
    /// ([`ReadyWhileDisabled`](crate::ReadyWhileDisabled)).
    pub amplifier_fault: bool,
    /// Voltage at the amplifier's output, before the series resistor, in V, as shown by the amplifier's monitor at the
    /// beginning of the tick. A board latches the code of a tick at the end of the tick's period. This is therefore the
    /// output after the code of the tick before the last one was held for a whole tick.
    pub monitor_v: f32,
    /// Whether the arm switch is held.
    pub arm_switch: bool,
}

/// The board's outputs at a tick.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Drive {
    /// Bipolar DAC code, a fraction of the board's full-scale voltage.
    pub dac_code: DacCode,
    /// Whether the amplifier may drive the electrode.
    pub amplifier_enable: bool,
}
