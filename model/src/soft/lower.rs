//! The soft finger's lower bound, Eqs. (40), (41).

use super::contact::SoftContact;
use crate::error::{InverseError, StateError, checked_target_n, found_voltage_v_rms};
use crate::{ContactModel, ContactState, Real, Sensitivity};

/// A soft finger without load, attracted only where it touches (variant `soft-lower`).
///
/// `F_T = mu B E R^2 (2 tau)^(2 s + 1)` and `a^2 = 2 R^2 (2 tau)^(2 s)`, with `tau = pi sigma0/(B E)` and the stress
/// exponent `s`: Eqs. (40), (41). Forward and inverse are in closed form.
///
/// Error bounds, for stress exponents from 0.02 to 1: 4e-14 in f64 and 1e-5 in f32.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SoftLowerBound<T> {
    contact: SoftContact<T>,
    friction_scale_n: T,
}

impl<T: Real> SoftLowerBound<T> {
    pub(super) fn new(contact: SoftContact<T>) -> Self {
        Self { contact, friction_scale_n: contact.finger.friction_coefficient * contact.forces.force_scale_n }
    }
}

impl<T: Real> ContactModel<T> for SoftLowerBound<T> {
    fn natural_friction_n(&self) -> T {
        T::ZERO
    }

    fn state(&self, voltage_v_rms: T) -> Result<ContactState<T>, StateError> {
        let double_tau = T::TWO * self.contact.stress(voltage_v_rms)?;
        let area = double_tau.pow(self.contact.forces.two_s);
        // Multiply by the scale first: without it the product may overflow or underflow where the friction does not.
        let friction_n = self.friction_scale_n * double_tau * area;
        let stiffness_pa_per_m =
            if double_tau > T::ZERO { self.contact.forces.lower_stiffness_pa_per_m(double_tau) } else { T::ZERO };
        ContactState {
            contact_radius_m: self.contact.contact_radius_m(area),
            stiffness_pa_per_m,
            friction_n,
            electric_friction_n: friction_n,
        }
        .in_range()
    }

    fn voltage_for_electric_friction(&self, electric_friction_n: T) -> Result<T, InverseError> {
        let p = checked_target_n(electric_friction_n)? / self.friction_scale_n;
        // (2 s + 1)(1 - 2 gamma) = 1.
        let double_tau = p.pow(T::ONE - self.contact.forces.two_gamma);
        found_voltage_v_rms(self.contact.voltage_scale_v_rms * (double_tau / T::TWO).sqrt())
    }

    /// The derivative with respect to load is the limit for a vanishing load.
    fn sensitivity(&self, voltage_v_rms: T) -> Result<Sensitivity<T>, StateError> {
        let exponent = T::ONE + self.contact.forces.two_s;
        let friction_n = self.state(voltage_v_rms)?.friction_n;
        let friction_per_volt_n_per_v =
            if friction_n > T::ZERO { T::TWO * exponent * friction_n / voltage_v_rms } else { T::ZERO };
        Sensitivity {
            friction_per_volt_n_per_v,
            friction_per_load: self.contact.finger.friction_coefficient * exponent,
        }
        .in_range()
    }
}
