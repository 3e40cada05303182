//! Numbers with a fixed number of decimals. A row of `felt.csv` has eight such numbers, and the standard library takes
//! several times as long for the same digits, because it supports any number of digits.

use std::fmt::{self, Display};

/// Largest number of decimals.
const DECIMALS_MAX: u32 = 9;
/// Bits of an `f64` behind its exponent.
const FRACTION_BITS: u32 = 52;
/// The exponent field of values that equal their significand as an integer.
const EXPONENT_OF_INTEGERS: u32 = 1075;
/// Digits of the largest number, its point and its sign.
const LENGTH_MAX: usize = 22;

/// Displays a finite number with at most [`DECIMALS_MAX`] decimals, in the same digits as `{:.*}`.
pub(super) struct Decimals {
    pub(super) value: f64,
    pub(super) decimals: u32,
}

impl Display for Decimals {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { value, decimals } = *self;
        let Some(mut rest) = scaled(value.abs(), decimals) else {
            return write!(formatter, "{value:.*}", decimals as usize);
        };
        let mut text = [0; LENGTH_MAX];
        let mut begin = LENGTH_MAX;
        let mut prepend = |byte: u8| {
            begin -= 1;
            text[begin] = byte;
        };
        let mut digits = 0;
        while rest > 0 || digits <= decimals {
            if digits == decimals && decimals > 0 {
                prepend(b'.');
            }
            prepend(b'0' + (rest % 10) as u8);
            rest /= 10;
            digits += 1;
        }
        if value.is_sign_negative() {
            prepend(b'-');
        }
        formatter.write_str(std::str::from_utf8(&text[begin..]).unwrap_or_default())
    }
}

/// `value * 10^decimals` for a value of zero or more, rounded to the nearest integer, ties to even; `None` beyond the
/// range of this calculation.
fn scaled(value: f64, decimals: u32) -> Option<u64> {
    if value == 0.0 {
        return Some(0);
    }
    let bits = value.to_bits();
    let exponent = (bits >> FRACTION_BITS) as u32;
    // The value is the significand over 2^shift; the product below has at most 53 + 30 bits.
    let shift = EXPONENT_OF_INTEGERS.checked_sub(exponent)?;
    if !(1..u128::BITS).contains(&shift) || decimals > DECIMALS_MAX {
        return None;
    }
    let significand = (1 << FRACTION_BITS) | (bits & ((1 << FRACTION_BITS) - 1));
    let product = u128::from(significand) * 10_u128.pow(decimals);
    let (whole, rest, half) = (product >> shift, product & ((1 << shift) - 1), 1 << (shift - 1));
    let is_up = rest > half || (rest == half && whole % 2 == 1);
    u64::try_from(whole + u128::from(is_up)).ok()
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn assert_same(value: f64) {
        for decimals in 0..=DECIMALS_MAX {
            let expected = format!("{value:.*}", decimals as usize);
            assert_eq!(Decimals { value, decimals }.to_string(), expected, "{value:e}");
        }
    }

    #[test]
    fn halves_integers_and_the_ends_of_the_range_are_written_as_by_the_standard_library() {
        for value in [
            0.0,
            0.5,
            1.5,
            2.5,
            0.25,
            0.125,
            0.375,
            0.062_5,
            5e-10,
            4.999e-10,
            1e-9,
            9.999_999_999_5,
            0.1,
            1.0,
            1e9,
            123.456,
            9_007_199_254_740_991.0,
            9_007_199_254_740_992.0,
            1.8e19,
            1e300,
            1e-300,
            5e-324,
            1e-38,
            3e-39,
            f64::MIN_POSITIVE,
        ] {
            assert_same(value);
            assert_same(-value);
        }
    }

    proptest! {
        #[test]
        fn all_numbers_are_written_as_by_the_standard_library(value in -1e12..1e12_f64, small in -1e-3..1e-3_f64) {
            assert_same(value);
            assert_same(small);
            // Halves of the last decimal.
            assert_same((value / 1e6).round() / 1024.0);
        }
    }
}
