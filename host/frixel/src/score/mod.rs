//! Scores a scene: how faithfully simulated fingers feel it, over strokes and seeds.
//!
//! The input is a program, a simulated board with its world, and strokes with their seeds. The output is the
//! [`Fidelity`] of each play, and of each of its numbers the mean, the interval, and what a person notices.

mod metric;
mod output;
mod play;

use frixel_hil_sim::{RigConfig, Stroke};
use frixel_scene::Program;
use frixel_scene::fidelity::Fidelity;
use serde::Serialize;

use crate::player::PlayError;
use metric::METRICS;
pub use metric::MetricScore;
pub use output::write_score_svg;

/// One play to score.
#[derive(Clone, Debug)]
pub struct Trial {
    /// Name of the stroke.
    pub stroke_name: String,
    /// Path of the finger.
    pub stroke: Stroke,
    /// Seed of all that is random in the world.
    pub seed: u64,
}

/// The score of one play.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TrialScore {
    /// Name of the stroke.
    pub stroke: String,
    /// Seed of all that was random.
    pub seed: u64,
    /// How faithfully friction was felt; absent if the finger was down for less than a quarter of a second.
    pub fidelity: Option<Fidelity>,
}

/// The score of a scene.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Score {
    /// Each number of [`Fidelity`] over all plays.
    pub metrics: Vec<MetricScore>,
    /// The plays.
    pub plays: Vec<TrialScore>,
}

impl Score {
    /// Plays a program on a simulated board once for each trial, and scores it.
    pub fn of(program: &Program, rig: &RigConfig, trials: &[Trial]) -> Result<Self, PlayError> {
        let play = |trial: &Trial| {
            let fidelity = Fidelity::of(&play::samples(program, rig, trial)?);
            Ok(TrialScore { stroke: trial.stroke_name.clone(), seed: trial.seed, fidelity })
        };
        let plays: Vec<TrialScore> = trials.iter().map(play).collect::<Result<_, PlayError>>()?;
        let scored: Vec<Fidelity> = plays.iter().filter_map(|play| play.fidelity).collect();
        Ok(Self { metrics: METRICS.iter().filter_map(|metric| metric.score(&scored)).collect(), plays })
    }
}
