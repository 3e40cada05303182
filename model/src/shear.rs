//! The sheared spring of Section VI.B, Eq. (48), which explains why the contact shrinks when sliding begins.

use crate::Real;
use crate::error::{Expected, ParameterError, StateError, positive};
use crate::root::{Step, rising_root};

/// A spring of the tissue, a gap above the screen, drawn down by an attraction and then sheared.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TissueSpring<T> {
    /// Stiffness `k` of the spring, in N/m.
    pub stiffness_n_per_m: T,
    /// Undeformed length `l`, in metres.
    pub length_m: T,
    /// Gap `h` below the undeformed spring, in metres.
    pub gap_m: T,
    /// Coefficient of friction `mu`.
    pub friction_coefficient: T,
}

/// The spring at the onset of slip.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShearOnset<T> {
    /// Angle `phi` between spring and vertical, in radians, Eq. (48).
    pub angle_rad: T,
    /// Displacement `v = h (1 + l/h) tan(phi)`, in metres.
    pub displacement_m: T,
    /// Support reaction `N` at the onset, in newtons.
    pub normal_reaction_n: T,
    /// Tangential force `F_x = mu N`, in newtons.
    pub tangential_force_n: T,
    /// Support reaction `N0 = F_a - k h` before shearing, in newtons.
    pub initial_reaction_n: T,
}

impl<T: Real> TissueSpring<T> {
    /// The onset of slip under an attraction in newtons that brings the spring into contact, `F_a >= k h`.
    ///
    /// Solved for the tangent of the angle, `t/mu + c (1 + t/mu)/chi = F_a/(k h) - 1` with `c = 1 - cos(phi)` in the
    /// form that does not cancel, in a bracket: at most 142 steps, usually six. Relative error at most 4e-15 in f64
    /// and 1e-6 in f32, times `F_a/(F_a - k h)`.
    pub fn onset(&self, attraction_n: T) -> Result<ShearOnset<T>, StateError> {
        let k = positive("stiffness_n_per_m", self.stiffness_n_per_m)?;
        let l = positive("length_m", self.length_m)?;
        let h = positive("gap_m", self.gap_m)?;
        let mu = positive("friction_coefficient", self.friction_coefficient)?;
        let initial_reaction_n = positive("attraction_n", attraction_n)? - k * h;
        if initial_reaction_n < T::ZERO {
            return Err(StateError::NoContact);
        }
        let chi = h / l;
        let excess = initial_reaction_n / (k * h);
        if !(chi > T::ZERO && chi.is_finite() && excess.is_finite()) {
            let found = attraction_n.into();
            return Err(ParameterError { parameter: "attraction_n", expected: Expected::Representable, found }.into());
        }
        let high = mu * excess;
        let tangent = if high > T::ZERO {
            let root = rising_root(T::ZERO, high, high, |t| {
                let secant = secant(t);
                let shortening = t / secant * (t / (secant + T::ONE));
                let grip = T::ONE + t / mu;
                let residual = t / mu + shortening / chi * grip - excess;
                // d(1 - cos)/d(tan) = sin cos^2 = t/sec^3.
                let slope = (T::ONE + shortening / chi) / mu + t / secant / secant / secant / chi * grip;
                Step { residual, next: t - residual / slope }
            });
            root.map_err(|_| StateError::NotConverged)?
        } else {
            T::ZERO
        };
        // Vertical part of the tension k (L - l): h (1 + l (1 - cos)/h), and its tangential part by the tangent.
        let secant = secant(tangent);
        let shortening = tangent / secant * (tangent / (secant + T::ONE));
        let tangential_force_n = k * (h + l * shortening) * tangent;
        let onset = ShearOnset {
            angle_rad: tangent.atan(),
            displacement_m: (h + l) * tangent,
            normal_reaction_n: if tangent > T::ZERO { tangential_force_n / mu } else { T::ZERO },
            tangential_force_n,
            initial_reaction_n,
        };
        if onset.displacement_m.is_finite() && onset.normal_reaction_n.is_finite() {
            Ok(onset)
        } else {
            Err(StateError::OutOfRange)
        }
    }
}

/// Secant of the angle whose tangent is `t`.
fn secant<T: Real>(t: T) -> T {
    if t > T::from(1e15) { t } else { (T::ONE + t * t).sqrt() }
}
