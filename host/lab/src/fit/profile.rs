//! A fit as a finger profile.

use frixel_scene::{Elasticity, Evidence, Experiment, FingerProfile};

use super::{CONVENTIONAL_RADIUS_M, CONVENTIONAL_STIFFNESS_PA_PER_M, Fit};

/// The profile of a fitted finger. Radius and stiffness are a convention; the skin gap compensates for them on the
/// screen of the experiment. It is assumed if the finger was simulated.
pub fn profile(fit: &Fit, experiment: Experiment) -> FingerProfile {
    FingerProfile {
        friction_coefficient: rounded(fit.friction_coefficient.value),
        normal_load_n: rounded(fit.data.normal_load_n),
        radius_mm: 1e3 * CONVENTIONAL_RADIUS_M,
        elasticity: Elasticity::WinklerFuss { stiffness_pa_per_m: CONVENTIONAL_STIFFNESS_PA_PER_M },
        skin_gap_um: rounded(1e6 * fit.skin_gap_m),
        evidence: evidence(fit, experiment),
    }
}

fn evidence(fit: &Fit, experiment: Experiment) -> Evidence {
    if fit.data.preparation.is_simulated {
        return Evidence::Assumed;
    }
    Evidence::Measured {
        experiment,
        friction_coefficient_interval: [fit.friction_coefficient.low, fit.friction_coefficient.high].map(rounded),
        electric_friction_interval_n: [fit.electric_friction_most_n.low, fit.electric_friction_most_n.high]
            .map(rounded),
        voltage_max_v_rms: rounded(fit.data.voltage_range_v_rms.1),
        normal_load_range_n: [fit.data.load_range_n.0, fit.data.load_range_n.1].map(rounded),
    }
}

/// A number of six significant digits: far beyond what was measured, and readable.
pub(super) fn rounded(value: f64) -> f64 {
    format!("{value:.5e}").parse().unwrap_or(value)
}
