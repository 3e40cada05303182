//! What every rig has in common.

use frixel_driver::{Link, LinkClosed};
use frixel_hil_sim::{Felt, FingerState as SimulatedFinger};
use frixel_scene::recorder::{FeltFriction, FingerState, Recorder};
use frixel_wire::message::Telemetry;

/// A link to a board that a scene plays on, with the record of that play.
pub trait RecordedLink: Link {
    /// The recorder. It is idle until somebody puts another in its place.
    fn recorder_mut(&mut self) -> &mut Recorder;

    /// Starts the stroke and the record of a finger that is simulated beside the board. To be called when the scene
    /// plays.
    fn begin(&mut self) -> Result<(), LinkClosed> {
        Ok(())
    }

    /// Records what has been seen of the board since the last call, with the telemetry that it has sent meanwhile.
    fn record(&mut self, telemetry: &[Telemetry]);

    /// Records the ticks that still wait for telemetry. To be called when no more telemetry comes.
    fn record_rest(&mut self) {}
}

/// The finger and the friction of a simulated world, as a recorder takes them.
pub(super) fn finger_and_felt(felt: &Felt) -> (Option<FingerState>, Option<FeltFriction>) {
    let finger = felt.finger.map(|SimulatedFinger { x_m, y_m, speed_m_per_s }| FingerState { x_m, y_m, speed_m_per_s });
    let friction = FeltFriction { friction_n: felt.friction_n, electric_friction_n: felt.electric_friction_n };
    (finger, Some(friction))
}
