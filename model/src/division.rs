//! Division of fixed-point numbers.

use core::num::NonZeroU32;

/// The quotient of `whole * 2^32 + fraction` and `divisor`, rounded down, and the remainder. The divisor must be at
/// most 2^24: a remainder and the next byte have to fit into 32 bits.
///
/// Divides byte by byte in 32 bits, since the library's 64-bit division takes 1 KB of a board's flash.
///
/// ```
/// use core::num::NonZeroU32;
/// use frixel_model::divide_wide;
///
/// let three = NonZeroU32::new(3).ok_or("zero")?;
/// assert_eq!(divide_wide(1, 0, three), (0x5555_5555, 1));
/// # Ok::<(), &str>(())
/// ```
pub fn divide_wide(whole: u32, fraction: u32, divisor: NonZeroU32) -> (u64, u32) {
    let divided = (u64::from(whole / divisor), whole % divisor);
    fraction.to_be_bytes().into_iter().fold(divided, |(quotient, remainder), byte| {
        let digit = (remainder << 8) | u32::from(byte);
        ((quotient << 8) | u64::from(digit / divisor), digit % divisor)
    })
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn a_wide_division_is_exact(whole: u32, fraction: u32, divisor in 1..=1_u32 << 24) {
            let dividend = (u64::from(whole) << 32) | u64::from(fraction);
            let exact = (dividend / u64::from(divisor), (dividend % u64::from(divisor)) as u32);
            prop_assert_eq!(divide_wide(whole, fraction, NonZeroU32::new(divisor).unwrap()), exact);
        }
    }
}
