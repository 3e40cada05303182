//! The input of a recorder.

use frixel_hil_sim::{Felt, FingerState};
use frixel_wire::fault::Flags;
use frixel_wire::message::Telemetry;

/// The known state of a board and its finger at one tick. A value that the source cannot observe is `None`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Observation {
    /// Ticks since the board's power-on, this one included, modulo 2^32.
    pub tick: u32,
    /// The finger while it is on the screen: its true place if it is simulated, otherwise the place reported by the
    /// board.
    pub finger: Option<FingerState>,
    /// Friction felt by a simulated finger.
    pub felt: Option<Felt>,
    /// The code sent to the DAC.
    pub dac_code: Option<i16>,
    /// The board's telemetry of this tick.
    pub telemetry: Option<Telemetry>,
}

impl Observation {
    /// An observation of a simulated board and its world, with all values known.
    pub fn of_tick(tick: u32, felt: &Felt, telemetry: &Telemetry) -> Self {
        Self { telemetry: Some(*telemetry), ..Self::of_world(tick, felt, telemetry.dac_code) }
    }

    /// An observation of a simulated finger under a board that does not report its state in this tick.
    pub fn of_world(tick: u32, felt: &Felt, dac_code: i16) -> Self {
        Self { tick, finger: felt.finger, felt: Some(*felt), dac_code: Some(dac_code), telemetry: None }
    }

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

    /// Whether the board has received a report of a finger; `None` if it did not report.
    pub(super) fn board_has_finger(&self) -> Option<bool> {
        self.telemetry.map(|telemetry| !telemetry.flags.contains(Flags::NO_FINGER))
    }
}
