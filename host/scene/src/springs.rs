//! The linear springs that approximate a finger on a board.
//!
//! The header of a compiled scene has a single stiffness. A soft finger's stiffness depends on the force, Eq. (29), so
//! springs only approximate it. Their stiffness is chosen to match the soft finger's friction at the largest voltage;
//! the largest deviation at lower voltages is computed.

use frixel_model::{Contact, ContactModel, Finger, SoftFinger};

use super::finger::{Elasticity, FingerProfile};
use super::mistake::FitMistake;

/// Largest allowed deviation of springs from a soft finger, as a fraction of the reachable electric friction. For the
/// example finger, this is 6.5 mN of 250 mN, a quarter of the smallest perceptible step of friction (11 %, Gueorguiev
/// 2017).
const DEVIATION_MAX: f64 = 0.05;
/// Number of voltages at which the two are compared.
const VOLTAGES: u32 = 64;
/// Bisection steps: the stiffness is found to the last bit.
const STEPS: u32 = 80;
/// Range of the stiffness, Pa/m.
const STIFFNESS_PA_PER_M: (f64, f64) = (1e3, 1e14);

/// Springs fitted to a finger.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SpringFit {
    pub(super) stiffness_pa_per_m: f64,
    /// Largest deviation from the finger's friction, as a fraction of the reachable electric friction; zero if the
    /// finger has springs itself.
    pub(super) deviation: f64,
}

impl SpringFit {
    /// Fits springs to a finger on an effective gap, at voltages up to the largest.
    pub(super) fn of(profile: &FingerProfile, gap_m: f64, voltage_max_v_rms: f64) -> Result<Self, FitMistake> {
        match profile.elasticity {
            // The law takes their place.
            Elasticity::Empirical(_) => Ok(Self { stiffness_pa_per_m: 0.0, deviation: 0.0 }),
            Elasticity::WinklerFuss { stiffness_pa_per_m } => Ok(Self { stiffness_pa_per_m, deviation: 0.0 }),
            Elasticity::Soft { modulus_pa, stress_exponent, shape_constant } => {
                let finger = SoftFinger {
                    radius_m: 1e-3 * profile.radius_mm,
                    modulus_pa,
                    stress_exponent,
                    shape_constant,
                    friction_coefficient: profile.friction_coefficient,
                };
                let springs = fit(profile, &finger, gap_m, voltage_max_v_rms).ok_or_else(|| FitMistake::Model {
                    reason: "no linear springs match this soft finger at the largest voltage".to_owned(),
                })?;
                Ok(springs)
            }
        }
    }

    /// The mistake if the springs differ too much from their soft finger.
    pub(super) fn mistake(&self) -> Option<FitMistake> {
        let found_percent = 100.0 * self.deviation;
        let mistake = FitMistake::SoftFinger { found_percent, max_percent: 100.0 * DEVIATION_MAX };
        (self.deviation > DEVIATION_MAX).then_some(mistake)
    }
}

fn fit(profile: &FingerProfile, finger: &SoftFinger<f64>, gap_m: f64, voltage_max_v_rms: f64) -> Option<SpringFit> {
    let load_n = profile.normal_load_n;
    let soft = finger.on_gap(gap_m).ok()?.under_load(load_n).ok()?;
    let soft_n = |voltage_v_rms| soft.state(voltage_v_rms).ok().map(|state| state.electric_friction_n);
    let on_springs = |stiffness_pa_per_m| {
        let FingerProfile { friction_coefficient, .. } = *profile;
        let finger = Finger { radius_m: finger.radius_m, stiffness_pa_per_m, friction_coefficient };
        Contact::new(&finger, gap_m).ok()?.under_load(load_n).ok()
    };
    let reach_n = soft_n(voltage_max_v_rms)?;
    // Stiffer springs have less electric friction.
    let (mut least, mut most) = STIFFNESS_PA_PER_M;
    if on_springs(least)?.electric_friction_n(voltage_max_v_rms) < reach_n
        || on_springs(most)?.electric_friction_n(voltage_max_v_rms) > reach_n
    {
        return None;
    }
    for _ in 0..STEPS {
        let middle = (least * most).sqrt();
        let is_stiffer = on_springs(middle)?.electric_friction_n(voltage_max_v_rms) < reach_n;
        if is_stiffer { most = middle } else { least = middle }
    }
    let springs = on_springs(least)?;
    let mut deviation = 0.0_f64;
    for step in 1..=VOLTAGES {
        let voltage_v_rms = voltage_max_v_rms * f64::from(step) / f64::from(VOLTAGES);
        let difference_n = springs.electric_friction_n(voltage_v_rms) - soft_n(voltage_v_rms)?;
        deviation = deviation.max(difference_n.abs() / reach_n);
    }
    Some(SpringFit { stiffness_pa_per_m: least, deviation })
}
