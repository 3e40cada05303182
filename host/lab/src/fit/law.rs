//! The laws that are fitted: how strongly a voltage attracts the finger.
//!
//! A law gives the **attraction**, the normal load in newtons that would add as much friction as the voltage does:
//! electric friction is the friction coefficient times the attraction.

use core::f64::consts::PI;

use frixel_model::{Contact, Finger, ParameterError, Ripple, VACUUM_PERMITTIVITY_F_PER_M};

/// Radius of curvature of every fitted finger, in metres: a convention, which friction data cannot contradict.
pub(super) const CONVENTIONAL_RADIUS_M: f64 = 8e-3;
/// Winkler-Fuss stiffness of every fitted finger, in Pa/m: a convention, which friction data cannot contradict.
pub(super) const CONVENTIONAL_STIFFNESS_PA_PER_M: f64 = 1.8e7;

/// Voltage at which the power law states its attraction, in volts rms.
pub(super) const REFERENCE_V_RMS: f64 = 150.0;

/// The one number that friction data give about electrode, skin and gap, in `sqrt(N)/V^2`:
/// `coupling = eps0/(2 g^2) sqrt(pi R/k)`.
///
/// Under a load that dominates (`n` far above 1) the model of Eqs. (43), (21) becomes
/// `attraction = F_N (exp(2 asinh c) - 1)` with `c = coupling V^2/sqrt(F_N)`: radius, stiffness and gap appear in
/// `coupling` alone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Coupling(pub(super) f64);

impl Coupling {
    /// The coupling at which a voltage has this attraction under a dominating load.
    pub(super) fn of_attraction(attraction_n: f64, voltage_v_rms: f64, normal_load_n: f64) -> Self {
        let c = libm::sinh(0.5 * libm::log1p(attraction_n / normal_load_n));
        Self(c * normal_load_n.sqrt() / (voltage_v_rms * voltage_v_rms))
    }

    /// Effective gap in metres that gives this coupling to a finger of conventional radius and stiffness.
    pub(super) fn gap_m(self) -> f64 {
        let shape = (PI * CONVENTIONAL_RADIUS_M / CONVENTIONAL_STIFFNESS_PA_PER_M).sqrt();
        (VACUUM_PERMITTIVITY_F_PER_M / (2.0 * self.0) * shape).sqrt()
    }

    /// The contact of a finger of conventional radius and stiffness, and of friction coefficient 1, so that its
    /// electric friction is the attraction.
    pub(super) fn contact(self) -> Result<Contact<f64>, ParameterError> {
        let finger = Finger {
            radius_m: CONVENTIONAL_RADIUS_M,
            stiffness_pa_per_m: CONVENTIONAL_STIFFNESS_PA_PER_M,
            friction_coefficient: 1.0,
        };
        Contact::new(&finger, self.gap_m())
    }
}

/// A law of attraction with its parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Attraction {
    /// Eqs. (43), (21) of the contact model, as the mean under a carrier with this ripple.
    Contact(Coupling, Ripple),
    /// `attraction = reference_n (V/150 V)^voltage_exponent (F_N/reference_load_n)^load_exponent`: the alternative that
    /// the model is tested against.
    Power { reference_n: f64, voltage_exponent: f64, load_exponent: f64, reference_load_n: f64 },
}

impl Attraction {
    /// The power of the voltage with which a power law grows.
    pub(super) fn voltage_exponent(&self) -> Option<f64> {
        match *self {
            Self::Power { voltage_exponent, .. } => Some(voltage_exponent),
            Self::Contact(..) => None,
        }
    }

    /// The attraction at each pair of voltage (volts rms, above zero) and normal load (newtons, above zero); `None` if
    /// the parameters are outside of the model's range.
    pub(super) fn at(&self, points: impl Iterator<Item = (f64, f64)>) -> Option<Vec<f64>> {
        match *self {
            Self::Contact(coupling, ripple) => {
                let contact = coupling.contact().ok()?;
                points
                    .map(|(voltage_v_rms, load_n)| {
                        let contact = contact.under_load(load_n).ok()?.under_carrier(ripple);
                        Some(contact.electric_friction_n(voltage_v_rms))
                    })
                    .collect()
            }
            Self::Power { reference_n, voltage_exponent, load_exponent, reference_load_n } => Some(
                points
                    .map(|(voltage_v_rms, load_n)| {
                        let by_voltage = libm::pow(voltage_v_rms / REFERENCE_V_RMS, voltage_exponent);
                        reference_n * by_voltage * libm::pow(load_n / reference_load_n, load_exponent)
                    })
                    .collect(),
            ),
        }
    }

    /// The attraction at one voltage and load; `None` as for [`at`](Self::at).
    pub(super) fn attraction_n(&self, voltage_v_rms: f64, normal_load_n: f64) -> Option<f64> {
        self.at(core::iter::once((voltage_v_rms, normal_load_n)))?.first().copied()
    }
}

#[cfg(test)]
mod tests {
    use super::{Attraction, Coupling, Ripple};

    #[test]
    fn one_number_gives_the_attraction_under_a_dominating_load() {
        for gap_m in [3e-6_f64, 5e-6, 10e-6] {
            let shape = (core::f64::consts::PI * 8e-3 / 1.8e7_f64).sqrt();
            let coupling = Coupling(frixel_model::VACUUM_PERMITTIVITY_F_PER_M / (2.0 * gap_m * gap_m) * shape);
            assert!((coupling.gap_m() / gap_m - 1.0).abs() < 1e-12);
            let model_n = Attraction::Contact(coupling, Ripple::NONE).attraction_n(150.0, 0.5).unwrap();
            let again = Coupling::of_attraction(model_n, 150.0, 0.5);
            // The approximation leaves out what attracts around the contact.
            assert!((again.0 / coupling.0 - 1.0).abs() < 3e-3, "{gap_m}: {again:?} {coupling:?}");
        }
    }

    #[test]
    fn gaps_of_ten_and_five_micrometres_have_the_friction_of_the_notes() {
        for (gap_m, electric_n) in [(10e-6, 27.8e-3), (5e-6, 129.8e-3)] {
            let shape = (core::f64::consts::PI * 8e-3 / 1.8e7_f64).sqrt();
            let coupling = Coupling(frixel_model::VACUUM_PERMITTIVITY_F_PER_M / (2.0 * gap_m * gap_m) * shape);
            let found_n = 0.5 * Attraction::Contact(coupling, Ripple::NONE).attraction_n(150.0, 0.5).unwrap();
            assert!((found_n / electric_n - 1.0_f64).abs() < 0.01, "{found_n}");
        }
    }
}
