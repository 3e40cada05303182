//! What goes into a recorder.

use frixel_wire::fault::Flags;
use frixel_wire::message::Telemetry;

/// What is known of a board and its finger at one tick. What the source cannot see is `None`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Observation {
    /// Ticks since the board's power-on, this one included, modulo 2^32.
    pub tick: u32,
    /// The finger, while it is on the screen: its true place where the finger is simulated, else what the board
    /// reports.
    pub finger: Option<FingerState>,
    /// What the finger felt; only a simulated one can say.
    pub felt: Option<FeltFriction>,
    /// The code that went to the DAC.
    pub dac_code: Option<i16>,
    /// What the board reports of this tick.
    pub telemetry: Option<Telemetry>,
}

/// A finger on the screen.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FingerState {
    /// Place from the left edge of the screen, m.
    pub x_m: f64,
    /// Place from the top edge of the screen, m.
    pub y_m: f64,
    /// Sliding speed, m/s.
    pub speed_m_per_s: f64,
}

/// Friction that a simulated finger felt, N.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FeltFriction {
    /// The total.
    pub friction_n: f64,
    /// The part that the drive added.
    pub electric_friction_n: f64,
}

impl Observation {
    /// What a board reports of itself, without anybody who sees its finger from outside.
    pub fn from_telemetry(telemetry: &Telemetry) -> Self {
        let finger = FingerState {
            x_m: f64::from(telemetry.finger_x_m),
            y_m: f64::from(telemetry.finger_y_m),
            speed_m_per_s: f64::from(telemetry.speed_m_per_s),
        };
        Self {
            tick: telemetry.tick,
            finger: (!telemetry.flags.contains(Flags::NO_FINGER)).then_some(finger),
            felt: None,
            dac_code: Some(telemetry.dac_code),
            telemetry: Some(*telemetry),
        }
    }
}
