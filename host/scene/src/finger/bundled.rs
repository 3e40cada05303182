//! The bundled finger profiles, which are files in `scenes/fingers`.

use frixel_model::Finger;

use super::{Elasticity, Evidence, FingerProfile};

/// Name and text of each profile.
pub(super) const TEXTS: [(&str, &str); 4] = [
    ("example", include_str!("../../fingers/example.toml")),
    ("dry", include_str!("../../fingers/dry.toml")),
    ("moist", include_str!("../../fingers/moist.toml")),
    ("light", include_str!("../../fingers/light.toml")),
];

/// The first profile of [`TEXTS`], which a test compares with its text.
pub(super) const EXAMPLE: FingerProfile = FingerProfile {
    friction_coefficient: Finger::<f64>::EXAMPLE.friction_coefficient,
    normal_load_n: 0.5,
    radius_mm: 1e3 * Finger::<f64>::EXAMPLE.radius_m,
    elasticity: Elasticity::WinklerFuss { stiffness_pa_per_m: Finger::<f64>::EXAMPLE.stiffness_pa_per_m },
    skin_gap_um: 4.74,
    evidence: Evidence::Assumed,
};
