//! The contact under a load of zero or more, Eqs. (36), (43), (21): infallible and without iteration.

use super::Contact;
use super::curve::{Point, root_of_quotient, upper_inverse};
use crate::error::{
    InverseError, ParameterError, StateError, found_voltage_v_rms, not_negative, representable,
    wanted_electric_friction_n,
};
use crate::{ContactModel, ContactState, Real, Sensitivity};

/// A contact under a fixed normal load of zero or more, the attraction around it counted to any distance.
///
/// Without load this is the paper's upper bound (variant `wf-upper`), Eqs. (34), (36); with it `wf-loaded`, Eqs. (43),
/// (21). Forward and inverse are in closed form.
///
/// Error bounds, for `q` from 1e-12 to 1e12 and `n` zero or 1e-6 to 1e8, and beyond as far as the answer is a normal
/// number: 4e-15 in f64 and 1e-6 in f32, relative to the electric friction, the friction and the voltage alike.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoadedContact<T> {
    contact: Contact<T>,
    natural_friction_n: T,
    n: T,
}

impl<T: Real> LoadedContact<T> {
    pub(super) fn new(contact: Contact<T>, normal_load_n: T) -> Result<Self, ParameterError> {
        let n = contact.load(not_negative("normal_load_n", normal_load_n)?);
        representable("normal_load_n", normal_load_n, n)?;
        Ok(Self { contact, natural_friction_n: contact.friction_coefficient * normal_load_n, n })
    }

    /// The scales of this contact.
    pub fn contact(&self) -> &Contact<T> {
        &self.contact
    }

    /// Friction at no voltage, `mu F_N`, in newtons. One rounding.
    pub fn natural_friction_n(&self) -> T {
        self.natural_friction_n
    }

    /// Electric friction `x = F_T - mu F_N` in newtons at a finite rms voltage of zero or more, Eqs. (43), (21).
    ///
    /// [`ContactModel::state`] is the same with its argument and its answer checked.
    #[inline]
    pub fn electric_friction_n(&self, voltage_v_rms: T) -> T {
        let point = Point::upper(voltage_v_rms / self.contact.voltage_scale_v_rms, self.n);
        point.map_or(T::ZERO, |point| point.electric_friction(self.contact.friction_scale_n))
    }

    /// The rms voltage that gives a finite electric friction, in volts; zero for a friction of zero or less and for
    /// not-a-number.
    ///
    /// [`ContactModel::voltage_for_electric_friction`] is the same with its argument and its answer checked.
    #[inline]
    pub fn voltage_v_rms(&self, electric_friction_n: T) -> T {
        if !(electric_friction_n > T::ZERO) {
            return T::ZERO;
        }
        let scale = self.contact.friction_scale_n;
        let y = root_of_quotient(self.natural_friction_n + electric_friction_n, scale);
        self.contact.voltage_scale_v_rms * upper_inverse(y, electric_friction_n / (scale * y))
    }
}

impl<T: Real> ContactModel<T> for LoadedContact<T> {
    fn natural_friction_n(&self) -> T {
        self.natural_friction_n
    }

    fn state(&self, voltage_v_rms: T) -> Result<ContactState<T>, StateError> {
        let v = self.contact.scaled_voltage(voltage_v_rms)?;
        let point = Point::upper(v, self.n).ok_or(StateError::OutOfRange)?;
        let state = self.contact.state_at(&point)?;
        ContactState { friction_n: self.natural_friction_n + state.electric_friction_n, ..state }.in_range()
    }

    fn voltage_for_electric_friction(&self, electric_friction_n: T) -> Result<T, InverseError> {
        found_voltage_v_rms(self.voltage_v_rms(wanted_electric_friction_n(electric_friction_n)?))
    }

    fn sensitivity(&self, voltage_v_rms: T) -> Result<Sensitivity<T>, StateError> {
        let v = self.contact.scaled_voltage(voltage_v_rms)?;
        self.contact.sensitivity_at(&Point::upper(v, self.n).ok_or(StateError::OutOfRange)?)
    }
}
