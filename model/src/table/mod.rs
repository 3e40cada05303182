//! Tables from electric friction to rms voltage, evaluated without root, division or logarithm.
//!
//! The bits of an `f32`, read as an integer, are a piecewise linear logarithm of its value. Each row covers the same
//! number of successive bit patterns and holds a polynomial in the friction itself. Rows therefore need not be aligned
//! with octaves, and the last row ends exactly at the largest friction.
//!
//! # The error bound
//!
//! Each polynomial of `C` coefficients passes through `C` points of the curve `V(x)`, including the two ends of its
//! row. With `s = d ln x/d ln V`, the interpolation's relative error in friction is at most `s |x^C V^(C)|/(C! V)`
//! times the largest product of distances to those points, `W (half width/x)^C`. The first factor depends only on
//! dimensionless friction and load; `reference/table_constants.py` finds its supremum over all frictions and all loads
//! of zero or more, so the bound holds for every finger and coating. Rounding and the margin of the last row to the
//! largest voltage add to the bound (`src/table/bound.rs`).

mod bound;
mod builder;
mod fixed;
mod float;
mod interpolation;
mod inverse;

use core::error::Error;
use core::fmt::{Display, Formatter, Result as FmtResult};

pub use builder::{Precision, TableBuilder, TableShape};
pub use fixed::FixedTable;
pub use float::SizedTable;
pub(crate) use float::{FRICTION_MAX_N, RowGrid, round_down};
pub(crate) use interpolation::{Curve, Point};
pub use inverse::{EmpiricalTableFilling, InverseTable, InverseTableFilling};
pub(crate) use inverse::{LAW_DENSITY, LAW_ROWS};

/// Why a table cannot be built.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TableError {
    /// The largest voltage is not finite or not above zero.
    Voltage,
    /// Finger, gap or load are not finite, or not above zero (the load may be zero), or lead to scales that are too
    /// large or too small for `f32`.
    Contact,
    /// The range of frictions is empty, or does not begin above zero.
    Range,
    /// The error target is below the rounding error of the precision.
    Target,
    /// The range needs more rows than the table has.
    TooManySegments,
    /// A friction in the range, or a coefficient, is too large or too small for the precision.
    Unrepresentable,
}

impl Display for TableError {
    fn fmt(&self, f: &mut Formatter<'_>) -> FmtResult {
        f.write_str(match self {
            Self::Voltage => "the largest voltage must be finite and above zero",
            Self::Contact => {
                "finger, gap and load must be finite and above zero, and friction and voltage scales fit into f32"
            }
            Self::Range => "the range of frictions must begin above zero and not be empty",
            Self::Target => "the error target is below the rounding error of the table's precision; allow a larger one",
            Self::TooManySegments => "the range of frictions needs more rows than the table has room for; narrow it",
            Self::Unrepresentable => "a friction or coefficient is too large or too small for the table's precision",
        })
    }
}

impl Error for TableError {}
