//! Errors in the configuration of the world.

use core::ops::RangeInclusive;

use frixel_model::ParameterError;
use thiserror::Error;

/// A number outside its valid range.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[error("{name} must be {expected}, found {found}")]
pub struct OutOfRange {
    /// Name of the parameter, with its unit.
    pub name: &'static str,
    /// The valid range.
    pub expected: &'static str,
    /// The number that was found.
    pub found: f64,
}

/// Why a world cannot be created.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum WorldError {
    /// A number of the configuration is out of range.
    #[error("simulated world: {0}")]
    OutOfRange(#[from] OutOfRange),
    /// The contact model refuses the example finger.
    #[error("simulated world: the contact model refuses the example finger: {0}")]
    Finger(ParameterError),
}

/// Returns `found` if it is finite and above zero.
pub(crate) fn above_zero(name: &'static str, found: f64) -> Result<f64, OutOfRange> {
    if found.is_finite() && found > 0.0 {
        Ok(found)
    } else {
        Err(OutOfRange { name, expected: "finite and above 0", found })
    }
}

/// Returns `found` if it is in `range`, which `expected` describes.
pub(crate) fn within(
    name: &'static str,
    range: RangeInclusive<f64>,
    expected: &'static str,
    found: f64,
) -> Result<f64, OutOfRange> {
    if range.contains(&found) { Ok(found) } else { Err(OutOfRange { name, expected, found }) }
}

/// Returns `found` if it is from zero to ten.
///
/// Ten seconds is the limit of every delay in the world. A longer one is probably in the wrong unit, and would make the
/// queues grow.
pub(crate) fn zero_to_ten(name: &'static str, found: f64) -> Result<f64, OutOfRange> {
    within(name, 0.0..=10.0, "from 0 to 10", found)
}

/// Returns `found` if it is from zero to one.
pub(crate) fn zero_to_one(name: &'static str, found: f64) -> Result<f64, OutOfRange> {
    within(name, 0.0..=1.0, "from 0 to 1", found)
}
