//! The finger of a calibration on the simulator.

use frixel_hil_sim::{FingertipConfig, OwnFinger, Person};
use frixel_model::{Contact, Finger, ParameterError};
use frixel_scene::FingerProfile;

/// The finger under a simulated board, on a coating with this effective gap: that of the person of a seed, or the
/// example finger.
pub fn simulated_finger(seed: Option<u64>, coating_gap_m: f64) -> Result<OwnFinger, ParameterError> {
    if let Some(seed) = seed {
        return Person::drawn(seed).own_finger(coating_gap_m);
    }
    let example = FingerProfile::example();
    let contact = Contact::new(&Finger::<f64>::EXAMPLE, coating_gap_m + 1e-6 * example.skin_gap_um);
    let contact = contact.and_then(|contact| contact.under_load(example.normal_load_n));
    Ok(OwnFinger { law: contact?.into(), fingertip: FingertipConfig::REALISTIC })
}

/// Seed of a person's simulation: two people with the same `--seed` differ in noise and load drift.
pub fn simulation_seed(seed: u64, finger_seed: Option<u64>) -> u64 {
    // The odd factor (2^64 over the golden ratio) keeps people apart from neighbouring seeds.
    finger_seed.map_or(seed, |finger| seed ^ finger.wrapping_add(1).wrapping_mul(0x9E37_79B9_7F4A_7C15).rotate_left(32))
}
