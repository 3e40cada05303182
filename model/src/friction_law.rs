//! Steady friction of a finger on a screen: by the contact model, or by an empirical law.

use crate::{CarriedContact, EmpiricalLaw, LoadedContact, ParameterError, Ripple};

/// Steady friction as a function of the voltage, under one normal load.
#[derive(Clone, Copy, Debug, PartialEq)]
#[allow(clippy::large_enum_variant, reason = "no allocator to box it, and few values exist")]
pub enum FrictionLaw {
    /// By the contact model, at a constant voltage or as the mean under a carrier.
    Contact(CarriedContact<f64>),
    /// A measured law, which is a mean under the carrier of the measurement.
    Empirical(MeasuredFriction),
}

/// An empirical law, with the friction at no voltage.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MeasuredFriction {
    /// The law, measured under one normal load.
    pub law: EmpiricalLaw,
    /// Friction coefficient without voltage.
    pub friction_coefficient: f64,
    /// Normal load, N. The law does not depend on it: under a load other than the measurement's, only the friction at
    /// no voltage changes, since the rest was not measured.
    pub normal_load_n: f64,
}

impl FrictionLaw {
    /// Friction at no voltage, `mu F_N`, in newtons.
    pub fn natural_friction_n(&self) -> f64 {
        match self {
            Self::Contact(carried) => carried.contact().natural_friction_n(),
            Self::Empirical(measured) => measured.friction_coefficient * measured.normal_load_n,
        }
    }

    /// Normal load in newtons.
    pub fn normal_load_n(&self) -> f64 {
        match self {
            Self::Contact(carried) => carried.contact().normal_load_n(),
            Self::Empirical(measured) => measured.normal_load_n,
        }
    }

    /// Electric friction in newtons at an rms voltage of zero or more.
    pub fn electric_friction_n(&self, voltage_v_rms: f64) -> f64 {
        match self {
            Self::Contact(carried) => carried.electric_friction_n(voltage_v_rms),
            Self::Empirical(measured) => measured.law.electric_friction_n(voltage_v_rms),
        }
    }

    /// The rms voltage in volts for an electric friction in newtons; zero for zero or less.
    pub fn voltage_v_rms(&self, electric_friction_n: f64) -> f64 {
        match self {
            Self::Contact(carried) => carried.voltage_v_rms(electric_friction_n),
            Self::Empirical(measured) => measured.law.voltage_v_rms(electric_friction_n),
        }
    }

    /// The mean friction under a carrier with this ripple. A measured law stays as it is.
    #[must_use]
    pub fn under_carrier(self, ripple: Ripple) -> Self {
        match self {
            Self::Contact(carried) => Self::Contact(carried.contact().under_carrier(ripple)),
            Self::Empirical(_) => self,
        }
    }

    /// The same finger under another load.
    ///
    /// # Errors
    ///
    /// The load is negative or not finite, or too large for the contact model.
    pub fn under_load(&self, normal_load_n: f64) -> Result<Self, ParameterError> {
        match *self {
            Self::Contact(carried) => carried.under_load(normal_load_n).map(Self::Contact),
            Self::Empirical(measured) => {
                let normal_load_n = crate::error::not_negative("normal_load_n", normal_load_n)?;
                Ok(Self::Empirical(MeasuredFriction { normal_load_n, ..measured }))
            }
        }
    }
}

impl From<LoadedContact<f64>> for FrictionLaw {
    /// The friction at a constant voltage.
    fn from(contact: LoadedContact<f64>) -> Self {
        Self::Contact(contact.under_carrier(Ripple::NONE))
    }
}
