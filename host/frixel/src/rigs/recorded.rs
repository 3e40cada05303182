//! What all rigs have in common.

use frixel_driver::Link;
use frixel_felt::recorder::{FeltFriction, FingerState, Observation, Recorder};
use frixel_hil_sim::{Felt, FingerState as SimulatedFinger, ReferenceFriction};
use frixel_play::Recorded;

/// A link to a board that plays a scene, with the [`Recorder`] of that play. It is idle until a play has its own.
pub(crate) trait RecordedLink: Link + Recorded<Recorder = Recorder> {}

impl<L: Link + Recorded<Recorder = Recorder>> RecordedLink for L {}

/// The finger that the reference of a record is meant for.
#[derive(Clone, Copy, Debug, Default)]
pub(super) enum ReferenceFinger {
    /// The scene's contact model in steady sliding.
    #[default]
    Scene,
    /// The simulated finger, with its load, noise and skin.
    Simulated(ReferenceFriction),
}

impl ReferenceFinger {
    /// The simulated finger before its first touch.
    pub(super) fn simulated() -> Self {
        Self::Simulated(ReferenceFriction::default())
    }

    /// Records the observation of a tick in which the simulated finger felt `felt`.
    pub(super) fn record(&mut self, recorder: &mut Recorder, observation: &Observation, felt: &Felt) {
        match self {
            Self::Scene => recorder.record(observation),
            Self::Simulated(reference) => {
                if felt.finger.is_none() {
                    *reference = ReferenceFriction::default();
                }
                recorder.record_through(observation, &mut |electric_n| reference.follow(felt, electric_n));
            }
        }
    }
}

/// Converts the state of a simulated world into the types of the recorder.
pub(super) fn finger_and_felt(felt: &Felt) -> (Option<FingerState>, Option<FeltFriction>) {
    let finger = felt.finger.map(|SimulatedFinger { x_m, y_m, speed_m_per_s }| FingerState { x_m, y_m, speed_m_per_s });
    let friction = FeltFriction {
        friction_n: felt.friction_n,
        electric_friction_n: felt.electric_friction_n,
        load_mismatch_n: felt.load_mismatch_n,
    };
    (finger, Some(friction))
}
