//! Winkler-Fuss contact of a finger with a coated screen, with a normal load: Eqs. (43), (21).

use crate::Real;

/// Vacuum permittivity in F/m, CODATA 2022.
const VACUUM_PERMITTIVITY_F_PER_M: f64 = 8.854_187_818_8e-12;

/// The finger's parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Finger<T> {
    /// Radius of curvature `R` at the contact, in metres.
    pub radius_m: T,
    /// Winkler-Fuss stiffness `k`, in Pa/m.
    pub stiffness_pa_per_m: T,
    /// Coefficient of friction `mu`.
    pub friction_coefficient: T,
}

/// A parameter that the model refuses, by name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ParameterError {
    /// The named parameter is not finite, or is not above zero.
    NotPositive(&'static str),
    /// The named parameter is not finite, or is below zero.
    Negative(&'static str),
}

/// A finger on a coating: the model's scales.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact<T> {
    voltage_scale_v: T,
    friction_scale_n: T,
    friction_coefficient: T,
}

impl<T: Real> Contact<T> {
    /// Scales for `finger` on a coating of effective gap `gap_m` (thickness over relative permittivity).
    pub fn new(finger: &Finger<T>, gap_m: T) -> Result<Self, ParameterError> {
        let zero = T::from_f64(0.0);
        for (name, value) in [
            ("radius_m", finger.radius_m),
            ("stiffness_pa_per_m", finger.stiffness_pa_per_m),
            ("friction_coefficient", finger.friction_coefficient),
            ("gap_m", gap_m),
        ] {
            if !(value.is_finite() && value > zero) {
                return Err(ParameterError::NotPositive(name));
            }
        }
        let two = T::from_f64(2.0);
        let eps0 = T::from_f64(VACUUM_PERMITTIVITY_F_PER_M);
        let pi = T::from_f64(core::f64::consts::PI);
        Ok(Self {
            voltage_scale_v: (two * finger.stiffness_pa_per_m * gap_m * gap_m * gap_m / eps0).sqrt(),
            friction_scale_n: finger.friction_coefficient
                * pi
                * finger.stiffness_pa_per_m
                * finger.radius_m
                * gap_m
                * gap_m,
            friction_coefficient: finger.friction_coefficient,
        })
    }

    /// The same contact under a normal load of zero or more newtons.
    pub fn under_load(self, normal_load_n: T) -> Result<LoadedContact<T>, ParameterError> {
        let zero = T::from_f64(0.0);
        if !(normal_load_n.is_finite() && normal_load_n >= zero) {
            return Err(ParameterError::Negative("normal_load_n"));
        }
        Ok(LoadedContact {
            contact: self,
            natural_friction_n: self.friction_coefficient * normal_load_n,
            load: self.friction_coefficient * normal_load_n / self.friction_scale_n,
        })
    }
}

/// A contact under a fixed normal load `F_N >= 0`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoadedContact<T> {
    contact: Contact<T>,
    natural_friction_n: T,
    load: T,
}

impl<T: Real> LoadedContact<T> {
    /// Friction at no voltage, `mu F_N`, in newtons.
    pub fn natural_friction_n(&self) -> T {
        self.natural_friction_n
    }

    /// Electric friction `x = F_T - mu F_N` in newtons at an rms voltage, Eqs. (43), (21).
    pub fn electric_friction_n(&self, voltage_v_rms: T) -> T {
        let ratio = voltage_v_rms / self.contact.voltage_scale_v;
        let q = ratio * ratio;
        let one = T::from_f64(1.0);
        let two = T::from_f64(2.0);
        let pull = two * q / (one + q);
        let y = q + (q * q + pull + self.load).sqrt();
        self.contact.friction_scale_n * (two * q * y + pull)
    }

    /// The rms voltage that gives the electric friction `electric_friction_n >= 0`, in volts.
    pub fn voltage_v_rms(&self, electric_friction_n: T) -> T {
        let zero = T::from_f64(0.0);
        if !(electric_friction_n > zero) {
            return zero;
        }
        let two = T::from_f64(2.0);
        let eight = T::from_f64(8.0);
        let u = electric_friction_n / self.contact.friction_scale_n;
        let y = (self.load + u).sqrt();
        let r = u / y;
        let b = two + two / y - r;
        let root = (b * b + eight * r).sqrt();
        let q = if b >= zero { two * r / (b + root) } else { (root - b) / T::from_f64(4.0) };
        self.contact.voltage_scale_v * q.sqrt()
    }
}
