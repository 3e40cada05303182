//! The input of a recorder.

use frixel_wire::fault::Flags;
use frixel_wire::message::Telemetry;

/// The known state of a board and its finger at one tick. A value that the source cannot observe is `None`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Observation {
    /// Ticks since the board's power-on, this one included, modulo 2^32.
    pub tick: u32,
    /// The finger, while it is on the screen: its true place if the finger is simulated, otherwise the place that the
    /// board reports.
    pub finger: Option<FingerState>,
    /// The friction that the finger felt; known only for a simulated finger.
    pub felt: Option<FeltFriction>,
    /// The code that went to the DAC.
    pub dac_code: Option<i16>,
    /// The board's telemetry of this tick.
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
    /// Total friction.
    pub friction_n: f64,
    /// The part of the friction that the drive added.
    pub electric_friction_n: f64,
    /// The part of the friction that is there because the finger presses with another load than the one that the scene
    /// is meant for.
    pub load_mismatch_n: f64,
}

impl Observation {
    /// An observation of a real board, from its telemetry alone.
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
