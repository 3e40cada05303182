//! Double-single arithmetic: numbers of about 44 bits as sums of two `f32`. A board uses it where `f32` is not precise
//! enough, since its FPU lacks `f64`, and software `f64` would enlarge the firmware image.

use core::cmp::Ordering;
use core::fmt::{Display, Formatter, Result as FmtResult};
use core::ops::{Add, Div, Mul, Neg, Sub};

use crate::Real;

/// The unevaluated sum of two `f32`, the second of which is at most half a last bit of the first.
///
/// Relative errors: 1.1e-14 for a sum of like signs, 2.5e-14 for a product, 5.4e-14 for a quotient, 1e-13 for a root,
/// while the second part, 1e-14 of the number, is a normal `f32`; below about 1e-24 they grow to those of `f32`.
/// Factors must be below 8e34. Algorithms 6, 10 and 17 of M. Joldes, J.-M. Muller, V. Popescu, "Tight and rigorous
/// error bounds for basic building blocks of double-word arithmetic", ACM TOMS 44(2), 2017, doi:10.1145/3121432.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct DoubleSingle {
    high: f32,
    low: f32,
}

/// `ln 2`.
const LN_2: DoubleSingle = DoubleSingle::of(core::f64::consts::LN_2);
/// Coefficients of `atanh(s)/s` in `s^2`, for `|s|` up to 0.172, where the next one adds less than 1e-15. The `f32`
/// coefficients add less than 1e-7.
const ATANH: Polynomial = Polynomial {
    leading: &[
        DoubleSingle::of(1.0),
        DoubleSingle::of(1.0 / 3.0),
        DoubleSingle::of(1.0 / 5.0),
        DoubleSingle::of(1.0 / 7.0),
    ],
    others: &[1.0 / 9.0, 1.0 / 11.0, 1.0 / 13.0, 1.0 / 15.0, 1.0 / 17.0],
};
/// Coefficients of `exp(r)`, for `|r|` up to 0.347, where the next one adds less than 2e-16. The `f32` coefficients add
/// less than 2e-7.
const EXP: Polynomial = Polynomial {
    leading: &[
        DoubleSingle::of(1.0),
        DoubleSingle::of(1.0),
        DoubleSingle::of(1.0 / 2.0),
        DoubleSingle::of(1.0 / 6.0),
        DoubleSingle::of(1.0 / 24.0),
        DoubleSingle::of(1.0 / 120.0),
        DoubleSingle::of(1.0 / 720.0),
    ],
    others: &[
        1.0 / 5_040.0,
        1.0 / 40_320.0,
        1.0 / 362_880.0,
        1.0 / 3_628_800.0,
        1.0 / 39_916_800.0,
        1.0 / 479_001_600.0,
    ],
};
/// Bits of the significand of an `f32` below its leading one.
const SIGNIFICAND_BITS: u32 = f32::MANTISSA_DIGITS - 1;
/// Bias of an `f32` exponent.
const EXPONENT_BIAS: i32 = f32::MAX_EXP - 1;
/// Largest argument of [`DoubleSingle::ln`].
const LN_MAX: f32 = 1e38;
/// Range of the argument of [`DoubleSingle::exp`]; outside, the result is not a normal `f32`.
const EXP_RANGE: [f32; 2] = [-87.0, 88.0];

/// A polynomial, the constant coefficient first.
struct Polynomial {
    leading: &'static [DoubleSingle],
    /// Coefficients that add so little that `f32` is precise enough.
    others: &'static [f32],
}

impl Polynomial {
    #[inline(never)]
    fn at(&self, x: DoubleSingle) -> DoubleSingle {
        let rest = self.others.iter().rev().fold(0.0, |sum, coefficient| sum * x.high + coefficient);
        self.leading.iter().rev().fold(DoubleSingle::from(rest), |sum, coefficient| sum * x + *coefficient)
    }
}

impl DoubleSingle {
    /// The nearest number to `value`.
    const fn of(value: f64) -> Self {
        let high = value as f32;
        Self { high, low: (value - high as f64) as f32 }
    }

    /// The product with `2^exponent`, which must be a normal number.
    fn times_power_of_two(self, exponent: i32) -> Self {
        let factor = f32::from_bits(((exponent + EXPONENT_BIAS) as u32) << SIGNIFICAND_BITS);
        Self { high: self.high * factor, low: self.low * factor }
    }

    /// Logarithm of `1 + self`, from sqrt(1/2) to sqrt(2).
    #[inline(never)]
    fn ln_1p_near_zero(self) -> Self {
        let s = self / (Self::TWO + self);
        // Not doubled by a product: when building for size, the compiler would call the third one through a register,
        // and the stack depth could not be computed from the image.
        let half = s * ATANH.at(s * s);
        half + half
    }

    /// Logarithm of a number from the smallest normal one to [`LN_MAX`]; NaN otherwise.
    #[inline(never)]
    fn ln(self) -> Self {
        if !(self.high >= f32::MIN_POSITIVE && self.high <= LN_MAX) {
            return Self::from(f32::NAN);
        }
        // The significand from sqrt(1/2) to sqrt(2).
        let above = self.high.to_bits().wrapping_sub(core::f32::consts::FRAC_1_SQRT_2.to_bits());
        let exponent = above as i32 >> SIGNIFICAND_BITS;
        let significand = self.times_power_of_two(-exponent);
        (significand - Self::ONE).ln_1p_near_zero() + LN_2 * Self::from(exponent as f32)
    }

    /// Zero and infinity beyond [`EXP_RANGE`].
    #[inline(never)]
    fn exp(self) -> Self {
        let [least, largest] = EXP_RANGE;
        if self.high < least {
            return Self::ZERO;
        }
        if self.high > largest {
            return Self::from(f32::INFINITY);
        }
        let halves = self.high / LN_2.high;
        let exponent = (halves + if halves < 0.0 { -0.5 } else { 0.5 }) as i32;
        let rest = self - LN_2 * Self::from(exponent as f32);
        EXP.at(rest).times_power_of_two(exponent)
    }
}

/// Square root of an `f32`, by that of [`DoubleSingle`], which a board needs anyway: that of `libm` takes 500 bytes more.
pub(crate) fn square_root(square: f32) -> f32 {
    DoubleSingle::from(square).sqrt().to_f32()
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

/// Arc tangents are computed in `f64`; a board never uses them.
impl Real for DoubleSingle {
    const ZERO: Self = Self { high: 0.0, low: 0.0 };
    const ONE: Self = Self { high: 1.0, low: 0.0 };
    const TWO: Self = Self { high: 2.0, low: 0.0 };
    const EPSILON: Self = Self { high: f32::EPSILON * f32::EPSILON, low: 0.0 };
    const MIN_POSITIVE: Self = Self { high: f32::MIN_POSITIVE, low: 0.0 };
    const MAX: Self = Self { high: f32::MAX, low: 0.0 };

    #[inline]
    fn from_f64(value: f64) -> Self {
        Self::of(value)
    }
    #[inline]
    fn to_f32(self) -> f32 {
        self.high
    }
    /// Returns zero for arguments below the smallest normal number.
    #[inline(never)]
    fn sqrt(self) -> Self {
        /// Constant of a first guess at `1/sqrt(x)`, within 3.5 % (C. Lomont, "Fast inverse square root", Purdue
        /// University, 2003).
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
    /// Within 2e-12 from 1e-37 to 1e38; zero and infinity outside. Zero for bases below the smallest normal number, NaN
    /// for bases above 1e38.
    #[inline(never)]
    fn pow(self, exponent: Self) -> Self {
        if self.high < f32::MIN_POSITIVE {
            return Self::ZERO;
        }
        (exponent * self.ln()).exp()
    }
    /// Within 1e-13; NaN above 1e38, and for arguments of -1 or less.
    fn ln_1p(self) -> Self {
        if self.high.abs() < 0.25 { self.ln_1p_near_zero() } else { (Self::ONE + self).ln() }
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

    /// A number from -1/2 to 0.
    fn below_one(a: DoubleSingle) -> DoubleSingle {
        -(DoubleSingle::ONE / (DoubleSingle::TWO + a))
    }

    #[test]
    fn operations_are_within_their_bounds() {
        let third = DoubleSingle::ONE / DoubleSingle::from(3.0);
        for (name, worst, bound) in [
            ("sum", worst(|a, b| a + b, |a, b| a + b), 1.1e-14),
            ("product", worst(|a, b| a * b, |a, b| a * b), 2.5e-14),
            ("quotient", worst(|a, b| a / b, |a, b| a / b), 5.4e-14),
            ("root", worst(|a, _| a.sqrt(), |a, _| libm::sqrt(a)), 1e-13),
            ("logarithm", worst(|a, _| a.ln_1p(), |a, _| libm::log1p(a)), 1e-13),
            (
                "logarithm below 1",
                worst(|a, _| below_one(a).ln_1p(), |a, _| libm::log1p(below_one(DoubleSingle::from_f64(a)).into())),
                1e-13,
            ),
            ("power", worst(|a, _| a.pow(third), |a, _| libm::pow(a, third.into())), 1e-13),
            ("square", worst(|a, _| a.pow(DoubleSingle::TWO), |a, _| a * a), 1e-12),
        ] {
            assert!(worst < bound, "{name}: {worst:e}");
            assert!(worst > 1e-3 * bound, "{name}: {worst:e} is too small to be a real error");
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
    fn powers_and_logarithms_end_at_their_documented_limits() {
        let pow = |base: f32, exponent: f32| DoubleSingle::from(base).pow(DoubleSingle::from(exponent));
        for base in [1.5e-38_f32, 1e-30, 0.3, 1.0, 2.5, 1e30, 1e38] {
            for exponent in [-3.0_f32, -1.0, -0.3, 0.0, 1e-3, 0.7, 1.0, 12.0] {
                let (found, exact) = (pow(base, exponent), libm::pow(base.into(), exponent.into()));
                if (1e-37..1e38).contains(&exact) {
                    assert!((f64::from(found) / exact - 1.0).abs() < 2e-12, "{base:e}^{exponent}: {found} {exact:e}");
                } else {
                    assert!(found.high == 0.0 || found.high > 1e38, "{base:e}^{exponent}: {found}");
                }
            }
        }
        assert_eq!((pow(0.0, 2.0), pow(-1.0, 2.0)), (DoubleSingle::ZERO, DoubleSingle::ZERO));
        assert!(pow(f32::NAN, 2.0).high.is_nan() && pow(f32::INFINITY, 2.0).high.is_nan());
        for outside in [-1.0, -2.0, 1.1e38, f32::INFINITY, f32::NAN] {
            assert!(DoubleSingle::from(outside).ln_1p().high.is_nan(), "{outside}");
        }
        assert_eq!(DoubleSingle::ZERO.ln_1p(), DoubleSingle::ZERO);
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
