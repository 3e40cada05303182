//! Generated strokes.

use frixel_hil_sim::{Stroke, StrokeError};
use serde::{Deserialize, Serialize};

/// Kind of a generated stroke.
///
/// ```
/// use frixel_lab::GeneratedStroke;
///
/// assert_eq!(GeneratedStroke::named("human-rough"), Some(GeneratedStroke::HumanRough));
/// assert_eq!(GeneratedStroke::named("stroke.csv"), None);
/// let sweep = GeneratedStroke::Sweep.stroke([0.12, 0.08], 3.0, None, 1)?;
/// assert_eq!(sweep.duration_s(), 3.0);
/// # Ok::<(), frixel_hil_sim::StrokeError>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum GeneratedStroke {
    /// Touches of a person, with the accelerations of recorded ones after smoothing.
    #[default]
    Human,
    /// As [`Self::Human`], with the accelerations before smoothing.
    HumanRough,
    /// An even sweep over the screen.
    Sweep,
}

impl GeneratedStroke {
    const ALL: [Self; 3] = [Self::Human, Self::HumanRough, Self::Sweep];

    /// Its name in options, plans and results.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Human => "human",
            Self::HumanRough => "human-rough",
            Self::Sweep => "sweep",
        }
    }

    /// The names of all kinds.
    pub fn names() -> impl Iterator<Item = &'static str> {
        Self::ALL.into_iter().map(Self::name)
    }

    /// The kind with this name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|stroke| stroke.name() == name)
    }

    /// Whether the stroke depends on a seed, and has a median speed.
    pub(crate) const fn is_of_people(self) -> bool {
        matches!(self, Self::Human | Self::HumanRough)
    }

    /// A stroke over a screen of this width and height, in m, for `seconds`. The median speed and the seed are those of
    /// a person; without a speed, each person has their own.
    pub fn stroke(
        self,
        [width_m, height_m]: [f64; 2],
        seconds: f64,
        median_speed_m_per_s: Option<f64>,
        seed: u64,
    ) -> Result<Stroke, StrokeError> {
        match self {
            Self::Human => Stroke::human(width_m, height_m, seconds, median_speed_m_per_s, seed),
            Self::HumanRough => Stroke::human_rough(width_m, height_m, seconds, median_speed_m_per_s, seed),
            Self::Sweep => Stroke::sweep(width_m, height_m, seconds),
        }
    }
}
