//! A Winkler-Fuss finger on a coating: the model's scales, and the quantities that follow from them in closed form.

mod carried;
pub(crate) mod curve;
mod finite;
mod loaded;
mod lower;
mod pulled;

use core::f64::consts::PI;

pub use carried::CarriedContact;
pub use finite::FiniteContact;
pub use loaded::LoadedContact;
pub use lower::LowerBound;
pub use pulled::PulledContact;

use crate::coating::VACUUM_PERMITTIVITY_F_PER_M;
use crate::error::{Expected, ParameterError, StateError, not_negative, positive, representable, round_to_model};
use crate::{ContactState, Finger, Real, Sensitivity};
use curve::Point;

/// A Winkler-Fuss finger on a coating, reduced to the four scales that its equations need.
///
/// In these scales all fingers and coatings share one relation of voltage, load, contact and friction, as the paper
/// indicates under Eq. (36): `q = sigma0/(g k) = (V/V*)^2`, `n = F_N/(pi k R g^2)`, `y = a^2/(2 R g)`,
/// `u = F_T/F* - n`. The scales are computed in f64 and rounded once, for every `T`.
///
/// ```
/// use frixel_model::{Contact, ContactModel, Finger};
/// let contact = Contact::new(&Finger::<f64>::EXAMPLE, 10e-6)?.under_load(0.5)?;
/// assert_eq!(contact.natural_friction_n(), 0.25);
/// let state = contact.state(150.0)?;
/// assert!((state.electric_friction_n - 28e-3_f64).abs() < 0.5e-3);
/// assert!((contact.voltage_v_rms(state.electric_friction_n) - 150.0).abs() < 1e-9);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact<T> {
    voltage_scale_v_rms: T,
    friction_scale_n: T,
    load_scale_n: T,
    /// `2 R g`, in square metres.
    area_scale_m2: T,
    radius_m: T,
    stiffness_pa_per_m: T,
    friction_coefficient: T,
}

impl<T: Real> Contact<T> {
    /// Scales for `finger` on a coating of effective gap `gap_m` (see [`effective_gap_m`](crate::effective_gap_m)),
    /// above zero.
    pub fn new(finger: &Finger<T>, gap_m: T) -> Result<Self, ParameterError> {
        finger.validate()?;
        let g: f64 = positive("gap_m", gap_m)?.into();
        let (radius, k, mu): (f64, f64, f64) =
            (finger.radius_m.into(), finger.stiffness_pa_per_m.into(), finger.friction_coefficient.into());
        let load_scale_n = PI * k * radius * g * g;
        Ok(Self {
            voltage_scale_v_rms: round_to_model(
                "gap_m",
                gap_m,
                libm::sqrt(2.0 * k * g * g * g / VACUUM_PERMITTIVITY_F_PER_M),
            )?,
            friction_scale_n: round_to_model("gap_m", gap_m, mu * load_scale_n)?,
            load_scale_n: round_to_model("gap_m", gap_m, load_scale_n)?,
            area_scale_m2: round_to_model("gap_m", gap_m, 2.0 * radius * g)?,
            radius_m: finger.radius_m,
            stiffness_pa_per_m: finger.stiffness_pa_per_m,
            friction_coefficient: finger.friction_coefficient,
        })
    }

    /// The universal curve: every scale is one, so that voltage is `V/V*`, load `n`, friction `F_T/F*` and contact
    /// radius `sqrt(y)`. A table of it is valid for every finger and coating under the same `n`.
    pub fn universal() -> Self {
        Self {
            voltage_scale_v_rms: T::ONE,
            friction_scale_n: T::ONE,
            load_scale_n: T::ONE,
            area_scale_m2: T::ONE,
            radius_m: T::ONE,
            stiffness_pa_per_m: T::ONE,
            friction_coefficient: T::ONE,
        }
    }

    /// The contact under a normal load of zero or more newtons, Eqs. (36), (43): without load the upper bound of the
    /// paper.
    pub fn under_load(self, normal_load_n: T) -> Result<LoadedContact<T>, ParameterError> {
        LoadedContact::new(self, normal_load_n)
    }

    /// The contact under a force above zero that pulls the finger off: Eq. (43) with the normal load `-pull_n`.
    pub fn under_pull(self, pull_n: T) -> Result<PulledContact<T>, ParameterError> {
        PulledContact::new(self, pull_n)
    }

    /// The lower bound, without attraction around the contact, Eqs. (37)-(39), under a normal load of either sign.
    pub fn lower_bound(self, normal_load_n: T) -> Result<LowerBound<T>, ParameterError> {
        LowerBound::new(self, normal_load_n)
    }

    /// The contact of a finger that ends at `outer_radius_m`, Eq. (19), under a normal load of zero or more newtons.
    pub fn within(self, outer_radius_m: T, normal_load_n: T) -> Result<FiniteContact<T>, ParameterError> {
        FiniteContact::new(self, outer_radius_m, normal_load_n)
    }

    /// Voltage scale of Eq. (36), `V* = sqrt(2 k g^3/eps0)`, in volts rms. Relative error at most 1 rounding in f32 and
    /// 4 in f64.
    pub fn voltage_scale_v_rms(&self) -> T {
        self.voltage_scale_v_rms
    }

    /// Friction scale of Eq. (34), `F* = mu pi k R g^2`, in newtons. Relative error at most 1 rounding in f32 and 6 in
    /// f64.
    pub fn friction_scale_n(&self) -> T {
        self.friction_scale_n
    }

    /// Load scale of Eq. (43), `pi k R g^2`, in newtons. Relative error at most 1 rounding in f32 and 5 in f64.
    pub fn load_scale_n(&self) -> T {
        self.load_scale_n
    }

    /// Dimensionless attraction `q = sigma0/(g k) = (V/V*)^2` of a voltage. Relative error at most 5
    /// roundings in f32 and 10 in f64, which includes the roundings of the scales.
    pub fn attraction(&self, voltage_v_rms: T) -> T {
        let v = voltage_v_rms / self.voltage_scale_v_rms;
        v * v
    }

    /// Dimensionless load `n = F_N/(pi k R g^2)`: the paper's `f_N` of Eq. (44) is `n pi/eps^2`. Relative error at most
    /// 2 roundings in f32 and 6 in f64.
    pub fn load(&self, normal_load_n: T) -> T {
        normal_load_n / self.load_scale_n
    }

    /// Dimensionless area `y = a^2/(2 R g)` of a contact radius; of the outer radius it is `beta`. The paper's
    /// `alpha = a/R` of Eqs. (30), (44) is `sqrt(2 g y/R)`. Relative error at most 3 roundings of `T`.
    pub fn area(&self, radius_m: T) -> T {
        radius_m / self.area_scale_m2 * radius_m
    }

    /// Most negative normal load that the finger withstands at a voltage, in newtons (zero or less):
    /// `q^2 + 2 q/(1 + q) + n = 0`. Relative error at most 4e-15 in f64, 1e-6 in f32.
    pub fn pull_off_load_n(&self, voltage_v_rms: T) -> Result<T, ParameterError> {
        let q = self.attraction(not_negative("voltage_v_rms", voltage_v_rms)?);
        representable("voltage_v_rms", voltage_v_rms, -(self.load_scale_n * q * (q + T::TWO / (T::ONE + q))))
    }

    /// Normal load in newtons from a measured contact radius and the voltage, Eq. (43).
    ///
    /// Relative error at most 2e-15 in f64, 1e-6 in f32, times one plus the ratio of spring force to load: where spring
    /// force and attraction nearly cancel, the load is ill-conditioned in the radius.
    pub fn normal_load_n(&self, contact_radius_m: T, voltage_v_rms: T) -> Result<T, ParameterError> {
        let y = self.area(not_negative("contact_radius_m", contact_radius_m)?);
        let q = self.attraction(not_negative("voltage_v_rms", voltage_v_rms)?);
        // Multiply by the scale first: squares of y and q may overflow or underflow where the load does not.
        let inside_n = self.load_scale_n * y * (y - T::TWO * q);
        let load_n = inside_n - self.load_scale_n * T::TWO * (q / (T::ONE + q));
        representable("contact_radius_m", contact_radius_m, load_n)
    }

    /// Capacitance in farads between electrode and finger, out to `outer_radius_m`: `eps0 pi a^2/g + 2 pi eps0 R ln(1 +
    /// (beta - y)/(1 + q))`, with the gap around the contact from Eqs. (11), (17).
    ///
    /// `contact_radius_m` must be the model's contact radius at this voltage, at most the outer radius. Relative error
    /// at most 4e-15 in f64, 1e-6 in f32.
    pub fn capacitance_f(&self, contact_radius_m: T, voltage_v_rms: T, outer_radius_m: T) -> Result<T, ParameterError> {
        let y = self.area(not_negative("contact_radius_m", contact_radius_m)?);
        let q = self.attraction(not_negative("voltage_v_rms", voltage_v_rms)?);
        if !(contact_radius_m <= positive("outer_radius_m", outer_radius_m)?) {
            return Err(ParameterError {
                parameter: "contact_radius_m",
                expected: Expected::WithinOuterRadius,
                found: contact_radius_m.into(),
            });
        }
        let around = (outer_radius_m - contact_radius_m) / self.area_scale_m2 * (outer_radius_m + contact_radius_m);
        let per_area = T::from_f64(2.0 * PI * VACUUM_PERMITTIVITY_F_PER_M) * self.radius_m;
        representable("outer_radius_m", outer_radius_m, per_area * (y + (around / (T::ONE + q)).ln_1p()))
    }

    /// `V/V*` of a voltage argument.
    fn scaled_voltage(&self, voltage_v_rms: T) -> Result<T, StateError> {
        let v = not_negative("voltage_v_rms", voltage_v_rms)? / self.voltage_scale_v_rms;
        if (v * v).is_finite() { Ok(v) } else { Err(StateError::OutOfRange) }
    }

    /// Contact radius of a dimensionless area.
    fn contact_radius_m(&self, y: T) -> T {
        (self.area_scale_m2 * y).sqrt()
    }

    fn state_at(&self, point: &Point<T>) -> Result<ContactState<T>, StateError> {
        ContactState {
            contact_radius_m: self.contact_radius_m(point.y),
            stiffness_pa_per_m: self.stiffness_pa_per_m,
            friction_n: self.friction_scale_n * point.y * point.y,
            electric_friction_n: point.electric_friction(self.friction_scale_n),
        }
        .in_range()
    }

    fn sensitivity_at(&self, point: &Point<T>) -> Result<Sensitivity<T>, StateError> {
        let (by_voltage, by_load) = point.slopes();
        self.sensitivity_of(point.v, by_voltage, by_load)
    }

    /// The sensitivity from `d(y^2)/dv / (4 v)` and `d(y^2)/dn`.
    fn sensitivity_of(&self, v: T, by_voltage: T, by_load: T) -> Result<Sensitivity<T>, StateError> {
        let friction_per_volt_n_per_v =
            T::from(4.0) * self.friction_scale_n / self.voltage_scale_v_rms * v * by_voltage;
        let friction_per_load = self.friction_coefficient * by_load;
        Sensitivity { friction_per_volt_n_per_v, friction_per_load }.in_range()
    }
}
