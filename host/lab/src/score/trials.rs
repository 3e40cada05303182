//! The trials of one finger: its strokes, each as often as it is repeated.

use std::ops::RangeInclusive;
use std::sync::Arc;

use frixel_hil_sim::{HUMAN_STROKE_MAX_S, Person, Stroke, StrokeError};
use frixel_model::ParameterError;
use frixel_play::GoesOn;
use frixel_scene::{Program, Scene};
use thiserror::Error;

use super::{Trial, TrialFinger};
use crate::GeneratedStroke;
use crate::simulate::screen_m;

/// Most plays of a score.
const PLAYS_MAX: u64 = 100_000;
/// Longest time of all human strokes of a score together, s: they are in memory at the same time, 40 kB a second.
const STROKES_MAX_S: f64 = 36_000.0;

/// Path of a simulated finger.
#[derive(Clone, Debug)]
pub enum TrialStroke {
    /// Generated strokes; for human ones, a different stroke for each number.
    Generated(GeneratedStroke),
    /// This stroke.
    Own(Stroke),
}

impl TrialStroke {
    /// Whether it is human, with a different stroke for each number.
    pub fn is_of_people(&self) -> bool {
        matches!(self, Self::Generated(stroke) if stroke.is_of_people())
    }
}

impl From<GeneratedStroke> for TrialStroke {
    fn from(stroke: GeneratedStroke) -> Self {
        Self::Generated(stroke)
    }
}

/// Why there are no trials.
#[derive(Debug, Error)]
pub enum TrialsError {
    /// The screen is too small for a stroke.
    #[error("no stroke can be generated for this scene's screen: {0}")]
    Stroke(#[from] StrokeError),
    /// The contact model refuses a person on this screen.
    #[error("the contact model refuses the finger of a person: {0}")]
    Finger(#[from] ParameterError),
    /// A file or a sweep has its own speed.
    #[error("only human strokes have a median speed: leave it out, or choose the stroke `human` or `human-rough`")]
    SpeedOfPeople,
    /// They would not end.
    #[error(
        "people x strokes x seeds are {plays} plays, and at most {PLAYS_MAX} are scored: give fewer, or split the work \
         with a sweep"
    )]
    TooMany {
        /// Number of plays.
        plays: u64,
    },
    /// Their strokes do not fit into memory.
    #[error(
        "people x strokes x seconds are {seconds} s of strokes, and {STROKES_MAX_S} s fit into memory: give fewer or \
         shorter ones, or split the work with a sweep"
    )]
    TooLong {
        /// Duration of all strokes together, s.
        seconds: f64,
    },
}

/// The strokes of a finger.
#[derive(Clone, Debug)]
pub struct TrialPlan {
    /// Path of the finger.
    pub stroke: TrialStroke,
    /// Number of human strokes; there is one of every other kind.
    pub strokes: u64,
    /// Repetitions of each stroke.
    pub seeds: u64,
    /// Duration of a stroke that is generated, s.
    pub seconds: f64,
    /// Median speed of the strokes of people, m/s; without it, each person has their own.
    pub median_speed_m_per_s: Option<f64>,
}

impl TrialPlan {
    /// Default number of strokes.
    pub const STROKES: u64 = 4;
    /// Default number of repetitions of each stroke.
    pub const SEEDS: u64 = 2;
    /// Default duration of a generated stroke, s.
    pub const SECONDS: f64 = 3.0;
    /// Allowed durations of a generated stroke in a sweep, s. A shorter stroke has no fidelity.
    pub const SWEEP_SECONDS: RangeInclusive<f64> = 0.25..=HUMAN_STROKE_MAX_S;
    /// Largest number of people, strokes and repetitions of a score.
    pub const COUNT_MAX: u64 = 1000;
    /// Median speeds of strokes of people, mm/s.
    pub const MEDIAN_SPEEDS_MM_PER_S: RangeInclusive<f64> = 1.0..=1000.0;

    /// Trials of the first `people` of an assumed population, whose fingers the board does not know.
    ///
    /// Without a number, trials of the finger of `program`, compiled from `scene`. Refuses more plays than end, and
    /// longer strokes than fit into memory. When `goes_on` breaks, returns the trials so far.
    pub fn of_people(
        &self,
        people: Option<u64>,
        scene: &Scene,
        program: &Program,
        goes_on: GoesOn<'_>,
    ) -> Result<Vec<Trial>, TrialsError> {
        self.check(people.unwrap_or(1))?;
        let Some(people) = people else { return Ok(self.trials(program, None, goes_on)?) };
        let coating_gap_m = scene.screen().coating_gap_m();
        let of_person = |person| {
            let finger = TrialFinger::of_person(person, coating_gap_m)?;
            Ok(self.trials(program, Some(finger), goes_on)?)
        };
        let trials = (1..=people).take_while(|_| goes_on().is_continue()).map(of_person);
        Ok(trials.collect::<Result<Vec<_>, TrialsError>>()?.into_iter().flatten().collect())
    }

    fn check(&self, people: u64) -> Result<(), TrialsError> {
        let is_of_people = self.stroke.is_of_people();
        if !is_of_people && self.median_speed_m_per_s.is_some() {
            return Err(TrialsError::SpeedOfPeople);
        }
        let strokes = people.saturating_mul(if is_of_people { self.strokes } else { 1 });
        let (plays, seconds) = (strokes.saturating_mul(self.seeds), strokes as f64 * self.seconds);
        if plays > PLAYS_MAX {
            return Err(TrialsError::TooMany { plays });
        }
        if is_of_people && seconds > STROKES_MAX_S {
            return Err(TrialsError::TooLong { seconds });
        }
        Ok(())
    }

    /// The trials of a finger, by default the scene's. Each person has their own strokes, and each play its own world
    /// seed. `goes_on` is as for [`Self::of_people`].
    pub fn trials(
        &self,
        program: &Program,
        finger: Option<TrialFinger>,
        goes_on: GoesOn<'_>,
    ) -> Result<Vec<Trial>, StrokeError> {
        let first_stroke = finger.map_or(1, |finger| 1 + (finger.person - 1) * self.strokes);
        let strokes = match &self.stroke {
            TrialStroke::Generated(stroke) => self.generated(*stroke, screen_m(program), first_stroke, goes_on)?,
            TrialStroke::Own(stroke) => vec![("file".to_owned(), stroke.clone())],
        };
        let trials = (first_stroke..).zip(strokes).flat_map(|(number, (stroke_name, stroke))| {
            let first_seed = 1 + (number - 1) * self.seeds;
            let stroke = Arc::new(stroke);
            (first_seed..first_seed + self.seeds).map(move |seed| Trial {
                stroke_name: stroke_name.clone(),
                stroke: Arc::clone(&stroke),
                seed,
                finger,
            })
        });
        Ok(trials.collect())
    }

    /// The strokes with their names, from the number `first`.
    fn generated(
        &self,
        stroke: GeneratedStroke,
        screen_m: [f64; 2],
        first: u64,
        goes_on: GoesOn<'_>,
    ) -> Result<Vec<(String, Stroke)>, StrokeError> {
        let made = |number| stroke.stroke(screen_m, self.seconds, self.median_speed_m_per_s, number);
        if !stroke.is_of_people() {
            return Ok(vec![(stroke.name().to_owned(), made(first)?)]);
        }
        let numbers = (first..first + self.strokes).take_while(|_| goes_on().is_continue());
        numbers.map(|number| Ok((format!("{} {number}", stroke.name()), made(number)?))).collect()
    }
}

impl TrialFinger {
    /// The finger of a person, from 1, on a screen whose coating has this effective gap.
    pub fn of_person(person: u64, coating_gap_m: f64) -> Result<Self, ParameterError> {
        Ok(Self { person, finger: Person::drawn(person).own_finger(coating_gap_m)? })
    }
}
