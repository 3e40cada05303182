//! The lower bound: no attraction around the contact, Eqs. (37)-(39), (42).

use super::Contact;
use super::curve::{Point, root_of_quotient};
use crate::error::{InverseError, ParameterError, StateError, finite, found_voltage_v_rms, representable};
use crate::{ContactModel, ContactState, Real, Sensitivity};

/// A contact under a fixed normal load of either sign, attracted only where it touches (variant `wf-lower`).
///
/// `y = q + sqrt(q^2 + n)`: Eq. (37), and without load Eqs. (38), (39), (42). The inverse is `q = (y^2 - n)/(2 y)`.
///
/// Error bounds as for [`LoadedContact`](crate::LoadedContact); with a pull they grow by the condition number, as for
/// [`PulledContact`](crate::PulledContact).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LowerBound<T> {
    contact: Contact<T>,
    natural_friction_n: T,
    n: T,
}

impl<T: Real> LowerBound<T> {
    pub(super) fn new(contact: Contact<T>, normal_load_n: T) -> Result<Self, ParameterError> {
        let n = contact.load(finite("normal_load_n", normal_load_n)?);
        representable("normal_load_n", normal_load_n, n)?;
        Ok(Self { contact, natural_friction_n: contact.friction_coefficient * normal_load_n, n })
    }

    fn point(&self, voltage_v_rms: T) -> Result<Point<T>, StateError> {
        let v = self.contact.scaled_voltage(voltage_v_rms)?;
        Point::lower(v, self.n).ok_or(StateError::NoContact)
    }

    fn inverse(&self, friction_n: T, electric_friction_n: T) -> Result<T, InverseError> {
        if electric_friction_n < T::ZERO || friction_n < T::ZERO {
            return Err(InverseError::BelowNatural);
        }
        if !(electric_friction_n > T::ZERO) {
            return Ok(T::ZERO);
        }
        let scale = self.contact.friction_scale_n;
        let y = root_of_quotient(friction_n, scale);
        let q = electric_friction_n / (scale * y) / T::TWO;
        if q > y {
            return Err(InverseError::Unstable);
        }
        found_voltage_v_rms(self.contact.voltage_scale_v_rms * q.sqrt())
    }
}

impl<T: Real> ContactModel<T> for LowerBound<T> {
    fn natural_friction_n(&self) -> T {
        self.natural_friction_n
    }

    fn state(&self, voltage_v_rms: T) -> Result<ContactState<T>, StateError> {
        self.contact.state_at(&self.point(voltage_v_rms)?)
    }

    fn voltage_for_electric_friction(&self, electric_friction_n: T) -> Result<T, InverseError> {
        let friction_n = self.natural_friction_n + finite("electric_friction_n", electric_friction_n)?;
        self.inverse(friction_n, electric_friction_n)
    }

    /// Computed directly, since the difference from natural friction would lose a friction far below a pull's `mu
    /// |F_N|`.
    fn voltage_for_friction(&self, friction_n: T) -> Result<T, InverseError> {
        let friction_n = finite("friction_n", friction_n)?;
        self.inverse(friction_n, friction_n - self.natural_friction_n)
    }

    fn sensitivity(&self, voltage_v_rms: T) -> Result<Sensitivity<T>, StateError> {
        self.contact.sensitivity_at(&self.point(voltage_v_rms)?)
    }

    fn reachable_friction_n(&self, voltage_max_v_rms: T) -> Result<(T, T), StateError> {
        let least = if self.n < T::ZERO { -self.natural_friction_n } else { self.natural_friction_n };
        Ok((least, self.state(voltage_max_v_rms)?.friction_n))
    }
}
