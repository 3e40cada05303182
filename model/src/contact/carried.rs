//! The contact under a carrier: friction averaged over a carrier period.

use super::LoadedContact;
use crate::double_single::{DoubleSingle, square_root};
use crate::{ParameterError, Real, Ripple};

/// Most steps of Newton's method in the inverse. Each squares the error; `f32` needs at most four, and `f64` five.
const STEPS_MAX: usize = 6;

/// A contact under a carrier: its electric friction is the mean over a carrier period.
///
/// Assumes that the friction of every tick is that of the [`LoadedContact`] at the tick's mean squared voltage. Created
/// by [`LoadedContact::under_carrier`]. With [`Ripple::NONE`] it has the friction of the contact.
///
/// In f64, forward and inverse agree within 1e-13 of the friction, while `(V/V*)^4` is representable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CarriedContact<T> {
    contact: LoadedContact<T>,
    /// `None` if the squared voltage is constant.
    ripple: Option<Ripple>,
}

impl<T: Real> LoadedContact<T> {
    /// The contact under a carrier with this ripple.
    pub fn under_carrier(self, ripple: Ripple) -> CarriedContact<T> {
        CarriedContact { contact: self, ripple: (!ripple.is_none()).then_some(ripple) }
    }
}

impl CarriedContact<f64> {
    /// The contact under the same carrier and another normal load, of zero or more newtons.
    pub(crate) fn under_load(&self, normal_load_n: f64) -> Result<Self, ParameterError> {
        self.contact.contact().under_load(normal_load_n).map(|contact| Self { contact, ..*self })
    }
}

impl<T: Correctable> CarriedContact<T> {
    /// The contact at a constant voltage.
    pub fn contact(&self) -> &LoadedContact<T> {
        &self.contact
    }

    /// Mean electric friction in newtons at a finite rms voltage of zero or more.
    pub fn electric_friction_n(&self, voltage_v_rms: T) -> T {
        let constant_n = self.contact.electric_friction_n(voltage_v_rms);
        let Some(ripple) = &self.ripple else { return constant_n };
        let (change, _) = self.around(voltage_v_rms).mean(ripple, Real::ZERO);
        constant_n + constant_n * T::of_correction(change)
    }

    /// The rms voltage for a finite mean electric friction, in volts; zero for a friction of zero or less and for NaN.
    pub fn voltage_v_rms(&self, electric_friction_n: T) -> T {
        let constant_v_rms = self.contact.voltage_v_rms(electric_friction_n);
        let Some(ripple) = &self.ripple else { return constant_v_rms };
        let change = self.around(constant_v_rms).voltage_change(ripple);
        constant_v_rms + constant_v_rms * T::of_correction(change)
    }

    /// The surroundings of a voltage.
    fn around(&self, voltage_v_rms: T) -> Surroundings<T::Correction> {
        let (v, n) = self.contact.scaled(voltage_v_rms);
        Surroundings::of(v.to_correction(), n.to_correction())
    }
}

/// A precision of corrections.
pub trait Correction: Real {
    /// Square root.
    fn root(self) -> Self;
}

impl Correction for f64 {
    fn root(self) -> Self {
        self.sqrt()
    }
}

impl Correction for f32 {
    fn root(self) -> Self {
        square_root(self)
    }
}

/// A precision whose corrections for ripple, up to half of the friction under a sine, are computed in another one.
pub trait Correctable: Real {
    /// Precision of the correction.
    type Correction: Correction;
    /// The nearest number of that precision.
    fn to_correction(self) -> Self::Correction;
    /// The same number.
    fn of_correction(correction: Self::Correction) -> Self;
}

impl Correctable for f64 {
    type Correction = f64;
    fn to_correction(self) -> f64 {
        self
    }
    fn of_correction(correction: f64) -> f64 {
        correction
    }
}

/// A correction in `f32` adds at most 1e-7 of the friction to the error, in a twentieth of the time.
impl Correctable for DoubleSingle {
    type Correction = f32;
    fn to_correction(self) -> f32 {
        self.to_f32()
    }
    fn of_correction(correction: f32) -> Self {
        Self::from(correction)
    }
}

/// A point of the curve and its load, from which relative changes of friction are computed without cancellation.
struct Surroundings<T> {
    q: T,
    n: T,
    /// The attraction around the contact, `w`.
    around: T,
    /// `y - q`.
    margin: T,
    y: T,
}

impl<T: Correction> Surroundings<T> {
    #[inline(never)]
    fn of(v: T, n: T) -> Self {
        let q = v * v;
        let around = T::ONE / (T::ONE + q);
        let margin = Self::margin_at(q, around, n);
        Self { q, n, around, margin, y: q + margin }
    }

    fn margin_at(q: T, around: T, n: T) -> T {
        (q * q + T::TWO * q * around + n).root()
    }

    /// Relative change of friction, and its derivative over that of the squared voltage, for a relative change of the
    /// squared voltage by `change`, to the multiple `factor = 1 + change`, whose precision close to zero matters.
    fn friction_change(&self, change: T, factor: T) -> (T, T) {
        let Self { q, n, around, margin, y } = *self;
        let q_change = q * change;
        let new_q = q * factor;
        let new_around = T::ONE / (T::ONE + new_q);
        let new_margin = Self::margin_at(new_q, new_around, n);
        let around_change = -(q_change * around * new_around);
        let square_change = q_change * (T::TWO * q + q_change) - T::TWO * around_change;
        // Without voltage and load, `y` and the margin vanish together.
        let margins = new_margin + margin;
        let y_change = q_change + if margins > T::ZERO { square_change / margins } else { T::ZERO };
        let sum = y + around;
        let friction_change = change + factor * ((y_change + around_change) / sum);
        let new_y = y + y_change;
        let steepness = if new_margin > T::ZERO { new_y / new_margin } else { T::ONE };
        (friction_change, (new_y + new_around * new_around) * steepness / sum)
    }

    /// Relative change of the mean friction from that at a constant voltage, for a relative change of the mean square
    /// by `change`, and its derivative.
    #[inline(never)]
    fn mean(&self, ripple: &Ripple, change: T) -> (T, T) {
        let (mut values, mut slopes, mut weights) = (T::ZERO, T::ZERO, T::ZERO);
        for level in ripple.levels() {
            let [excess, weight] = [level.excess, level.weight].map(T::from);
            let level = T::ONE + excess;
            let (value, slope) = self.friction_change(excess + level * change, level + level * change);
            values = values + weight * value;
            slopes = slopes + weight * level * slope;
            weights = weights + weight;
        }
        (values / weights, slopes / weights)
    }

    /// Relative change of the voltage that gives the mean friction the value of the friction at a constant voltage.
    #[inline(never)]
    fn voltage_change(&self, ripple: &Ripple) -> T {
        let mut change = T::ZERO;
        for _ in 0..STEPS_MAX {
            let (value, slope) = self.mean(ripple, change);
            let step = value / slope;
            change = change - step;
            // The next step would be about the square of this one.
            if step * step <= T::EPSILON {
                break;
            }
        }
        // The root of `1 + change`, less 1.
        change / (T::ONE + (T::ONE + change).root())
    }
}
