//! The friction that a drive can render on a finger.

use frixel_layers::Header;
use frixel_model::{ContactModel, Finger, FrictionLaw, InverseTable, LawError, ParameterError, Ripple, TableError};
use thiserror::Error;

/// Relative tolerance for friction beyond the reach: the rounding error of `f32`.
pub const ROUNDING: f64 = 1e-6;

/// The range of friction that the drive can render: from natural friction, `mu F_N`, to that plus the largest electric
/// friction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reach {
    /// Friction at no voltage, `mu F_N`, in newtons.
    pub natural_friction_n: f64,
    /// Electric friction at the largest voltage, in newtons, Eqs. (43), (21).
    pub electric_friction_max_n: f64,
    /// The largest rms voltage, within the limits of scene, screen and board, in volts.
    pub voltage_max_v_rms: f64,
}

/// The reason why a board cannot play a finger on a coating.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
pub(super) enum ReachError {
    #[error("the contact model refuses the finger: {0}")]
    Contact(ParameterError),
    #[error("the contact would be {contact_m} m wide")]
    TooWide { contact_m: f64 },
    #[error("its friction between 1 V and the largest voltage does not fit the board's table")]
    Table,
}

impl Reach {
    /// Computes the reach from the finger, coating and rms voltage of a header under a carrier, with the board's `f32`
    /// numbers.
    pub(super) fn of(header: &Header, ripple: Ripple) -> Result<Self, ReachError> {
        let law = header.friction_law().map_err(ReachError::Contact)?.under_carrier(ripple);
        let voltage_max_v_rms = f64::from(header.voltage_max_v_rms);
        if let FrictionLaw::Contact(carried) = law {
            let contact_m =
                carried.contact().state(voltage_max_v_rms).map_or(f64::INFINITY, |state| state.contact_radius_m);
            if contact_m > f64::from(header.finger_radius_m) {
                return Err(ReachError::TooWide { contact_m });
            }
        }
        check_table(header, ripple)?;
        Ok(Self {
            natural_friction_n: law.natural_friction_n(),
            electric_friction_max_n: law.electric_friction_n(voltage_max_v_rms),
            voltage_max_v_rms,
        })
    }

    /// Smallest total friction, in newtons.
    pub fn friction_min_n(&self) -> f64 {
        self.natural_friction_n
    }

    /// Largest total friction, in newtons.
    pub fn friction_max_n(&self) -> f64 {
        self.natural_friction_n + self.electric_friction_max_n
    }
}

/// Computes the table as the board does at the commit of a scene.
fn check_table(header: &Header, ripple: Ripple) -> Result<(), ReachError> {
    let voltage_max_v_rms = header.voltage_max_v_rms;
    if let Some(law) = &header.law {
        let table = InverseTable::of_law(law.exponent(), law.points(), voltage_max_v_rms, f32::INFINITY);
        return table.map(|_| ()).map_err(|_: LawError| ReachError::Table);
    }
    let finger = Finger {
        radius_m: header.finger_radius_m,
        stiffness_pa_per_m: header.stiffness_pa_per_m,
        friction_coefficient: header.friction_coefficient,
    };
    let (gap_m, normal_load_n) = (header.effective_gap_m, header.normal_load_n);
    InverseTable::of_finger(&finger, gap_m, normal_load_n, &ripple, voltage_max_v_rms, f32::INFINITY)
        .map(|_| ())
        .map_err(|_: TableError| ReachError::Table)
}
