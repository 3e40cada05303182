//! Errors of the model.

use core::error::Error;
use core::fmt::{Display, Formatter, Result as FmtResult};

use crate::Real;

/// The requirement on a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Expected {
    /// Finite and above zero.
    Positive,
    /// Finite and not below zero.
    NotNegative,
    /// Finite.
    Finite,
    /// Above zero and at most one.
    StressExponent,
    /// Finite and at least one.
    AtLeastOne,
    /// The parameter and the scales derived from it are in the normal range of the precision.
    Representable,
    /// Not beyond the outer radius.
    WithinOuterRadius,
}

/// A parameter that the model refuses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParameterError {
    /// The name of the field or argument.
    pub parameter: &'static str,
    /// The requirement that it violates.
    pub expected: Expected,
    /// Its value.
    pub found: f64,
}

impl Display for ParameterError {
    fn fmt(&self, f: &mut Formatter<'_>) -> FmtResult {
        let Self { parameter, found, .. } = self;
        let expected = match self.expected {
            Expected::Positive => "must be finite and above zero",
            Expected::NotNegative => "must be finite and not below zero",
            Expected::Finite => "must be finite",
            Expected::StressExponent => "must be above zero and at most one",
            Expected::AtLeastOne => "must be finite and at least one",
            Expected::Representable => {
                return write!(
                    f,
                    "{parameter} of {found:e} leads to numbers too large or too small for this precision"
                );
            }
            Expected::WithinOuterRadius => "must not be beyond the outer radius",
        };
        write!(f, "{parameter} {expected}, but is {found:e}")
    }
}

impl Error for ParameterError {}

/// Why a contact has no state at a voltage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StateError {
    /// The finger is pulled off the screen: there is no contact, and no friction.
    NoContact,
    /// The contact would extend beyond the outer radius.
    PassesOuterRadius,
    /// The result is too large or too small for the precision.
    OutOfRange,
    /// The root-finder did not close its bracket.
    NotConverged,
    /// An argument is invalid.
    Parameter(ParameterError),
}

impl Display for StateError {
    fn fmt(&self, f: &mut Formatter<'_>) -> FmtResult {
        match self {
            Self::NoContact => f.write_str("no contact: the pull is stronger than the attraction at this voltage"),
            Self::PassesOuterRadius => f.write_str("the contact would exceed the outer radius; lower load or voltage"),
            Self::OutOfRange => f.write_str("the answer is too large or too small for this precision"),
            Self::NotConverged => f.write_str("the root-finder did not converge"),
            Self::Parameter(error) => error.fmt(f),
        }
    }
}

impl Error for StateError {}

/// Why there is no voltage for a friction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum InverseError {
    /// The friction is below the friction at zero voltage.
    BelowNatural,
    /// The contact at this friction is on the unstable branch, below pull-off.
    Unstable,
    /// The contact at this friction would extend beyond the outer radius.
    PassesOuterRadius,
    /// The result is too large or too small for the precision.
    OutOfRange,
    /// The root-finder did not close its bracket.
    NotConverged,
    /// An argument is invalid.
    Parameter(ParameterError),
}

impl Display for InverseError {
    fn fmt(&self, f: &mut Formatter<'_>) -> FmtResult {
        match self {
            Self::BelowNatural => f.write_str("the friction is below the finger's natural friction"),
            Self::Unstable => f.write_str("the contact of this friction is unstable: it is below pull-off"),
            Self::PassesOuterRadius => f.write_str("this friction needs a contact beyond the outer radius"),
            Self::OutOfRange => f.write_str("the answer is too large or too small for this precision"),
            Self::NotConverged => f.write_str("the root-finder did not converge"),
            Self::Parameter(error) => error.fmt(f),
        }
    }
}

impl Error for InverseError {}

impl From<ParameterError> for StateError {
    fn from(error: ParameterError) -> Self {
        Self::Parameter(error)
    }
}

impl From<ParameterError> for InverseError {
    fn from(error: ParameterError) -> Self {
        Self::Parameter(error)
    }
}

fn require<T: Real>(holds: bool, parameter: &'static str, value: T, expected: Expected) -> Result<T, ParameterError> {
    if holds && value.is_finite() {
        Ok(value)
    } else {
        Err(ParameterError { parameter, expected, found: value.into() })
    }
}

pub(crate) fn positive<T: Real>(parameter: &'static str, value: T) -> Result<T, ParameterError> {
    require(value > T::ZERO, parameter, value, Expected::Positive)
}

pub(crate) fn not_negative<T: Real>(parameter: &'static str, value: T) -> Result<T, ParameterError> {
    require(value >= T::ZERO, parameter, value, Expected::NotNegative)
}

pub(crate) fn finite<T: Real>(parameter: &'static str, value: T) -> Result<T, ParameterError> {
    require(true, parameter, value, Expected::Finite)
}

pub(crate) fn stress_exponent<T: Real>(value: T) -> Result<T, ParameterError> {
    require(value > T::ZERO && value <= T::ONE, "stress_exponent", value, Expected::StressExponent)
}

pub(crate) fn at_least_one<T: Real>(parameter: &'static str, value: T) -> Result<T, ParameterError> {
    require(value >= T::ONE, parameter, value, Expected::AtLeastOne)
}

/// Returns `value`, computed from the parameter `found`, or an error if it is not finite.
pub(crate) fn representable<T: Real>(parameter: &'static str, found: T, value: T) -> Result<T, ParameterError> {
    if value.is_finite() {
        Ok(value)
    } else {
        Err(ParameterError { parameter, expected: Expected::Representable, found: found.into() })
    }
}

/// Checks the target electric friction of a contact under a load of zero or more.
pub(crate) fn checked_target_n<T: Real>(electric_friction_n: T) -> Result<T, InverseError> {
    if finite("electric_friction_n", electric_friction_n)? < T::ZERO {
        Err(InverseError::BelowNatural)
    } else {
        Ok(electric_friction_n)
    }
}

/// Returns the computed voltage, or an error if it is not finite.
pub(crate) fn found_voltage_v_rms<T: Real>(voltage_v_rms: T) -> Result<T, InverseError> {
    if voltage_v_rms.is_finite() { Ok(voltage_v_rms) } else { Err(InverseError::OutOfRange) }
}

/// Rounds `value`, computed in f64 from `parameter` and others, to the precision of the model.
pub(crate) fn round_to_model<T: Real>(parameter: &'static str, found: T, value: f64) -> Result<T, ParameterError> {
    let rounded = T::from_f64(value);
    if rounded >= T::MIN_POSITIVE && rounded.is_finite() {
        Ok(rounded)
    } else {
        Err(ParameterError { parameter, expected: Expected::Representable, found: found.into() })
    }
}
