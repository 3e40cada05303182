//! The dimensionless curve of a paraboloid on Winkler-Fuss springs.
//!
//! With `q = sigma0/(g k) = (V/V*)^2`, `y = a^2/(2 R g)` and `n = F_N/(pi k R g^2)`, Eq. (43) is
//! `y^2 - 2 q y - 2 q w - n = 0`, with `w = 1/(1 + q)` for the attraction around the contact. Without it, Eq. (37),
//! `w = 0`.

use crate::Real;

/// A point of the curve.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Point<T> {
    /// `V/V*`, the square root of `q`. It keeps its precision where `q` and `y^2` leave the range of `f32`.
    pub(crate) v: T,
    /// The attraction around the contact, `w`.
    pub(crate) around: T,
    /// `y - q`, above zero where the contact is stable.
    pub(crate) margin: T,
    pub(crate) y: T,
}

impl<T: Real> Point<T> {
    /// The point with the attraction around the contact, Eqs. (36), (43). `None` if there is no contact.
    #[inline]
    pub(crate) fn upper(v: T, n: T) -> Option<Self> {
        let q = v * v;
        Self::new(v, q, T::ONE / (T::ONE + q), n)
    }

    /// The point without the attraction around the contact, Eqs. (37), (38). `None` if there is no contact.
    #[inline]
    pub(crate) fn lower(v: T, n: T) -> Option<Self> {
        Self::new(v, v * v, T::ZERO, n)
    }

    #[inline]
    fn new(v: T, q: T, around: T, n: T) -> Option<Self> {
        let margin = if q.to_f32() < 1e-15 && n >= T::ZERO {
            // The square would overflow or underflow: take the root of each part first.
            hypotenuse(v * (q + T::TWO * around).sqrt(), n.sqrt())
        } else if q.to_f32() > 1e18 {
            q * (T::ONE + (T::TWO * q * around + n) / q / q).sqrt()
        } else {
            let square = q * q + T::TWO * q * around + n;
            if !(square >= T::ZERO) {
                return None;
            }
            square.sqrt()
        };
        (margin >= T::ZERO).then_some(Self { v, around, margin, y: q + margin })
    }

    /// The electric friction `scale (y^2 - n)`, computed without cancellation; `scale` is the friction scale.
    #[inline]
    pub(crate) fn electric_friction(&self, scale: T) -> T {
        scale * self.v * self.v * (T::TWO * (self.y + self.around))
    }

    /// `d(y^2)/dv` over `4 v`, and `d(y^2)/dn`.
    pub(crate) fn slopes(&self) -> (T, T) {
        if self.margin > T::ZERO {
            let steepness = self.y / self.margin;
            ((self.y + self.around * self.around) * steepness, steepness)
        } else {
            (T::ZERO, T::ONE)
        }
    }
}

/// `y` of a friction: the root of a quotient that may itself overflow or underflow.
#[inline]
pub(crate) fn root_of_quotient<T: Real>(numerator: T, denominator: T) -> T {
    let quotient = numerator / denominator;
    if (1e-30..1e30).contains(&quotient.to_f32()) { quotient.sqrt() } else { numerator.sqrt() / denominator.sqrt() }
}

/// The `v` at which the upper curve passes `y`, with `r = (y^2 - n)/y`.
///
/// The positive root of `2 q^2 + B q - r = 0` with `B = 2 + 2/y - r`, each sign of `B` in the form that does not
/// cancel.
#[inline]
pub(crate) fn upper_inverse<T: Real>(y: T, r: T) -> T {
    let b = T::TWO + T::TWO / y - r;
    let size = b.abs();
    let eight_r = T::from(8.0) * r;
    if size.to_f32() < 1e15 {
        let sum = size + (size * size + eight_r).sqrt();
        if b.to_f32() >= 0.0 { (T::TWO * r / sum).sqrt() } else { (sum / T::from(4.0)).sqrt() }
    } else {
        let sum = size * (T::ONE + (T::ONE + eight_r / size / size).sqrt());
        if b.to_f32() >= 0.0 { (T::TWO * r).sqrt() / sum.sqrt() } else { (sum / T::from(4.0)).sqrt() }
    }
}

fn hypotenuse<T: Real>(a: T, b: T) -> T {
    let (long, short) = (a.max(b), a.min(b));
    if long > T::ZERO {
        let ratio = short / long;
        long * (T::ONE + ratio * ratio).sqrt()
    } else {
        T::ZERO
    }
}
