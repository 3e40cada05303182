//! The contact under a load of zero or more, Eqs. (36), (43), (21): infallible and without iteration.

use core::f64::consts::PI;

use super::Contact;
use super::curve::{Point, root_of_quotient, upper_inverse};
use crate::coating::VACUUM_PERMITTIVITY_F_PER_M;
use crate::double_single::DoubleSingle;
use crate::error::{
    InverseError, ParameterError, StateError, checked_target_n, found_voltage_v_rms, not_negative, representable,
};
use crate::{ContactModel, ContactState, Finger, Real, Sensitivity};

/// A contact under a fixed normal load of zero or more, with the attraction around it up to any distance.
///
/// Without load this is the paper's upper bound (variant `wf-upper`), Eqs. (34), (36); with a load it is `wf-loaded`,
/// Eqs. (43), (21). Forward and inverse are in closed form.
///
/// Error bounds, for `q` from 1e-12 to 1e12 and `n` zero or 1e-6 to 1e8, and beyond while the result is a normal
/// number: 4e-15 in f64 and 1e-6 in f32, relative to the electric friction, the friction and the voltage.
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

    /// Normal load in newtons. Two roundings.
    pub(crate) fn normal_load_n(&self) -> T {
        self.natural_friction_n / (self.contact.friction_scale_n / self.contact.load_scale_n)
    }

    /// `V/V*` of a voltage, and `n`.
    pub(super) fn scaled(&self, voltage_v_rms: T) -> (T, T) {
        (voltage_v_rms / self.contact.voltage_scale_v_rms, self.n)
    }

    /// Electric friction `x = F_T - mu F_N` in newtons at a finite rms voltage of zero or more, Eqs. (43), (21).
    ///
    /// [`ContactModel::state`] computes the same value and checks its argument and result.
    #[inline]
    pub fn electric_friction_n(&self, voltage_v_rms: T) -> T {
        let point = Point::upper(voltage_v_rms / self.contact.voltage_scale_v_rms, self.n);
        point.map_or(T::ZERO, |point| point.electric_friction(self.contact.friction_scale_n))
    }

    /// The rms voltage for a finite electric friction, in volts; zero for a friction of zero or less and for NaN.
    ///
    /// [`ContactModel::voltage_for_electric_friction`] computes the same value and checks its argument and result.
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

impl LoadedContact<f64> {
    /// Converts the contact to [`DoubleSingle`], for building a table.
    pub(crate) fn in_double_single(&self) -> LoadedContact<DoubleSingle> {
        let number = DoubleSingle::from_f64;
        let Contact { voltage_scale_v_rms, friction_scale_n, load_scale_n, area_scale_m2, .. } = self.contact;
        LoadedContact {
            contact: Contact {
                voltage_scale_v_rms: number(voltage_scale_v_rms),
                friction_scale_n: number(friction_scale_n),
                load_scale_n: number(load_scale_n),
                area_scale_m2: number(area_scale_m2),
                radius_m: number(self.contact.radius_m),
                stiffness_pa_per_m: number(self.contact.stiffness_pa_per_m),
                friction_coefficient: number(self.contact.friction_coefficient),
            },
            natural_friction_n: number(self.natural_friction_n),
            n: number(self.n),
        }
    }
}

impl LoadedContact<DoubleSingle> {
    /// Creates the contact as [`Contact::new`] and [`Contact::under_load`] do, from `f32` parameters sent to a board;
    /// `None` if they are out of range.
    pub(crate) fn of_finger(finger: &Finger<f32>, gap_m: f32, normal_load_n: f32) -> Option<Self> {
        let Finger { radius_m, stiffness_pa_per_m, friction_coefficient } = *finger;
        let in_range = |value: f32| (f32::MIN_POSITIVE..=f32::MAX).contains(&value);
        let given = [radius_m, stiffness_pa_per_m, friction_coefficient, gap_m];
        if !(given.into_iter().all(in_range) && normal_load_n >= 0.0) {
            return None;
        }
        let [radius_m, stiffness_pa_per_m, friction_coefficient, g] = given.map(DoubleSingle::from);
        let normal_load_n = DoubleSingle::from(normal_load_n);
        // Multiplied from the left, no intermediate product comes close to the smallest number.
        let load_scale_n = DoubleSingle::from_f64(PI) * stiffness_pa_per_m * radius_m * g * g;
        let square = stiffness_pa_per_m * g * DoubleSingle::from_f64(2.0 / VACUUM_PERMITTIVITY_F_PER_M);
        let contact = Contact {
            voltage_scale_v_rms: square.sqrt() * g,
            friction_scale_n: friction_coefficient * load_scale_n,
            load_scale_n,
            area_scale_m2: DoubleSingle::TWO * radius_m * g,
            radius_m,
            stiffness_pa_per_m,
            friction_coefficient,
        };
        let natural_friction_n = friction_coefficient * normal_load_n;
        let n = contact.load(normal_load_n);
        let scales = [contact.voltage_scale_v_rms, contact.friction_scale_n, load_scale_n];
        let fits = scales.into_iter().all(|scale| in_range(scale.to_f32()));
        (fits && natural_friction_n.is_finite() && n.is_finite()).then_some(Self { contact, natural_friction_n, n })
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
        found_voltage_v_rms(self.voltage_v_rms(checked_target_n(electric_friction_n)?))
    }

    fn sensitivity(&self, voltage_v_rms: T) -> Result<Sensitivity<T>, StateError> {
        let v = self.contact.scaled_voltage(voltage_v_rms)?;
        self.contact.sensitivity_at(&Point::upper(v, self.n).ok_or(StateError::OutOfRange)?)
    }
}
