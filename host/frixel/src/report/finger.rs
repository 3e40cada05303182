//! The finger that figures are drawn for: that of the scene, on its screen.

use frixel_model::{Contact, Finger, ParameterError, Real};
use frixel_scene::Program;

use super::error::ReportError;

/// The finger of a program.
pub(super) struct DrawnFinger {
    pub(super) finger: Finger<f64>,
    /// Effective gap of coating and skin, in metres.
    pub(super) gap_m: f64,
    /// Normal load, in newtons.
    pub(super) load_n: f64,
    /// Last sentence of the caption of a figure about this finger.
    pub(super) caption: String,
}

impl DrawnFinger {
    /// The finger that a program is compiled for, by the board's numbers. Rejects one without a contact model.
    pub(super) fn of(program: &Program) -> Result<Self, ReportError> {
        if program.header.law.is_some() {
            return Err(ReportError::EmpiricalFinger { title: program.finger.title.clone() });
        }
        let (header, reach) = (&program.header, &program.reach);
        let finger = Finger {
            radius_m: header.finger_radius_m.into(),
            stiffness_pa_per_m: header.stiffness_pa_per_m.into(),
            friction_coefficient: header.friction_coefficient.into(),
        };
        let (gap_m, load_n) = (f64::from(header.effective_gap_m), f64::from(header.normal_load_n));
        let caption = format!(
            "Drawn for {}, {}: R = {:.3} mm, k = {:.3} MPa/m, µ = {:.3}, on an effective gap of {:.3} µm ({:.0} mN of \
             friction without voltage under {load_n:.3} N, and {:.0} mN more at {:.0} V rms).",
            program.finger.title,
            program.finger.origin.word(),
            1e3 * finger.radius_m,
            1e-6 * finger.stiffness_pa_per_m,
            finger.friction_coefficient,
            1e6 * gap_m,
            1e3 * reach.natural_friction_n,
            1e3 * reach.electric_friction_max_n,
            reach.voltage_max_v_rms,
        );
        Ok(Self { finger, gap_m, load_n, caption })
    }

    /// The finger on its gap, in either precision.
    pub(super) fn contact<T: Real>(&self) -> Result<Contact<T>, ParameterError> {
        let Finger { radius_m, stiffness_pa_per_m, friction_coefficient } = self.finger;
        let finger = Finger {
            radius_m: T::from_f64(radius_m),
            stiffness_pa_per_m: T::from_f64(stiffness_pa_per_m),
            friction_coefficient: T::from_f64(friction_coefficient),
        };
        Contact::new(&finger, T::from_f64(self.gap_m))
    }
}
