//! The results that every variant of the model provides.

use crate::Real;
use crate::error::{InverseError, StateError};

/// A contact at a voltage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactState<T> {
    /// Contact radius `a`, in metres. Above the finger's radius, the paraboloid no longer resembles the finger.
    pub contact_radius_m: T,
    /// Winkler-Fuss stiffness `k` in Pa/m: the finger's own, or a soft finger's at this friction. Zero for a soft
    /// finger without force.
    pub stiffness_pa_per_m: T,
    /// Friction `F_T` while sliding, in newtons, Eq. (21).
    pub friction_n: T,
    /// Electric friction `F_T - mu F_N`, the friction that the voltage adds, in newtons; computed without cancellation.
    pub electric_friction_n: T,
}

impl<T: Real> ContactState<T> {
    pub(crate) fn in_range(self) -> Result<Self, StateError> {
        let all_finite = self.contact_radius_m.is_finite()
            && self.stiffness_pa_per_m.is_finite()
            && self.friction_n.is_finite()
            && self.electric_friction_n.is_finite();
        if all_finite { Ok(self) } else { Err(StateError::OutOfRange) }
    }
}

/// Derivatives of friction with respect to voltage and load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sensitivity<T> {
    /// `dF_T/dV`, in N/V.
    pub friction_per_volt_n_per_v: T,
    /// `dF_T/dF_N`, in newtons per newton.
    pub friction_per_load: T,
}

impl<T: Real> Sensitivity<T> {
    pub(crate) fn in_range(self) -> Result<Self, StateError> {
        let all_finite = self.friction_per_volt_n_per_v.is_finite() && self.friction_per_load.is_finite();
        if all_finite { Ok(self) } else { Err(StateError::OutOfRange) }
    }
}

/// A contact under a fixed load, as a function of voltage. Every variant of the model implements it.
pub trait ContactModel<T: Real> {
    /// Friction at zero voltage, `mu F_N`, in newtons. One rounding.
    fn natural_friction_n(&self) -> T;

    /// The contact at an rms voltage of zero or more. The implementing type documents the equations and the error
    /// bound.
    fn state(&self, voltage_v_rms: T) -> Result<ContactState<T>, StateError>;

    /// The rms voltage at which the electric friction `F_T - mu F_N` is `electric_friction_n`, in volts. The
    /// implementing type has the equations and the error bound.
    fn voltage_for_electric_friction(&self, electric_friction_n: T) -> Result<T, InverseError>;

    /// The rms voltage at which the friction `F_T` is `friction_n`, in volts.
    ///
    /// The default implementation subtracts the natural friction, which amplifies a relative error of the argument by
    /// `F_T/(F_T - mu F_N)`. A negative friction is below natural.
    fn voltage_for_friction(&self, friction_n: T) -> Result<T, InverseError> {
        let friction_n = crate::error::finite("friction_n", friction_n)?;
        self.voltage_for_electric_friction(friction_n - self.natural_friction_n())
    }

    /// The derivatives of friction with respect to voltage and load: relative error at most 4e-14 in f64, 1e-5 in f32.
    fn sensitivity(&self, voltage_v_rms: T) -> Result<Sensitivity<T>, StateError>;

    /// Smallest and largest friction from no voltage to `voltage_max_v_rms`, in newtons. If the contact needs a voltage
    /// to exist, the range starts at that voltage.
    fn reachable_friction_n(&self, voltage_max_v_rms: T) -> Result<(T, T), StateError> {
        Ok((self.state(T::ZERO)?.friction_n, self.state(voltage_max_v_rms)?.friction_n))
    }
}
