//! The finger that figures are drawn for: that of the scene, on its screen, or the example finger where that of the
//! scene has no contact model.

use frixel_lab::calibration::example_finger;
use frixel_model::{Contact, Finger, ParameterError, Real};
use frixel_scene::{FingerProfile, Program, Screen};

/// Voltage at which the friction of the example finger is stated, in volts rms.
const EXAMPLE_V_RMS: f64 = 150.0;

/// A finger with a contact model.
pub(super) struct DrawnFinger {
    pub(super) finger: Finger<f64>,
    /// Effective gap of coating and skin, in metres.
    pub(super) gap_m: f64,
    /// Normal load, in newtons.
    pub(super) load_n: f64,
    /// Last sentences of the caption of a figure about this finger.
    pub(super) caption: String,
    /// Why it is not the finger of the scene.
    pub(super) instead: Option<String>,
}

impl DrawnFinger {
    /// The finger that a program is compiled for, by the board's numbers; the example finger in place of one without a
    /// contact model.
    pub(super) fn of(program: &Program) -> Result<Self, ParameterError> {
        if program.header.law.is_some() {
            return Self::instead_of(&program.finger.title);
        }
        let header = &program.header;
        let finger = Finger {
            radius_m: header.finger_radius_m.into(),
            stiffness_pa_per_m: header.stiffness_pa_per_m.into(),
            friction_coefficient: header.friction_coefficient.into(),
        };
        let name = format!("{}, {}", program.finger.title, program.finger.origin.word());
        let (gap_m, load_n) = (f64::from(header.effective_gap_m), f64::from(header.normal_load_n));
        Self::named(&name, finger, gap_m, load_n, program.reach.voltage_max_v_rms)
    }

    /// The example finger on the example screen.
    fn instead_of(title: &str) -> Result<Self, ParameterError> {
        let example = FingerProfile::example();
        let gap_m = 1e-6 * (example.skin_gap_um + Screen::example().coating_gap_um());
        let drawn =
            Self::named("the example finger, assumed", example_finger(), gap_m, example.normal_load_n, EXAMPLE_V_RMS)?;
        let instead = format!("{title} is empirical and has no contact model: these are of the example finger.");
        Ok(Self {
            caption: format!("{} {title} is empirical and has no contact model.", drawn.caption),
            instead: Some(instead),
            ..drawn
        })
    }

    fn named(
        name: &str,
        finger: Finger<f64>,
        gap_m: f64,
        load_n: f64,
        voltage_v_rms: f64,
    ) -> Result<Self, ParameterError> {
        let electric_n = Contact::new(&finger, gap_m)?.under_load(load_n)?.electric_friction_n(voltage_v_rms);
        let caption = format!(
            "Drawn for {name}: R = {:.3} mm, k = {:.3} MPa/m, µ = {:.3}, on an effective gap of {:.3} µm ({:.0} mN of \
             friction without voltage under {load_n:.3} N, and {:.0} mN more at {voltage_v_rms:.0} V rms).",
            1e3 * finger.radius_m,
            1e-6 * finger.stiffness_pa_per_m,
            finger.friction_coefficient,
            1e6 * gap_m,
            1e3 * finger.friction_coefficient * load_n,
            1e3 * electric_n,
        );
        Ok(Self { finger, gap_m, load_n, caption, instead: None })
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
