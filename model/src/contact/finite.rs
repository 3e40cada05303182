//! The contact of a finger with an outer radius, Eqs. (19), (21).

use super::Contact;
use super::curve::{Point, root_of_quotient, upper_inverse};
use crate::error::{
    Expected, InverseError, ParameterError, StateError, checked_target_n, found_voltage_v_rms, not_negative, positive,
    representable,
};
use crate::root::{Step, rising_root};
use crate::{ContactModel, ContactState, Real, Sensitivity};

/// A contact under a fixed normal load of zero or more, with the attraction around it up to an outer radius `b`
/// (variant `wf-finite`).
///
/// With `beta = b^2/(2 R g)`, `w = 1/(1 + q)` and `h = 1/(1 + q + beta - y)`, Eq. (19) is `y^2 - 2 q y - 2 q (w - h) -
/// n = 0`. It has exactly one root up to `beta` when the contact does not pass `b`, and none otherwise. Forward
/// and inverse search for it in the bracket between the two bounds: at most 142 steps, usually four or five.
///
/// Error bounds, for `q` from 1e-12 to 1e12: 4e-14 in f64 and 1e-6 in f32.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FiniteContact<T> {
    contact: Contact<T>,
    outer_radius_m: T,
    natural_friction_n: T,
    n: T,
    beta: T,
}

/// Rounding tolerance for a contact that reaches the outer radius, in multiples of [`Real::EPSILON`], relative to
/// `beta`.
const SLACK: f32 = 8.0;

impl<T: Real> FiniteContact<T> {
    pub(super) fn new(contact: Contact<T>, outer_radius_m: T, normal_load_n: T) -> Result<Self, ParameterError> {
        let n = contact.load(not_negative("normal_load_n", normal_load_n)?);
        let beta = contact.area(positive("outer_radius_m", outer_radius_m)?);
        representable("normal_load_n", normal_load_n, n)?;
        if !(beta >= T::MIN_POSITIVE && beta.is_finite()) {
            let found = outer_radius_m.into();
            return Err(ParameterError { parameter: "outer_radius_m", expected: Expected::Representable, found });
        }
        let natural_friction_n = contact.friction_coefficient * normal_load_n;
        Ok(Self { contact, outer_radius_m, natural_friction_n, n, beta })
    }

    /// Capacitance between electrode and finger at a voltage, in farads: [`Contact::capacitance_f`] for this contact.
    pub fn capacitance_f(&self, voltage_v_rms: T) -> Result<T, StateError> {
        let contact_radius_m = self.state(voltage_v_rms)?.contact_radius_m.min(self.outer_radius_m);
        Ok(self.contact.capacitance_f(contact_radius_m, voltage_v_rms, self.outer_radius_m)?)
    }

    /// `v` and `y` at a voltage.
    fn solve(&self, voltage_v_rms: T) -> Result<(T, T), StateError> {
        let v = self.contact.scaled_voltage(voltage_v_rms)?;
        let (n, beta) = (self.n, self.beta);
        let q = v * v;
        if beta - T::TWO * q - n / beta < -(T::from(SLACK) * T::EPSILON * beta) {
            return Err(StateError::PassesOuterRadius);
        }
        let low = Point::lower(v, n).ok_or(StateError::OutOfRange)?.y.min(beta);
        let high = Point::upper(v, n).ok_or(StateError::OutOfRange)?.y.min(beta);
        if !(low > T::ZERO) || !(high > low) {
            return Ok((v, low));
        }
        let around = T::ONE / (T::ONE + q);
        // The balance divided by y rises. Newton's step is that of the undivided balance, which is convex.
        let root = rising_root(low, high, high, |y| {
            let rest = beta - y;
            let beyond = T::ONE / (T::ONE + q + rest);
            // Both factors are below one; the product of q and the remaining part of beta may overflow.
            let residual = y - T::TWO * q - (n + T::TWO * (q * around) * (rest * beyond)) / y;
            let slope = T::TWO * (T::ONE - q / y + q * beyond * beyond / y);
            Step { residual, next: y - residual / slope }
        });
        Ok((v, root.map_err(|_| StateError::NotConverged)?))
    }
}

impl<T: Real> ContactModel<T> for FiniteContact<T> {
    fn natural_friction_n(&self) -> T {
        self.natural_friction_n
    }

    fn state(&self, voltage_v_rms: T) -> Result<ContactState<T>, StateError> {
        let (v, y) = self.solve(voltage_v_rms)?;
        let q = v * v;
        let rest = (self.beta - y).max(T::ZERO);
        let around = rest / (T::ONE + q) / (T::ONE + q + rest);
        let electric_friction_n = self.contact.friction_scale_n * v * v * (T::TWO * (y + around));
        ContactState {
            contact_radius_m: self.contact.contact_radius_m(y),
            stiffness_pa_per_m: self.contact.stiffness_pa_per_m,
            friction_n: self.natural_friction_n + electric_friction_n,
            electric_friction_n,
        }
        .in_range()
    }

    fn voltage_for_electric_friction(&self, electric_friction_n: T) -> Result<T, InverseError> {
        let electric_friction_n = checked_target_n(electric_friction_n)?;
        let scale = self.contact.friction_scale_n;
        let y = root_of_quotient(self.natural_friction_n + electric_friction_n, scale);
        if y > self.beta * (T::ONE + T::from(SLACK) * T::EPSILON) {
            return Err(InverseError::PassesOuterRadius);
        }
        if !(electric_friction_n > T::ZERO) {
            return Ok(T::ZERO);
        }
        let rest = (self.beta - y).max(T::ZERO);
        let r = electric_friction_n / (scale * y);
        // More attraction around the contact needs less voltage: attraction to any distance, and none, are the bounds.
        let least_v = upper_inverse(y, r);
        let (low, high) = (least_v * least_v, r / T::TWO);
        let root = rising_root(low.min(high), high, low, |q| {
            let (around, beyond) = (T::ONE / (T::ONE + q), T::ONE / (T::ONE + q + rest));
            let share = rest / y * around * beyond;
            let residual = T::TWO * q * (T::ONE + share) - r;
            let slope = T::TWO * (T::ONE + share * (T::ONE - q * around - q * beyond));
            Step { residual, next: q - residual / slope }
        });
        let q = root.map_err(|_| InverseError::NotConverged)?;
        found_voltage_v_rms(self.contact.voltage_scale_v_rms * q.sqrt())
    }

    fn sensitivity(&self, voltage_v_rms: T) -> Result<Sensitivity<T>, StateError> {
        let (v, y) = self.solve(voltage_v_rms)?;
        let q = v * v;
        let rest = (self.beta - y).max(T::ZERO);
        let (around, beyond) = (T::ONE / (T::ONE + q), T::ONE / (T::ONE + q + rest));
        let margin = y - q + q * beyond * beyond;
        if !(margin > T::ZERO) {
            return self.contact.sensitivity_of(v, T::ZERO, T::ONE);
        }
        let steepness = y / margin;
        // w^2 - h (1 - q h), without the cancellation when the contact reaches the outer radius.
        let growth = rest * around * beyond * (T::ONE - q * (around + beyond));
        self.contact.sensitivity_of(v, (y + growth) * steepness, steepness)
    }
}
