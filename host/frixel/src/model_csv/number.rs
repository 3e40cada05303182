//! Numbers as cells have them.

use std::fmt::LowerExp;
use std::str::FromStr;

use frixel_model::Real;

/// What the model is computed in.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Precision {
    /// 64 bits.
    #[default]
    F64,
    /// 32 bits: inputs are rounded to them, and so is every step.
    F32,
}

/// A number that is read from a cell and written to one.
pub(super) trait Number: Real + FromStr + LowerExp + 'static {
    /// Significant digits from which the same number is read again.
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
