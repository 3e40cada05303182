//! The soft finger's parameters, and its force law.

use core::f64::consts::PI;

use crate::error::{ParameterError, not_negative, positive, representable, stress_exponent};
use crate::{Real, SoftContact};

/// Exponent `gamma = s/(2 s + 1)` of the contact radius over the force, Eq. (23), for a stress exponent `s` above zero
/// and at most one: from 0 to 1/3. Relative error at most 3 roundings of `T`.
pub fn contact_exponent<T: Real>(stress_exponent_s: T) -> Result<T, ParameterError> {
    let s = stress_exponent(stress_exponent_s)?;
    Ok(s / (T::TWO * s + T::ONE))
}

/// A spherical finger of a power-law material: strain is a power of stress, Eq. (22).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SoftFinger<T> {
    /// Radius of curvature `R` at the contact, in metres.
    pub radius_m: T,
    /// Modulus `E`, in pascals.
    pub modulus_pa: T,
    /// Stress exponent, above zero and at most one. The paper calls it `n`.
    pub stress_exponent: T,
    /// Dimensionless constant `B` of Eq. (24), from experiment.
    pub shape_constant: T,
    /// Coefficient of friction `mu`.
    pub friction_coefficient: T,
}

impl<T: Real> SoftFinger<T> {
    /// Normal force at a contact approach without voltage, in newtons, Eq. (24): `B E R^2 (delta/R)^(1/(2 gamma))`.
    ///
    /// Relative error at most `6 + e (1 + 3 |ln(delta/R)|)` roundings of `T`, with the exponent `e = 1/(2 gamma)`.
    pub fn normal_load_n(&self, approach_m: T) -> Result<T, ParameterError> {
        let forces = self.forces()?;
        let ratio = not_negative("approach_m", approach_m)? / self.radius_m;
        representable("approach_m", approach_m, forces.force_scale_n * ratio.pow(T::ONE / forces.two_gamma))
    }

    /// Equivalent Winkler-Fuss stiffness in Pa/m under a spring force above zero, Eqs. (26), (29):
    /// `B^(4 gamma) E/(pi R) (E R^2/P)^(4 gamma - 1)`.
    ///
    /// The force is the normal load at no voltage, and friction over the coefficient of friction otherwise. Relative
    /// error at most `11 + 3 |ln(P/(B E R^2))|` roundings of `T`.
    pub fn stiffness_pa_per_m(&self, spring_force_n: T) -> Result<T, ParameterError> {
        let forces = self.forces()?;
        let p = positive("spring_force_n", spring_force_n)? / forces.force_scale_n;
        representable("spring_force_n", spring_force_n, forces.stiffness_pa_per_m(p))
    }

    /// The finger on a coating of effective gap `gap_m`.
    pub fn on_gap(&self, gap_m: T) -> Result<SoftContact<T>, ParameterError> {
        SoftContact::new(self, gap_m)
    }

    pub(super) fn forces(&self) -> Result<ForceLaw<T>, ParameterError> {
        let radius: f64 = positive("radius_m", self.radius_m)?.into();
        let modulus: f64 = positive("modulus_pa", self.modulus_pa)?.into();
        let shape: f64 = positive("shape_constant", self.shape_constant)?.into();
        let s: f64 = stress_exponent(self.stress_exponent)?.into();
        positive("friction_coefficient", self.friction_coefficient)?;
        let scale = |value| crate::error::round_to_model("modulus_pa", self.modulus_pa, value);
        Ok(ForceLaw {
            force_scale_n: scale(shape * modulus * radius * radius)?,
            stiffness_scale_pa_per_m: scale(shape * modulus / (PI * radius))?,
            two_gamma: T::from_f64(2.0 * s / (2.0 * s + 1.0)),
            stiffening: T::from_f64((1.0 - 2.0 * s) / (1.0 + 2.0 * s)),
            two_s: T::from_f64(2.0 * s),
        })
    }
}

/// The force law in its own scale: `p = P/(B E R^2) = (a^2/(2 R^2))^(1/(2 gamma))`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct ForceLaw<T> {
    /// `B E R^2`.
    pub(super) force_scale_n: T,
    /// `B E/(pi R)`, the stiffness at `p = 1`.
    pub(super) stiffness_scale_pa_per_m: T,
    pub(super) two_gamma: T,
    /// `1 - 4 gamma`, the exponent of the stiffness over the force.
    pub(super) stiffening: T,
    pub(super) two_s: T,
}

impl<T: Real> ForceLaw<T> {
    pub(super) fn stiffness_pa_per_m(&self, p: T) -> T {
        self.stiffness_scale_pa_per_m * p.pow(self.stiffening)
    }

    /// The stiffness at `p = (2 tau)^(2 s + 1)`, which may be too small for the precision even if the stiffness is not:
    /// `(2 s + 1)(1 - 4 gamma) = 1 - 2 s`.
    pub(super) fn lower_stiffness_pa_per_m(&self, double_tau: T) -> T {
        self.stiffness_scale_pa_per_m * double_tau.pow(T::ONE - self.two_s)
    }
}
