//! The contact while the finger is pulled off, Eq. (43) with a negative normal load.

use super::Contact;
use super::curve::{Point, root_of_quotient, upper_inverse};
use crate::error::{Expected, InverseError, ParameterError, StateError, finite, found_voltage_v_rms, positive};
use crate::root::{Step, rising_root};
use crate::{ContactModel, ContactState, Real, Sensitivity};

/// A contact that a fixed force pulls off the screen (variant `wf-loaded` with a negative load).
///
/// It exists while `q^2 + 2 q/(1 + q) + n >= 0` and is stable while `y > q`; at pull-off both become equalities. The
/// inverse refuses the unstable branch below pull-off.
///
/// Error bounds: those of [`LoadedContact`](crate::LoadedContact) times `max(1, c/12)`. The condition number `c` is the
/// sum of the relative sensitivities of the result to voltage (or friction), load, stiffness, gap and radius. Near
/// pull-off it grows without limit, as `q/(y - q)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PulledContact<T> {
    contact: Contact<T>,
    /// `mu F_N`, below zero.
    natural_friction_n: T,
    /// `n`, below zero.
    n: T,
}

impl<T: Real> PulledContact<T> {
    pub(super) fn new(contact: Contact<T>, pull_n: T) -> Result<Self, ParameterError> {
        let n = -contact.load(positive("pull_n", pull_n)?);
        if !(-n >= T::MIN_POSITIVE && n.is_finite()) {
            return Err(ParameterError {
                parameter: "pull_n",
                expected: Expected::Representable,
                found: pull_n.into(),
            });
        }
        Ok(Self { contact, natural_friction_n: -(contact.friction_coefficient * pull_n), n })
    }

    /// The rms voltage below which the finger comes off, in volts: the positive root of `q^3 + q^2 + (2 + n) q + n =
    /// 0`. At most 142 steps, usually six. Relative error at most 4e-15 in f64, 1e-6 in f32.
    pub fn pull_off_voltage_v_rms(&self) -> Result<T, StateError> {
        finite_answer(self.contact.voltage_scale_v_rms * self.pull_off_attraction()?.sqrt())
    }

    /// Friction at pull-off, the smallest friction of this contact, in newtons: `F* q^2`. The error bound is that of
    /// the pull-off voltage.
    pub fn pull_off_friction_n(&self) -> Result<T, StateError> {
        let q = self.pull_off_attraction()?;
        finite_answer(self.contact.friction_scale_n * q * q)
    }

    /// `q` at pull-off: `q^2 + 2 q/(1 + q)` rises through `-n`.
    fn pull_off_attraction(&self) -> Result<T, StateError> {
        let m = -self.n;
        // q^2 + 2 q bounds the left side from above, q^2 from below.
        let low = m / (T::ONE + (T::ONE + m).sqrt());
        let high = m.sqrt();
        let root = rising_root(low, high, low, |q| {
            let around = T::ONE / (T::ONE + q);
            let residual = q - m / q + T::TWO * around;
            let slope = T::TWO * (T::ONE + around / q * around);
            Step { residual, next: q - residual / slope }
        });
        root.map_err(|_| StateError::NotConverged)
    }

    fn point(&self, voltage_v_rms: T) -> Result<Point<T>, StateError> {
        let v = self.contact.scaled_voltage(voltage_v_rms)?;
        Point::upper(v, self.n).ok_or(StateError::NoContact)
    }

    fn inverse(&self, friction_n: T, electric_friction_n: T) -> Result<T, InverseError> {
        if friction_n < T::ZERO {
            return Err(InverseError::BelowNatural);
        }
        let scale = self.contact.friction_scale_n;
        let y = root_of_quotient(friction_n, scale);
        if !(y > T::ZERO) {
            return Err(InverseError::Unstable);
        }
        let v = upper_inverse(y, electric_friction_n / (scale * y));
        if v * v > y {
            return Err(InverseError::Unstable);
        }
        found_voltage_v_rms(self.contact.voltage_scale_v_rms * v)
    }
}

impl<T: Real> ContactModel<T> for PulledContact<T> {
    /// `mu F_N`, below zero: not a physical friction, but the zero point of electric friction.
    fn natural_friction_n(&self) -> T {
        self.natural_friction_n
    }

    fn state(&self, voltage_v_rms: T) -> Result<ContactState<T>, StateError> {
        self.contact.state_at(&self.point(voltage_v_rms)?)
    }

    fn voltage_for_electric_friction(&self, electric_friction_n: T) -> Result<T, InverseError> {
        let friction_n = self.natural_friction_n + finite("electric_friction_n", electric_friction_n)?;
        self.inverse(friction_n, electric_friction_n)
    }

    /// Computed directly, since the difference from natural friction would lose a friction far below `mu |F_N|`.
    fn voltage_for_friction(&self, friction_n: T) -> Result<T, InverseError> {
        let friction_n = finite("friction_n", friction_n)?;
        self.inverse(friction_n, friction_n - self.natural_friction_n)
    }

    fn sensitivity(&self, voltage_v_rms: T) -> Result<Sensitivity<T>, StateError> {
        self.contact.sensitivity_at(&self.point(voltage_v_rms)?)
    }

    /// The range begins at the friction at pull-off.
    fn reachable_friction_n(&self, voltage_max_v_rms: T) -> Result<(T, T), StateError> {
        Ok((self.pull_off_friction_n()?, self.state(voltage_max_v_rms)?.friction_n))
    }
}

fn finite_answer<T: Real>(answer: T) -> Result<T, StateError> {
    if answer.is_finite() { Ok(answer) } else { Err(StateError::OutOfRange) }
}
