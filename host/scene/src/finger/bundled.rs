//! The bundled finger profiles, which are files in `scenes/fingers`.

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
    friction_coefficient: 0.5,
    normal_load_n: 0.5,
    radius_mm: 8.0,
    elasticity: Elasticity::WinklerFuss { stiffness_pa_per_m: 1.8e7 },
    skin_gap_um: 4.74,
    evidence: Evidence::Assumed,
};
