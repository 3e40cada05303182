//! A finger on Winkler-Fuss springs.

use core::f64::consts::PI;

use crate::Real;
use crate::error::{ParameterError, not_negative, positive, representable};

/// A paraboloid finger, Eq. (1), on springs of constant stiffness, Eq. (10).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Finger<T> {
    /// Radius of curvature `R` at the contact, in metres.
    pub radius_m: T,
    /// Winkler-Fuss stiffness `k`, in Pa/m.
    pub stiffness_pa_per_m: T,
    /// Coefficient of friction `mu`.
    pub friction_coefficient: T,
}

impl Finger<f64> {
    /// The finger of this crate's examples. Its values are assumed; `scenes/fingers/example.toml` gives the reasons.
    pub const EXAMPLE: Self = Self { radius_m: 8e-3, stiffness_pa_per_m: 1.8e7, friction_coefficient: 0.5 };
}

impl Finger<f32> {
    /// The finger of this crate's examples, in `f32`.
    pub const EXAMPLE: Self = Self {
        radius_m: Finger::<f64>::EXAMPLE.radius_m as f32,
        stiffness_pa_per_m: Finger::<f64>::EXAMPLE.stiffness_pa_per_m as f32,
        friction_coefficient: Finger::<f64>::EXAMPLE.friction_coefficient as f32,
    };
}

impl<T: Real> Finger<T> {
    pub(crate) fn validate(&self) -> Result<(), ParameterError> {
        positive("radius_m", self.radius_m)?;
        positive("stiffness_pa_per_m", self.stiffness_pa_per_m)?;
        positive("friction_coefficient", self.friction_coefficient)?;
        Ok(())
    }

    /// Height of the undeformed finger above its lowest point, in metres, Eq. (1): `r^2/(2R)`, for any finite distance
    /// `r` from the axis. Relative error at most 3 roundings of `T`.
    pub fn profile_m(&self, radius_from_axis_m: T) -> T {
        radius_from_axis_m * radius_from_axis_m / (T::TWO * self.radius_m)
    }

    /// Normal force at a contact approach of zero or more without voltage, in newtons, Eq. (25): `pi k R delta^2`.
    /// Relative error at most 6 roundings of `T`.
    pub fn normal_load_n(&self, approach_m: T) -> Result<T, ParameterError> {
        self.validate()?;
        let approach_m = not_negative("approach_m", approach_m)?;
        let spring_force_n = T::from_f64(PI) * self.stiffness_pa_per_m * self.radius_m * approach_m * approach_m;
        representable("approach_m", approach_m, spring_force_n)
    }

    /// Contact approach `delta` in metres, Eqs. (15), (17): `a^2/(2R) - sigma0/k`. Below zero when the attraction alone
    /// stretches the finger to the screen. Error at most 4 roundings of the greater term.
    pub fn approach_m(&self, contact_radius_m: T, contact_attraction_pa: T) -> Result<T, ParameterError> {
        self.validate()?;
        let contact_radius_m = not_negative("contact_radius_m", contact_radius_m)?;
        let stretch_m = not_negative("contact_attraction_pa", contact_attraction_pa)? / self.stiffness_pa_per_m;
        representable("contact_radius_m", contact_radius_m, self.profile_m(contact_radius_m) - stretch_m)
    }

    /// Contact pressure at a distance from the axis, in pascals, Eqs. (14), (17): `k (a^2 - r^2)/(2R)`; zero outside.
    /// Relative error at most 6 roundings of `T`.
    ///
    /// Over the contact it adds up to the friction of Eqs. (20), (21) divided by the coefficient of friction.
    pub fn contact_pressure_pa(&self, contact_radius_m: T, radius_from_axis_m: T) -> Result<T, ParameterError> {
        self.validate()?;
        let a = not_negative("contact_radius_m", contact_radius_m)?;
        let r = not_negative("radius_from_axis_m", radius_from_axis_m)?.min(a);
        let pressure_pa = self.stiffness_pa_per_m * (a - r) * (a + r) / (T::TWO * self.radius_m);
        representable("contact_radius_m", contact_radius_m, pressure_pa)
    }
}
