//! The finger of a calibration on the simulator.

use frixel_hil_sim::{FingertipConfig, OwnFinger, Person};
use frixel_model::{Contact, Finger, ParameterError};
use frixel_scene::{Elasticity, FingerProfile};

use crate::fit::CONVENTIONAL_STIFFNESS_PA_PER_M;

/// The example finger of the contact model.
pub fn example_finger() -> Finger<f64> {
    let example = FingerProfile::example();
    let stiffness_pa_per_m = match example.elasticity {
        Elasticity::WinklerFuss { stiffness_pa_per_m } => stiffness_pa_per_m,
        Elasticity::Soft { .. } | Elasticity::Empirical(_) => CONVENTIONAL_STIFFNESS_PA_PER_M,
    };
    Finger {
        radius_m: 1e-3 * example.radius_mm,
        stiffness_pa_per_m,
        friction_coefficient: example.friction_coefficient,
    }
}

/// The finger under a simulated board, on a coating with this effective gap: that of the person of a seed, or the
/// example finger.
pub fn simulated_finger(seed: Option<u64>, coating_gap_m: f64) -> Result<OwnFinger, ParameterError> {
    if let Some(seed) = seed {
        return Person::drawn(seed).own_finger(coating_gap_m);
    }
    let example = FingerProfile::example();
    let contact = Contact::new(&example_finger(), coating_gap_m + 1e-6 * example.skin_gap_um);
    let contact = contact.and_then(|contact| contact.under_load(example.normal_load_n));
    Ok(OwnFinger { law: contact?.into(), fingertip: FingertipConfig::REALISTIC })
}

/// The seed of what is random in the simulation of a person: two people with one `--seed` do not share their noise and
/// the wander of their load.
pub fn simulation_seed(seed: u64, finger_seed: Option<u64>) -> u64 {
    // The odd factor (2^64 over the golden ratio) keeps people apart from neighbouring seeds.
    finger_seed.map_or(seed, |finger| seed ^ finger.wrapping_add(1).wrapping_mul(0x9E37_79B9_7F4A_7C15).rotate_left(32))
}
