//! Scores a scene: how faithfully simulated fingers feel it, and what they notice of it, over strokes and seeds.
//!
//! The input is strokes with their seeds, and the felt friction of each. The output is the [`Fidelity`] of each play;
//! the mean, the interval and the perception threshold of each of its numbers; and the number of simulated fingers that
//! notice each layer.

mod layers;
mod metric;
mod sentence;
mod text;
mod trials;

use std::sync::Arc;

use frixel_felt::fidelity::{Fidelity, FidelitySample};
use frixel_felt::judge::{Advice, Judgement, changes_along};
use frixel_hil_sim::{OwnFinger, RigConfig, Stroke, WorldOptions};
use frixel_play::{GoesOn, Simulation, SimulationError, judge, simulate};
use frixel_scene::{LayerTitle, Program, TouchSource};
use rayon::prelude::*;
use serde::Serialize;

pub use layers::{LayerBorder, LayerScore, LevelScore, Verdicts};
use metric::METRICS;
pub use metric::{GoalBound, Human, MetricScore};
#[cfg(not(target_arch = "wasm32"))]
pub(crate) use metric::{interval, metric_keys};
#[cfg(not(target_arch = "wasm32"))]
pub(crate) use text::quoted;
pub use trials::{TrialPlan, TrialStroke, TrialsError};

/// Largest number of threads that play in parallel. Each takes memory for boards and samples, and more of them than a
/// machine has processors are not faster.
pub const JOBS_MAX: u64 = 1000;
/// Number of plays per thread whose samples are in memory; those of all plays would not fit.
const PLAYS_PER_THREAD: usize = 4;

/// One play to score.
#[derive(Clone, Debug)]
pub struct Trial {
    /// Name of the stroke.
    pub stroke_name: String,
    /// Path of the finger, which trials with other seeds share.
    pub stroke: Arc<Stroke>,
    /// Seed of the world's random numbers.
    pub seed: u64,
    /// The finger, if it is not the one that the scene is meant for.
    pub finger: Option<TrialFinger>,
}

/// A person's finger on the screen of a scene.
#[derive(Clone, Copy, Debug)]
pub struct TrialFinger {
    /// Number of the person.
    pub person: u64,
    /// The person's finger.
    pub finger: OwnFinger,
}

impl Trial {
    /// Plays the trial on the simulated board in a world, and returns what the finger felt and the reference: a sample
    /// for every quarter of a millisecond.
    pub fn play(
        &self,
        program: &Program,
        world: &WorldOptions,
        goes_on: GoesOn<'_>,
    ) -> Result<Vec<FidelitySample>, SimulationError> {
        let rig = RigConfig::default().with(&world_of(world, self.finger));
        let simulation = Simulation::of_stroke(rig, Stroke::clone(&self.stroke), self.seed);
        Ok(simulate(program, &simulation, None, goes_on)?.samples())
    }
}

/// The score of one play.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TrialScore {
    /// Number of the simulated person whose finger it was; absent for the finger that the scene is meant for.
    #[serde(rename = "simulated_person")]
    pub person: Option<u64>,
    /// Name of the stroke.
    pub stroke: String,
    /// Random seed of the play.
    pub seed: u64,
    /// How faithfully friction was felt; absent if the finger was down for less than a quarter of a second.
    pub fidelity: Option<Fidelity>,
}

/// The score of a scene.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Score {
    /// The subject of the verdict: simulated fingers.
    pub simulated: String,
    /// Sentence on the layers that the simulated fingers notice, and on the levels of friction that they tell apart. It
    /// names the layers that some fingers may miss or that no stroke reached.
    pub verdict: String,
    /// The touch source that was simulated.
    pub touch_source: TouchSource,
    /// Number of simulated fingers.
    pub simulated_fingers: usize,
    /// Each number of [`Fidelity`] over all plays.
    pub metrics: Vec<MetricScore>,
    /// The layers that are visible somewhere, from bottom to top, each as the judge's strokes across it are felt.
    pub layers: Vec<LayerScore>,
    /// Levels of friction that are next to one another.
    pub levels: Vec<LevelScore>,
    /// The layers that are visible nowhere.
    pub untouched_layers: Vec<LayerTitle>,
    /// The plays.
    pub plays: Vec<TrialScore>,
}

impl Score {
    /// Plays trials of a program on the simulated board in a world, and scores them. In these plays, layers that start
    /// off are on.
    ///
    /// Trials are played side by side on the threads of the caller's rayon pool. The score is the same for any number
    /// of threads. When `goes_on` breaks, it fails with [`SimulationError::Interrupted`].
    pub fn of(
        program: &Program,
        world: &WorldOptions,
        trials: &[Trial],
        goes_on: GoesOn<'_>,
    ) -> Result<Self, SimulationError> {
        let fingers = judgements(program, world, trials, goes_on)?;
        let program = &switched_on(program);
        let mut plays: Vec<TrialScore> = Vec::with_capacity(trials.len());
        for trials in trials.chunks(PLAYS_PER_THREAD * rayon::current_num_threads()) {
            let felt = |trial: &Trial| {
                trial.play(program, world, goes_on).map(|samples| {
                    let fidelity = Fidelity::of(&samples);
                    (samples, fidelity)
                })
            };
            let felt: Vec<Result<_, SimulationError>> = trials.par_iter().map(felt).collect();
            for (trial, felt) in trials.iter().zip(felt) {
                let (samples, fidelity) = felt?;
                let person = trial.finger.map(|finger| finger.person);
                let changes = changes_along(program, &samples);
                let fidelity = fidelity.map(|fidelity| if changes { fidelity } else { fidelity.without_ratios() });
                let stroke = trial.stroke_name.clone();
                plays.push(TrialScore { person, stroke, seed: trial.seed, fidelity });
            }
        }
        if goes_on().is_break() {
            return Err(SimulationError::Interrupted);
        }
        let groups = independent(&plays);
        let layers = layers::layers(program, &fingers);
        let is_untouched = |title: &&LayerTitle| layers.iter().all(|layer| layer.layer != **title);
        let score = Self {
            simulated: String::new(),
            verdict: String::new(),
            touch_source: (&RigConfig::default().with(world).world.touch).into(),
            simulated_fingers: fingers.len(),
            metrics: METRICS.iter().filter_map(|metric| metric.score(&groups)).collect(),
            levels: layers::levels(program, &fingers),
            untouched_layers: program.titles.iter().filter(is_untouched).cloned().collect(),
            layers,
            plays,
        };
        Ok(Self { simulated: score.simulated_words(), verdict: score.sentence(), ..score })
    }
}

/// A program with all layers on.
fn switched_on(program: &Program) -> Program {
    let mut program = program.clone();
    program.start.iter_mut().for_each(|setting| setting.on = true);
    program
}

/// A world with the finger of a trial.
fn world_of(world: &WorldOptions, finger: Option<TrialFinger>) -> WorldOptions {
    WorldOptions { finger: finger.map(|finger| finger.finger).or(world.finger), ..*world }
}

/// The judgement of each finger of some trials on a program.
fn judgements(
    program: &Program,
    world: &WorldOptions,
    trials: &[Trial],
    goes_on: GoesOn<'_>,
) -> Result<Vec<Judgement>, SimulationError> {
    let mut fingers: Vec<Option<TrialFinger>> = Vec::new();
    let person = |finger: &Option<TrialFinger>| finger.map(|finger| finger.person);
    for trial in trials {
        if fingers.iter().all(|other| person(other) != person(&trial.finger)) {
            fingers.push(trial.finger);
        }
    }
    let judged = |finger: &Option<TrialFinger>| {
        judge(program, &RigConfig::default(), &world_of(world, *finger), Advice::Omitted, goes_on)
    };
    fingers.par_iter().map(judged).collect()
}

/// The plays in groups that are independent of one another: those of a person, or else those of a stroke. Seeds of the
/// same stroke, and strokes of the same finger, resemble one another.
fn independent(plays: &[TrialScore]) -> Vec<Vec<Fidelity>> {
    let mut groups: Vec<(Option<u64>, Option<&str>, Vec<Fidelity>)> = Vec::new();
    for play in plays {
        let Some(fidelity) = play.fidelity else { continue };
        let stroke = if play.person.is_some() { None } else { Some(play.stroke.as_str()) };
        match groups.iter_mut().find(|(person, other, _)| (*person, *other) == (play.person, stroke)) {
            Some((.., group)) => group.push(fidelity),
            None => groups.push((play.person, stroke, vec![fidelity])),
        }
    }
    groups.into_iter().map(|(.., group)| group).collect()
}
