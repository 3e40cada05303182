//! The layers between electrode and finger, and the electrostatic stress across them.

use crate::error::{ParameterError, not_negative, positive, representable};
use crate::{Expected, Real};

/// Vacuum permittivity in F/m, CODATA 2022 (doi:10.1103/RevModPhys.97.025002); relative uncertainty 1.6e-10.
pub const VACUUM_PERMITTIVITY_F_PER_M: f64 = 8.854_187_818_8e-12;

/// One slab of a coating: a dielectric, an air gap (permittivity 1) or the outer skin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slab<T> {
    /// Thickness in metres, above zero.
    pub thickness_m: T,
    /// Relative permittivity, at least one.
    pub relative_permittivity: T,
}

/// Effective gap of slabs in series, in metres: the sum of thickness over relative permittivity.
///
/// A coating enters every equation of the paper only through this number, `h0/eps`. Slabs in series have the same
/// capacitance as one air gap of this width. The sum is computed in f64, so its error is at most one rounding of `T`.
/// An empty stack is refused.
///
/// ```
/// use frixel_model::{Slab, effective_gap_m};
/// let oxide = Slab { thickness_m: 1e-6, relative_permittivity: 3.9 };
/// let air = Slab { thickness_m: 10e-6, relative_permittivity: 1.0 };
/// assert!((effective_gap_m(&[oxide, air])? - 10.256e-6_f64).abs() < 1e-9);
/// # Ok::<(), frixel_model::ParameterError>(())
/// ```
pub fn effective_gap_m<T: Real>(slabs: &[Slab<T>]) -> Result<T, ParameterError> {
    let mut gap_m = 0.0;
    for slab in slabs {
        let thickness_m: f64 = positive("thickness_m", slab.thickness_m)?.into();
        let permittivity: f64 = slab.relative_permittivity.into();
        if !(permittivity.is_finite() && permittivity >= 1.0) {
            return Err(ParameterError {
                parameter: "relative_permittivity",
                expected: Expected::AtLeastOne,
                found: permittivity,
            });
        }
        gap_m += thickness_m / permittivity;
    }
    positive("gap_m", T::from_f64(gap_m))
}

/// Attractive stress `sigma0` inside the contact, in pascals, Eq. (8): `eps0 V^2 / (2 g^2)`.
///
/// `gap_m` is the effective gap. Relative error at most 5 roundings of `T`.
pub fn contact_attraction_pa<T: Real>(voltage_v_rms: T, gap_m: T) -> Result<T, ParameterError> {
    attraction_pa(voltage_v_rms, gap_m, T::ZERO)
}

/// Attractive stress in pascals where the finger stands `separation_m` above the coating, Eqs. (3), (18).
///
/// `eps0 V^2 / (2 (g + H)^2)`, with the effective gap `g` in `gap_m`: the paper's `h0 + eps H` over `eps`. Relative
/// error at most 7 roundings of `T`.
pub fn attraction_pa<T: Real>(voltage_v_rms: T, gap_m: T, separation_m: T) -> Result<T, ParameterError> {
    let field_v_per_m = not_negative("voltage_v_rms", voltage_v_rms)?
        / (positive("gap_m", gap_m)? + not_negative("separation_m", separation_m)?);
    let attraction_pa = T::from_f64(0.5 * VACUUM_PERMITTIVITY_F_PER_M) * field_v_per_m * field_v_per_m;
    representable("voltage_v_rms", voltage_v_rms, attraction_pa)
}
