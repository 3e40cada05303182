//! What the world refuses.

use frixel_model::ParameterError;
use thiserror::Error;

/// A number that lies outside the range in which it means something.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[error("{name} must be {expected}, found {found}")]
pub struct OutOfRange {
    /// Name of the parameter, with its unit.
    pub name: &'static str,
    /// The range that was expected.
    pub expected: &'static str,
    /// The number that was found.
    pub found: f64,
}

/// Why a world cannot be made.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub enum WorldError {
    /// A number of the configuration is out of range.
    #[error("simulated world: {0}")]
    OutOfRange(#[from] OutOfRange),
    /// The contact model refuses the example finger.
    #[error("simulated world: the contact model refuses the example finger: {0:?}")]
    Finger(ParameterError),
}

/// `found`, when it is finite and above zero.
pub(crate) fn above_zero(name: &'static str, found: f64) -> Result<f64, OutOfRange> {
    if found.is_finite() && found > 0.0 {
        Ok(found)
    } else {
        Err(OutOfRange { name, expected: "finite and above 0", found })
    }
}

/// `found`, when it is from zero to ten.
///
/// Ten seconds bounds every delay of the world: beyond it a unit has been mistaken, and queues would grow for nothing.
pub(crate) fn zero_to_ten(name: &'static str, found: f64) -> Result<f64, OutOfRange> {
    if (0.0..=10.0).contains(&found) { Ok(found) } else { Err(OutOfRange { name, expected: "from 0 to 10", found }) }
}
