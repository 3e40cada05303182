//! Double-single arithmetic: numbers of about 44 bits as sums of two `f32`. A board uses it where `f32` is not precise
//! enough, since its FPU does not support `f64` and software `f64` would add its routines to the firmware image.

use core::cmp::Ordering;
use core::fmt::{Display, Formatter, Result as FmtResult};
use core::ops::{Add, Div, Mul, Neg, Sub};

use crate::Real;

/// The unevaluated sum of two `f32`, of which the second is at most half a last bit of the first.
///
/// Relative errors: 1.1e-14 of a sum of like signs, 2.5e-14 of a product, 5.4e-14 of a quotient, 1e-13 of a root, while
/// what the second part has to hold, 1e-14 of the number, is a normal `f32`; below some 1e-24 they grow to those of
/// `f32`. Factors are below 8e34. Algorithms 6, 10 and 17 of M. Joldes, J.-M. Muller, V. Popescu, "Tight and rigorous
/// error bounds for basic building blocks of double-word arithmetic", ACM TOMS 44(2), 2017, doi:10.1145/3121432.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct DoubleSingle {
    high: f32,
    low: f32,
}

/// `a + b` exactly, when `a` is the larger one.
fn fast_two_sum(a: f32, b: f32) -> DoubleSingle {
    let high = a + b;
    DoubleSingle { high, low: b - (high - a) }
}

/// `a + b` exactly.
fn two_sum(a: f32, b: f32) -> DoubleSingle {
    let high = a + b;
    let b_there = high - a;
    DoubleSingle { high, low: (a - (high - b_there)) + (b - b_there) }
}

/// Two halves of 12 bits, whose products are exact.
fn split(a: f32) -> (f32, f32) {
    let shifted = 4097.0 * a;
    let high = shifted - (shifted - a);
    (high, a - high)
}

/// `a b` exactly.
fn two_product(a: f32, b: f32) -> DoubleSingle {
    let high = a * b;
    let ((a_high, a_low), (b_high, b_low)) = (split(a), split(b));
    DoubleSingle { high, low: ((a_high * b_high - high) + a_high * b_low + a_low * b_high) + a_low * b_low }
}

// Operations are not inlined, to save code size.

impl Add for DoubleSingle {
    type Output = Self;

    #[inline(never)]
    fn add(self, other: Self) -> Self {
        let (high, low) = (two_sum(self.high, other.high), two_sum(self.low, other.low));
        let sum = fast_two_sum(high.high, high.low + low.high);
        fast_two_sum(sum.high, low.low + sum.low)
    }
}

impl Neg for DoubleSingle {
    type Output = Self;

    #[inline]
    fn neg(self) -> Self {
        Self { high: -self.high, low: -self.low }
    }
}

impl Sub for DoubleSingle {
    type Output = Self;

    #[inline]
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for DoubleSingle {
    type Output = Self;

    #[inline(never)]
    fn mul(self, other: Self) -> Self {
        let product = two_product(self.high, other.high);
        fast_two_sum(product.high, product.low + (self.high * other.low + self.low * other.high))
    }
}

impl Div for DoubleSingle {
    type Output = Self;

    #[inline(never)]
    fn div(self, other: Self) -> Self {
        let quotient = self.high / other.high;
        let back = other * Self::from(quotient);
        let rest = (self.high - back.high) + (self.low - back.low);
        fast_two_sum(quotient, rest / other.high)
    }
}

impl PartialOrd for DoubleSingle {
    #[inline(never)]
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        match self.high.partial_cmp(&other.high) {
            Some(Ordering::Equal) => self.low.partial_cmp(&other.low),
            order => order,
        }
    }
}

impl From<f32> for DoubleSingle {
    #[inline]
    fn from(value: f32) -> Self {
        Self { high: value, low: 0.0 }
    }
}

impl From<DoubleSingle> for f64 {
    fn from(value: DoubleSingle) -> Self {
        f64::from(value.high) + f64::from(value.low)
    }
}

impl Display for DoubleSingle {
    fn fmt(&self, f: &mut Formatter<'_>) -> FmtResult {
        Display::fmt(&f64::from(*self), f)
    }
}

/// Powers, logarithms and arc tangents are computed in `f64`; a board uses powers and logarithms for an empirical law,
/// and arc tangents never.
impl Real for DoubleSingle {
    const ZERO: Self = Self { high: 0.0, low: 0.0 };
    const ONE: Self = Self { high: 1.0, low: 0.0 };
    const TWO: Self = Self { high: 2.0, low: 0.0 };
    const EPSILON: Self = Self { high: f32::EPSILON * f32::EPSILON, low: 0.0 };
    const MIN_POSITIVE: Self = Self { high: f32::MIN_POSITIVE, low: 0.0 };
    const MAX: Self = Self { high: f32::MAX, low: 0.0 };

    #[inline]
    fn from_f64(value: f64) -> Self {
        let high = value as f32;
        Self { high, low: (value - f64::from(high)) as f32 }
    }
    #[inline]
    fn to_f32(self) -> f32 {
        self.high
    }
    /// Returns zero for arguments below the smallest normal number.
    #[inline(never)]
    fn sqrt(self) -> Self {
        /// A first guess at `1/sqrt(x)`, within 3.5 % (C. Lomont, "Fast inverse square root", Purdue University, 2003).
        const GUESS: u32 = 0x5f37_59df;
        if self.high < f32::MIN_POSITIVE {
            return Self::ZERO;
        }
        if !self.is_finite() {
            return self;
        }
        let half = 0.5 * self.high;
        let mut inverse = f32::from_bits(GUESS.wrapping_sub(self.high.to_bits() >> 1));
        // Newton's steps for 1/sqrt(x); three take 3.5 % below the rounding.
        for _ in 0..3 {
            inverse *= 1.5 - half * inverse * inverse;
        }
        // A last step for the root itself, with the residual of the product.
        let root = self.high * inverse;
        let square = two_product(root, root);
        let rest = ((self.high - square.high) - square.low) + self.low;
        fast_two_sum(root, 0.5 * inverse * rest)
    }
    fn pow(self, exponent: Self) -> Self {
        Self::from_f64(libm::pow(self.into(), exponent.into()))
    }
    fn ln_1p(self) -> Self {
        Self::from_f64(libm::log1p(self.into()))
    }
    fn atan(self) -> Self {
        Self::from_f64(libm::atan(self.into()))
    }
    #[inline]
    fn abs(self) -> Self {
        if self.high < 0.0 { -self } else { self }
    }
    #[inline]
    fn is_finite(self) -> bool {
        self.high.is_finite()
    }
    fn to_rank(self) -> u64 {
        f64::from(self).to_bits()
    }
    fn from_rank(rank: u64) -> Self {
        Self::from_f64(f64::from_bits(rank))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers of every magnitude from 1e-9 to 1e9, with both parts filled.
    fn numbers() -> impl Iterator<Item = f64> + Clone {
        (0..2000_u64).map(|i| {
            let bits = i.wrapping_mul(0x9e37_79b9_7f4a_7c15);
            let mantissa = 1.0 + (bits >> 12) as f64 / (1_u64 << 52) as f64;
            let exponent = (bits % 61) as i32 - 30;
            f64::from(DoubleSingle::from_f64(libm::scalbn(mantissa, exponent)))
        })
    }

    fn worst(ours: impl Fn(DoubleSingle, DoubleSingle) -> DoubleSingle, exact: impl Fn(f64, f64) -> f64) -> f64 {
        let pairs = numbers().zip(numbers().skip(777).chain(numbers()));
        pairs
            .map(|(a, b)| {
                let found = ours(DoubleSingle::from_f64(a), DoubleSingle::from_f64(b));
                assert!(found.low.abs() <= 0.5 * f32::EPSILON * found.high.abs(), "{found:?}");
                (f64::from(found) / exact(a, b) - 1.0).abs()
            })
            .fold(0.0, |worst: f64, error| if error > worst || error.is_nan() { error } else { worst })
    }

    #[test]
    fn operations_are_within_their_bounds() {
        for (name, worst, bound) in [
            ("sum", worst(|a, b| a + b, |a, b| a + b), 1.1e-14),
            ("product", worst(|a, b| a * b, |a, b| a * b), 2.5e-14),
            ("quotient", worst(|a, b| a / b, |a, b| a / b), 5.4e-14),
            ("root", worst(|a, _| a.sqrt(), |a, _| libm::sqrt(a)), 1e-13),
        ] {
            assert!(worst < bound, "{name}: {worst:e}");
            assert!(worst > 1e-3 * bound, "{name}: {worst:e} shows nothing");
        }
    }

    #[test]
    fn a_difference_of_neighbours_keeps_what_is_left() {
        for a in numbers() {
            let (one, other) = (DoubleSingle::from_f64(a), DoubleSingle::from_f64(a * (1.0 - 1e-6)));
            let exact = f64::from(one) - f64::from(other);
            assert!((f64::from(one - other) / exact - 1.0).abs() < 1e-13, "{a:e}");
            assert!(other < one && one.abs() == (-one).abs(), "{a:e}");
        }
    }

    #[test]
    fn overflow_is_not_finite_and_the_root_of_zero_or_less_is_zero() {
        assert_eq!(DoubleSingle::ZERO.sqrt(), DoubleSingle::ZERO);
        assert_eq!(DoubleSingle::from(-1.0).sqrt(), DoubleSingle::ZERO);
        assert_eq!(DoubleSingle::from(f32::INFINITY).sqrt().high.to_bits(), f32::INFINITY.to_bits());
        assert!(!(DoubleSingle::ONE / DoubleSingle::ZERO).is_finite());
        assert!(!(DoubleSingle::from(1e30) * DoubleSingle::from(1e30)).is_finite());
    }
}
