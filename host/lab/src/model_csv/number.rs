//! Parsing and formatting of numbers in cells.

use std::fmt::LowerExp;
use std::str::FromStr;

use frixel_model::Real;

/// Floating-point type of the computation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Precision {
    /// 64 bits.
    #[default]
    F64,
    /// 32 bits: inputs are rounded to 32 bits, and every step computes with 32 bits.
    F32,
}

/// A number that is read from a cell and written to one.
pub(super) trait Number: Real + FromStr + LowerExp + 'static {
    /// Number of significant digits from which the same number can be read back.
    const DIGITS: usize;

    fn digits(self) -> String {
        if self == Self::ZERO { "0".to_owned() } else { format!("{self:.*e}", Self::DIGITS - 1) }
    }
}

impl Number for f64 {
    const DIGITS: usize = 17;
}

impl Number for f32 {
    const DIGITS: usize = 9;
}
