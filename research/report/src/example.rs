//! The finger that figures are drawn for: that of `scenes/fingers/example.toml`, on an effective gap of 10 um in place
//! of 5 um. 250 mN at zero voltage and 28 mN more at 150 V rms, under 0.5 N.

use frixel_model::{Contact, Finger, ParameterError, Real};

/// The finger.
pub(super) const FINGER: Finger<f64> = Finger { radius_m: 8e-3, stiffness_pa_per_m: 1.8e7, friction_coefficient: 0.5 };
/// Effective gap of coating and skin, in metres.
pub(super) const GAP_M: f64 = 1e-5;
/// Normal load, in newtons.
pub(super) const LOAD_N: f64 = 0.5;
/// Last sentence of the caption of a figure about this finger.
pub(super) const CAPTION: &str = "Example finger, assumed: R = 8 mm, k = 18 MPa/m, µ = 0.5, on an effective gap of 10 µm in place of \
                           the 5 µm of its profile (250 mN of friction \
                           without voltage under 0.5 N, and 28 mN more at 150 V rms).";

/// The finger on its gap, in either precision.
pub(super) fn contact<T: Real>() -> Result<Contact<T>, ParameterError> {
    let Finger { radius_m, stiffness_pa_per_m, friction_coefficient } = FINGER;
    let finger = Finger {
        radius_m: T::from_f64(radius_m),
        stiffness_pa_per_m: T::from_f64(stiffness_pa_per_m),
        friction_coefficient: T::from_f64(friction_coefficient),
    };
    Contact::new(&finger, T::from_f64(GAP_M))
}
