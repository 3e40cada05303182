//! The soft finger with the attraction around its contact, Eqs. (27)-(33) and (43).

use core::f64::consts::PI;

use super::finger::{ForceLaw, SoftFinger};
use super::lower::SoftLowerBound;
use crate::coating::VACUUM_PERMITTIVITY_F_PER_M;
use crate::error::{
    InverseError, ParameterError, StateError, checked_target_n, not_negative, positive, representable, round_to_model,
};
use crate::root::{Step, rising_root};
use crate::{Contact, ContactModel, ContactState, Finger, Real, Sensitivity};

/// A soft finger on a coating.
///
/// ```
/// use frixel_model::{ContactModel, SoftFinger};
/// let finger = SoftFinger {
///     radius_m: 8e-3_f64,
///     modulus_pa: 1e5,
///     stress_exponent: 0.5,
///     shape_constant: 4.5,
///     friction_coefficient: 0.5,
/// };
/// let contact = finger.on_gap(10e-6)?.under_load(0.5)?;
/// let state = contact.state(150.0)?;
/// let voltage_v_rms = contact.voltage_for_electric_friction(state.electric_friction_n)?;
/// assert!((voltage_v_rms - 150.0).abs() < 1e-9);
/// # Ok::<(), Box<dyn core::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SoftContact<T> {
    pub(super) finger: SoftFinger<T>,
    pub(super) gap_m: T,
    pub(super) forces: ForceLaw<T>,
    /// The voltage at which `pi sigma0` is `B E`.
    pub(super) voltage_scale_v_rms: T,
}

impl<T: Real> SoftContact<T> {
    /// `finger` on a coating of effective gap `gap_m` (see [`effective_gap_m`](crate::effective_gap_m)), above zero.
    pub fn new(finger: &SoftFinger<T>, gap_m: T) -> Result<Self, ParameterError> {
        let forces = finger.forces()?;
        let g: f64 = positive("gap_m", gap_m)?.into();
        let (modulus, shape): (f64, f64) = (finger.modulus_pa.into(), finger.shape_constant.into());
        let square = 2.0 * g * g * shape * modulus / (PI * VACUUM_PERMITTIVITY_F_PER_M);
        Ok(Self {
            finger: *finger,
            gap_m,
            forces,
            voltage_scale_v_rms: round_to_model("gap_m", gap_m, libm::sqrt(square))?,
        })
    }

    /// The contact under a normal load of zero or more newtons. A pull is refused, since up to three contacts satisfy
    /// the equations under a pull.
    pub fn under_load(self, normal_load_n: T) -> Result<SoftLoadedContact<T>, ParameterError> {
        SoftLoadedContact::new(self, normal_load_n)
    }

    /// The lower bound without load, attracted only where it touches, Eqs. (40), (41).
    pub fn lower_bound(self) -> SoftLowerBound<T> {
        SoftLowerBound::new(self)
    }

    /// `tau = pi sigma0/(B E)` of a voltage argument.
    pub(super) fn stress(&self, voltage_v_rms: T) -> Result<T, StateError> {
        let v = not_negative("voltage_v_rms", voltage_v_rms)? / self.voltage_scale_v_rms;
        Ok(v * v)
    }

    /// Contact radius `R sqrt(2 p^(2 gamma))` for `p^(2 gamma)`.
    pub(super) fn contact_radius_m(&self, area: T) -> T {
        self.finger.radius_m * (T::TWO * area).sqrt()
    }
}

/// A soft finger under a fixed normal load of zero or more: variants `soft-upper` (no load, Eqs. (27)-(33)) and
/// `soft-loaded` (Eq. (29) with Eq. (43), beyond the paper).
///
/// With `p = F_T/(mu B E R^2)`, `tau = pi sigma0/(B E)`, `zeta = g/R` and the load `l` in the scale of `p`, the
/// self-consistent balance is `p = l + 2 tau (p^(2 gamma) + zeta/(1 + q))`, `q = tau/zeta p^(4 gamma - 1)`. Divided by
/// `p`, each term of the right side falls, so the root is unique for every stress exponent. It is found in a bracket,
/// in at most 142 steps, usually five or six. The inverse computes the stiffness from the friction, Eq. (29), and then
/// uses the closed-form inverse of [`LoadedContact`](crate::LoadedContact).
///
/// Error bounds, for stress exponents from 0.02 to 1 (and tested for 1e-6): 4e-14 in f64 and 1e-5 in f32.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SoftLoadedContact<T> {
    contact: SoftContact<T>,
    normal_load_n: T,
    natural_friction_n: T,
    load: T,
    zeta: T,
}

/// The terms of the balance at one `p`.
struct Balance<T> {
    area: T,
    /// `2 tau p^(2 gamma)`.
    inside: T,
    /// `2 tau zeta/(1 + q)`.
    around: T,
    /// `q/(1 + q)`.
    softening: T,
}

impl<T: Real> SoftLoadedContact<T> {
    fn new(contact: SoftContact<T>, normal_load_n: T) -> Result<Self, ParameterError> {
        let load = not_negative("normal_load_n", normal_load_n)? / contact.forces.force_scale_n;
        representable("normal_load_n", normal_load_n, load)?;
        Ok(Self {
            contact,
            normal_load_n,
            natural_friction_n: contact.finger.friction_coefficient * normal_load_n,
            load,
            zeta: contact.gap_m / contact.finger.radius_m,
        })
    }

    fn balance(&self, tau: T, p: T) -> Balance<T> {
        let area = p.pow(self.contact.forces.two_gamma);
        // p^(4 gamma - 1) from the power already computed.
        let q = tau / self.zeta * (area / p) * area;
        let around = T::ONE / (T::ONE + q);
        Balance {
            area,
            inside: T::TWO * tau * area,
            around: T::TWO * tau * self.zeta * around,
            softening: if q > T::ONE { T::ONE / (T::ONE + T::ONE / q) } else { q * around },
        }
    }

    /// `sum over terms of (term/p) * (-d ln(term/p)/d ln p)`, above zero: the rate at which the balance over `p` falls.
    fn steepness(&self, balance: &Balance<T>, p: T) -> T {
        let forces = &self.contact.forces;
        self.load / p
            + balance.inside / p * (T::ONE - forces.two_gamma)
            + balance.around / p * (T::ONE - forces.stiffening * balance.softening)
    }

    /// `p` at a stress above zero.
    fn solve(&self, tau: T) -> Result<T, StateError> {
        let two = T::TWO;
        let bound = |tau: T| (two * tau).pow(T::ONE + self.contact.forces.two_s);
        // With the constant part c, p <= c + 2 tau p^(2 gamma): p is at most twice the larger summand.
        let constant = self.load + two * tau * self.zeta;
        let high = (two * constant).max(bound(two * tau));
        let low = self.load.max(bound(tau));
        if !(high >= T::MIN_POSITIVE && high.is_finite()) {
            return Err(StateError::OutOfRange);
        }
        let start = (constant + bound(tau)).min(high);
        let root = rising_root(low, high, start, |p| {
            let balance = self.balance(tau, p);
            let sum = (self.load + balance.inside + balance.around) / p;
            // Newton's step for the logarithm of the sum over that of p, which is nearly a straight line.
            let next = p * sum.pow(sum / self.steepness(&balance, p));
            Step { residual: T::ONE - sum, next }
        });
        root.map_err(|_| StateError::NotConverged)
    }
}

impl<T: Real> ContactModel<T> for SoftLoadedContact<T> {
    fn natural_friction_n(&self) -> T {
        self.natural_friction_n
    }

    fn state(&self, voltage_v_rms: T) -> Result<ContactState<T>, StateError> {
        let tau = self.contact.stress(voltage_v_rms)?;
        let nothing_presses = !(tau > T::ZERO) && !(self.load > T::ZERO);
        if nothing_presses {
            let zero = T::ZERO;
            return Ok(ContactState {
                contact_radius_m: zero,
                stiffness_pa_per_m: zero,
                friction_n: zero,
                electric_friction_n: zero,
            });
        }
        let p = if tau > T::ZERO { self.solve(tau)? } else { self.load };
        let balance = self.balance(tau, p);
        let friction_scale_n = self.contact.finger.friction_coefficient * self.contact.forces.force_scale_n;
        let electric_friction_n = friction_scale_n * (balance.inside + balance.around);
        ContactState {
            contact_radius_m: self.contact.contact_radius_m(balance.area),
            stiffness_pa_per_m: self.contact.forces.stiffness_pa_per_m(p),
            friction_n: self.natural_friction_n + electric_friction_n,
            electric_friction_n,
        }
        .in_range()
    }

    fn voltage_for_electric_friction(&self, electric_friction_n: T) -> Result<T, InverseError> {
        if !(checked_target_n(electric_friction_n)? > T::ZERO) {
            return Ok(T::ZERO);
        }
        let SoftContact { finger, gap_m, forces, .. } = &self.contact;
        let spring_force_n = self.normal_load_n + electric_friction_n / finger.friction_coefficient;
        let stiffness_pa_per_m = forces.stiffness_pa_per_m(spring_force_n / forces.force_scale_n);
        if !(stiffness_pa_per_m >= T::MIN_POSITIVE && stiffness_pa_per_m.is_finite()) {
            return Err(InverseError::OutOfRange);
        }
        let springs =
            Finger { radius_m: finger.radius_m, stiffness_pa_per_m, friction_coefficient: finger.friction_coefficient };
        Contact::new(&springs, *gap_m)?
            .under_load(self.normal_load_n)?
            .voltage_for_electric_friction(electric_friction_n)
    }

    fn sensitivity(&self, voltage_v_rms: T) -> Result<Sensitivity<T>, StateError> {
        let tau = self.contact.stress(voltage_v_rms)?;
        let mu = self.contact.finger.friction_coefficient;
        if !(tau > T::ZERO) {
            return Ok(Sensitivity { friction_per_volt_n_per_v: T::ZERO, friction_per_load: mu });
        }
        let p = self.solve(tau)?;
        let balance = self.balance(tau, p);
        let steepness = self.steepness(&balance, p);
        // d ln p/d ln tau: the attraction around the contact grows more slowly than the stress.
        let by_stress = (balance.inside + balance.around * (T::ONE - balance.softening)) / p / steepness;
        let friction_n = mu * self.contact.forces.force_scale_n * p;
        Sensitivity {
            friction_per_volt_n_per_v: T::TWO * friction_n * by_stress / voltage_v_rms,
            friction_per_load: mu / steepness,
        }
        .in_range()
    }
}
