//! The arithmetic that the model needs, for `f32` and `f64`.

use core::fmt::{Debug, Display};
use core::ops::{Add, Div, Mul, Neg, Sub};

mod sealed {
    pub trait Sealed {}
    impl Sealed for f32 {}
    impl Sealed for f64 {}
    impl Sealed for crate::double_single::DoubleSingle {}
}

/// A real number: `f32` or `f64`. Functions are those of `libm`, so that desktop and chip compute the same bits.
pub trait Real:
    sealed::Sealed
    + Copy
    + Debug
    + Display
    + PartialOrd
    + From<f32>
    + Into<f64>
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// Zero.
    const ZERO: Self;
    /// One.
    const ONE: Self;
    /// Two.
    const TWO: Self;
    /// Distance from one to the next larger number.
    const EPSILON: Self;
    /// Smallest positive normal number.
    const MIN_POSITIVE: Self;
    /// Largest finite number.
    const MAX: Self;

    /// The nearest number to `value`.
    fn from_f64(value: f64) -> Self;
    /// The nearest `f32`.
    fn to_f32(self) -> f32;
    /// Square root, correctly rounded.
    #[must_use]
    fn sqrt(self) -> Self;
    /// `self` to the power `exponent`, within one unit in the last place.
    #[must_use]
    fn pow(self, exponent: Self) -> Self;
    /// Logarithm of `1 + self`, within one unit in the last place.
    #[must_use]
    fn ln_1p(self) -> Self;
    /// Arc tangent in radians, within one unit in the last place.
    #[must_use]
    fn atan(self) -> Self;
    /// Magnitude.
    #[must_use]
    fn abs(self) -> Self;
    /// Whether it is neither infinite nor NaN.
    fn is_finite(self) -> bool;
    /// An integer for each value. For values of zero and above, it ascends with the value.
    fn to_rank(self) -> u64;
    /// The value of a rank.
    fn from_rank(rank: u64) -> Self;

    /// The lesser of two numbers.
    #[must_use]
    fn min(self, other: Self) -> Self {
        if other < self { other } else { self }
    }
    /// The greater of two numbers.
    #[must_use]
    fn max(self, other: Self) -> Self {
        if other > self { other } else { self }
    }
}

impl Real for f64 {
    const ZERO: Self = 0.0;
    const ONE: Self = 1.0;
    const TWO: Self = 2.0;
    const EPSILON: Self = f64::EPSILON;
    const MIN_POSITIVE: Self = f64::MIN_POSITIVE;
    const MAX: Self = f64::MAX;

    fn from_f64(value: f64) -> Self {
        value
    }
    fn to_f32(self) -> f32 {
        self as f32
    }
    fn sqrt(self) -> Self {
        libm::sqrt(self)
    }
    fn pow(self, exponent: Self) -> Self {
        libm::pow(self, exponent)
    }
    fn ln_1p(self) -> Self {
        libm::log1p(self)
    }
    fn atan(self) -> Self {
        libm::atan(self)
    }
    fn abs(self) -> Self {
        libm::fabs(self)
    }
    fn is_finite(self) -> bool {
        f64::is_finite(self)
    }
    fn to_rank(self) -> u64 {
        self.to_bits()
    }
    fn from_rank(rank: u64) -> Self {
        Self::from_bits(rank)
    }
}

impl Real for f32 {
    const ZERO: Self = 0.0;
    const ONE: Self = 1.0;
    const TWO: Self = 2.0;
    const EPSILON: Self = f32::EPSILON;
    const MIN_POSITIVE: Self = f32::MIN_POSITIVE;
    const MAX: Self = f32::MAX;

    fn from_f64(value: f64) -> Self {
        value as f32
    }
    fn to_f32(self) -> f32 {
        self
    }
    fn sqrt(self) -> Self {
        libm::sqrtf(self)
    }
    fn pow(self, exponent: Self) -> Self {
        libm::powf(self, exponent)
    }
    fn ln_1p(self) -> Self {
        libm::log1pf(self)
    }
    fn atan(self) -> Self {
        libm::atanf(self)
    }
    fn abs(self) -> Self {
        libm::fabsf(self)
    }
    fn is_finite(self) -> bool {
        f32::is_finite(self)
    }
    fn to_rank(self) -> u64 {
        u64::from(self.to_bits())
    }
    fn from_rank(rank: u64) -> Self {
        Self::from_bits(rank as u32)
    }
}
