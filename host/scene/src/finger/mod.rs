//! Finger profiles: the parameters of a finger on a screen, and their evidence.
//!
//! A profile is a TOML file of its own, or the table `[finger]` of a scene. Both have the same fields.

mod bundled;
mod read;
#[cfg(test)]
mod tests;
mod write;

use frixel_layers::{FingerLaw, LawPoint};

use super::compile_error::CompileError;
use super::fields::read_text;
use super::file_kind::FileKind;
use super::profile::Profile;

pub(super) use read::read;

/// The parameters of a finger on a screen.
///
/// ```
/// use frixel_scene::{Evidence, FingerProfile, Profile};
///
/// let dry = FingerProfile::bundled("dry").expect("it is bundled");
/// assert_eq!(dry.evidence, Evidence::Assumed);
/// assert_eq!(FingerProfile::parse(dry.to_toml(), "dry.toml").as_ref(), Ok(&dry));
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct FingerProfile {
    /// Friction coefficient on the screen without voltage, 0.001 to 10.
    pub friction_coefficient: f64,
    /// Normal load for which scenes are compiled, 0 to 50 N.
    pub normal_load_n: f64,
    /// Radius of curvature at the contact, 0.1 to 100 mm; 0 for an empirical law.
    pub radius_mm: f64,
    /// Elastic response to a load.
    pub elasticity: Elasticity,
    /// Stratum corneum and air between coating and living tissue, as an effective gap (thickness over permittivity), 0
    /// to 10,000 um. It is added to the gap of the screen's coating. 0 for an empirical law.
    pub skin_gap_um: f64,
    /// Evidence for the parameters.
    pub evidence: Evidence,
}

/// Elastic response of a finger to a load.
#[derive(Clone, Debug, PartialEq)]
pub enum Elasticity {
    /// Linear springs, Eq. (10).
    WinklerFuss {
        /// Stiffness `k`, 1e3 to 1e14 Pa/m.
        stiffness_pa_per_m: f64,
    },
    /// A material whose strain follows a power of the stress, Eqs. (22) to (29).
    Soft {
        /// Modulus `E`, 1 to 1e12 Pa.
        modulus_pa: f64,
        /// Stress exponent, 0.02 to 1.
        stress_exponent: f64,
        /// Dimensionless constant `B` of Eq. (24), 0.001 to 1000.
        shape_constant: f64,
    },
    /// Unknown: electric friction was measured as a function of the voltage, on one screen, under one load. The
    /// profile's evidence is [`Evidence::Empirical`].
    Empirical(MeasuredLaw),
}

/// Measured electric friction as a function of the voltage.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredLaw {
    /// Power of the voltage with which friction grows below the first point, 0.5 to 12.
    pub exponent: f64,
    /// 1 to 16 points: rms voltage in volts and electric friction in newtons, both ascending.
    pub points: Vec<(f64, f64)>,
    /// 95 % interval of the friction of each point, in newtons.
    pub intervals_n: Vec<(f64, f64)>,
}

impl MeasuredLaw {
    /// Largest rms voltage of the measurement, in volts, at which the law ends.
    pub fn voltage_max_v_rms(&self) -> f64 {
        self.points.last().map_or(0.0, |(voltage_v_rms, _)| *voltage_v_rms)
    }

    /// The law in `f32`, as in a compiled scene; `None` if it has no points, or too many.
    pub(crate) fn of_scene(&self) -> Option<FingerLaw> {
        let points: Vec<LawPoint> = self
            .points
            .iter()
            .map(|&(voltage_v_rms, electric_friction_n)| LawPoint {
                voltage_v_rms: voltage_v_rms as f32,
                electric_friction_n: electric_friction_n as f32,
            })
            .collect();
        FingerLaw::new(self.exponent as f32, &points)
    }
}

/// Evidence for a profile. Friction computed from it is called *assumed* unless it was measured.
#[derive(Clone, Debug, PartialEq)]
pub enum Evidence {
    /// Plausible values without a measurement.
    Assumed,
    /// A person reported what they felt: a level relative to their threshold is known, but no force.
    Perceptual {
        /// Where, when and how.
        experiment: Experiment,
        /// Rms voltage at the detection threshold, in volts.
        threshold_v_rms: f64,
        /// 95 % interval of the threshold, in volts.
        threshold_interval_v_rms: [f64; 2],
    },
    /// A force sensor measured friction.
    Measured {
        /// Where, when and how.
        experiment: Experiment,
        /// 95 % interval of the friction coefficient.
        friction_coefficient_interval: [f64; 2],
        /// 95 % interval of the electric friction at `voltage_max_v_rms` under the profile's normal load, in newtons.
        electric_friction_interval_n: [f64; 2],
        /// Largest rms voltage of the measurement, in volts.
        voltage_max_v_rms: f64,
        /// Least and largest normal load of the measurement, in newtons.
        normal_load_range_n: [f64; 2],
    },
    /// A force sensor measured friction that the contact model does not describe: the profile has a [`MeasuredLaw`].
    Empirical {
        /// Where, when and how.
        experiment: Experiment,
    },
}

/// An experiment with a finger.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Experiment {
    /// Day, `YYYY-MM-DD`.
    pub date: String,
    /// Method, in a few words.
    pub method: String,
    /// Name of the screen. On another screen, the profile counts as assumed.
    pub screen: String,
}

/// Kind of evidence for a profile, without its numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Origin {
    /// Not measured.
    Assumed,
    /// A person reported what they felt.
    Perceptual,
    /// A force sensor measured it.
    Measured,
    /// A force sensor measured friction that the contact model does not describe.
    Empirical,
}

impl Origin {
    /// Each origin with its value of `origin` in a profile.
    pub(crate) const WORDS: [(&str, Self); 4] = [
        ("assumed", Self::Assumed),
        ("perceptual", Self::Perceptual),
        ("measured", Self::Measured),
        ("empirical", Self::Empirical),
    ];

    /// The value of `origin` in a profile.
    pub fn word(self) -> &'static str {
        Self::WORDS.into_iter().find(|(_, origin)| *origin == self).map_or("", |(word, _)| word)
    }

    /// [`Self::newtons_suffix`] for a value of `origin`; for other words, that of an assumed profile.
    pub fn newtons_suffix_of(word: &str) -> &'static str {
        Self::WORDS
            .into_iter()
            .find(|(other, _)| *other == word)
            .map_or(Self::Assumed, |(_, origin)| origin)
            .newtons_suffix()
    }

    /// Suffix for values in newtons, with a leading comma and space; empty for a measured finger. A perceptual profile
    /// gives no forces, so its newtons are assumed too.
    pub const fn newtons_suffix(self) -> &'static str {
        match self {
            Self::Assumed | Self::Perceptual => ", assumed",
            Self::Measured => "",
            Self::Empirical => ", empirical",
        }
    }
}

impl Evidence {
    /// The kind of evidence.
    pub fn origin(&self) -> Origin {
        match self {
            Self::Assumed => Origin::Assumed,
            Self::Perceptual { .. } => Origin::Perceptual,
            Self::Measured { .. } => Origin::Measured,
            Self::Empirical { .. } => Origin::Empirical,
        }
    }

    /// The experiment, if there was one.
    pub fn experiment(&self) -> Option<&Experiment> {
        match self {
            Self::Assumed => None,
            Self::Perceptual { experiment, .. }
            | Self::Measured { experiment, .. }
            | Self::Empirical { experiment } => Some(experiment),
        }
    }
}

impl FingerProfile {
    /// The text of the profile as a file of its own, which [`Self::parse`] reads back to an equal profile.
    pub fn to_toml(&self) -> String {
        write::text(self)
    }

    /// The default finger of a scene.
    pub fn example() -> Self {
        bundled::EXAMPLE
    }
}

impl Profile for FingerProfile {
    const KIND: FileKind = FileKind::Finger;

    fn bundled_names() -> Vec<&'static str> {
        bundled::TEXTS.iter().map(|(name, _)| *name).collect()
    }

    fn bundled(name: &str) -> Option<Self> {
        let (_, text) = bundled::TEXTS.iter().find(|(bundled, _)| *bundled == name)?;
        Self::parse(text, name).ok()
    }

    fn parse(text: impl AsRef<[u8]>, name: &str) -> Result<Self, CompileError> {
        read_text(Self::KIND, text.as_ref(), name, read)
    }
}
