//! Fingers of power-law shape, Eqs. (45)-(47).

use crate::Real;
use crate::error::{ParameterError, at_least_one, not_negative, positive, representable, stress_exponent};

/// A finger of the shape `Lambda r^lambda` and of a power-law material, in Borodich's self-similar contact without
/// voltage.
///
/// With `lambda = 2` and `Lambda = 1/(2 R)` this is the paraboloid of Eq. (1), and Eq. (47) the law of Eq. (24).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PowerLawShape<T> {
    exponent: T,
    coefficient: T,
    stress_exponent: T,
}

impl<T: Real> PowerLawShape<T> {
    /// A shape with exponent `lambda >= 1`, coefficient `Lambda > 0` in `m^(1 - lambda)`, and the material's stress
    /// exponent, above zero and at most one.
    pub fn new(exponent: T, coefficient: T, material_stress_exponent: T) -> Result<Self, ParameterError> {
        Ok(Self {
            exponent: at_least_one("exponent", exponent)?,
            coefficient: positive("coefficient", coefficient)?,
            stress_exponent: stress_exponent(material_stress_exponent)?,
        })
    }

    /// Height of the undeformed finger above its lowest point, in metres, Eq. (45).
    ///
    /// The distance from the axis is zero or more. Relative error at most 3 roundings of `T`.
    pub fn profile_m(&self, radius_from_axis_m: T) -> Result<T, ParameterError> {
        let radius_m = not_negative("radius_from_axis_m", radius_from_axis_m)?;
        representable("radius_from_axis_m", radius_m, self.coefficient * radius_m.pow(self.exponent))
    }

    /// Exponent of the contact radius over the load, Eq. (46): `s/(2 s + lambda - 1)`. Relative error at most 3
    /// roundings of `T`.
    pub fn contact_radius_exponent(&self) -> T {
        self.stress_exponent / (T::TWO * self.stress_exponent + (self.exponent - T::ONE))
    }

    /// Contact radius in metres, Eq. (46), from the one under one newton, above zero, under a load of zero or more.
    ///
    /// Relative error at most 8 roundings of `T` times one plus the logarithm of the load.
    pub fn contact_radius_m(&self, normal_load_n: T, radius_at_one_newton_m: T) -> Result<T, ParameterError> {
        let load = not_negative("normal_load_n", normal_load_n)?;
        let unit = positive("radius_at_one_newton_m", radius_at_one_newton_m)?;
        representable("normal_load_n", load, unit * load.pow(self.contact_radius_exponent()))
    }

    /// Contact approach in metres, Eq. (47), from the one under one newton. Error as for [`Self::contact_radius_m`].
    pub fn approach_m(&self, normal_load_n: T, approach_at_one_newton_m: T) -> Result<T, ParameterError> {
        let load = not_negative("normal_load_n", normal_load_n)?;
        let unit = positive("approach_at_one_newton_m", approach_at_one_newton_m)?;
        representable("normal_load_n", load, unit * load.pow(self.exponent * self.contact_radius_exponent()))
    }
}
