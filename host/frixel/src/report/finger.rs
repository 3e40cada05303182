//! The finger whose run times are measured: the scene's finger on its screen, or the example finger if the scene's has
//! no contact model.

use frixel_model::{Contact, Finger, ParameterError, Real};
use frixel_scene::{Elasticity, FingerProfile, Screen};

use super::Subject;

/// A finger with a contact model.
pub(super) struct DrawnFinger {
    pub(super) finger: Finger<f64>,
    /// Effective gap of coating and skin, in metres.
    pub(super) gap_m: f64,
    /// Normal load, in newtons.
    pub(super) load_n: f64,
    /// Its parameters, and the reason if it is not the scene's finger.
    pub(super) words: String,
}

impl DrawnFinger {
    /// The finger of a report's scene. A soft finger has the Winkler-Fuss stiffness of its load and the scene's highest
    /// voltage.
    pub(super) fn of(subject: &Subject) -> Self {
        let (profile, screen) = (subject.scene.finger(), subject.scene.screen());
        let stiffness_pa_per_m = match (&profile.elasticity, &subject.program) {
            (Elasticity::WinklerFuss { stiffness_pa_per_m }, _) => *stiffness_pa_per_m,
            (Elasticity::Soft { .. }, Ok(program)) => program.header.stiffness_pa_per_m.into(),
            _ => {
                let stiffness_pa_per_m = Finger::<f64>::EXAMPLE.stiffness_pa_per_m;
                let example = Self::new(&FingerProfile::example(), &Screen::example(), stiffness_pa_per_m);
                let words = format!("the example finger, since the scene's has no contact model: {}", example.words);
                return Self { words, ..example };
            }
        };
        let drawn = Self::new(profile, screen, stiffness_pa_per_m);
        Self { words: format!("the scene's, {}: {}", profile.evidence.origin().word(), drawn.words), ..drawn }
    }

    fn new(profile: &FingerProfile, screen: &Screen, stiffness_pa_per_m: f64) -> Self {
        let FingerProfile { radius_mm, friction_coefficient, normal_load_n: load_n, skin_gap_um, .. } = *profile;
        let gap_um = screen.coating_gap_um() + skin_gap_um;
        let words = format!(
            "R = {radius_mm} mm, k = {stiffness_pa_per_m:.3e} Pa/m, µ = {friction_coefficient}, g = {gap_um:.3} µm, \
             F_N = {load_n} N"
        );
        let finger = Finger { radius_m: 1e-3 * radius_mm, stiffness_pa_per_m, friction_coefficient };
        Self { finger, gap_m: 1e-6 * gap_um, load_n, words }
    }

    /// The contact of this finger with another stiffness, in either precision.
    pub(super) fn contact<T: Real>(&self, stiffness_pa_per_m: f64) -> Result<Contact<T>, ParameterError> {
        let Finger { radius_m, friction_coefficient, .. } = self.finger;
        let finger = Finger {
            radius_m: T::from_f64(radius_m),
            stiffness_pa_per_m: T::from_f64(stiffness_pa_per_m),
            friction_coefficient: T::from_f64(friction_coefficient),
        };
        Contact::new(&finger, T::from_f64(self.gap_m))
    }
}
