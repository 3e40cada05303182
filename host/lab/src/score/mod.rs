//! Scores a scene: how faithfully simulated fingers feel it, and what they notice of it, over strokes and seeds.
//!
//! The input is strokes with their seeds, and what the finger felt on each. The output is the [`Fidelity`] of each play,
//! of each of its numbers the mean, the interval, and what a person notices, and how many of the simulated fingers
//! notice each layer.

mod layers;
mod metric;
mod sentence;
mod text;

use frixel_felt::fidelity::{Fidelity, FidelitySample};
use frixel_felt::noticed::Noticing;
use frixel_hil_sim::{FingertipConfig, Stroke, TouchConfig, WorldConfig};
use frixel_model::LoadedContact;
use frixel_scene::{LayerTitle, Program, TouchSource};
use serde::Serialize;

use layers::Finger;
pub use layers::{BorderScore, LayerBorder, LayerScore, LevelScore, Verdicts};
use metric::METRICS;
pub use metric::{Goal, Human, MetricScore};

/// One play to score.
#[derive(Clone, Debug)]
pub struct Trial {
    /// Name of the stroke.
    pub stroke_name: String,
    /// Path of the finger.
    pub stroke: Stroke,
    /// Seed of all that is random in the world.
    pub seed: u64,
    /// The finger, if it is not the one that the scene is meant for.
    pub finger: Option<TrialFinger>,
}

/// A person's finger on the screen of a scene.
#[derive(Clone, Copy, Debug)]
pub struct TrialFinger {
    /// Number of the person.
    pub person: u64,
    /// Contact of the finger with the screen.
    pub contact: LoadedContact<f64>,
    /// What the finger does beside the contact model; absent in an ideal world.
    pub fingertip: Option<FingertipConfig>,
}

impl Trial {
    /// The world of this trial: `world` with the finger's skin.
    pub fn world(&self, world: WorldConfig) -> WorldConfig {
        let fingertip = self.finger.and_then(|finger| finger.fingertip).unwrap_or(world.fingertip);
        WorldConfig { fingertip, ..world }
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
    /// Seed of all that was random.
    pub seed: u64,
    /// How faithfully friction was felt; absent if the finger was down for less than a quarter of a second.
    pub fidelity: Option<Fidelity>,
}

/// The score of a scene.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Score {
    /// What the score is a verdict on: simulated fingers.
    pub simulated: String,
    /// Which layers the simulated fingers notice, and which levels of friction they tell apart: a sentence that names
    /// those that some fingers do not surely notice, and those of which the strokes say nothing.
    pub verdict: String,
    /// The touch source that was simulated.
    pub touch_source: TouchSource,
    /// Number of simulated fingers.
    pub simulated_fingers: usize,
    /// Each number of [`Fidelity`] over all plays.
    pub metrics: Vec<MetricScore>,
    /// The layers that a finger touched for long enough, while the board drove the scene, from bottom to top.
    pub layers: Vec<LayerScore>,
    /// The borders that a finger crossed.
    pub borders: Vec<BorderScore>,
    /// Levels of friction that are next to one another.
    pub levels: Vec<LevelScore>,
    /// The layers without a row.
    pub untouched_layers: Vec<LayerTitle>,
    /// The plays.
    pub plays: Vec<TrialScore>,
}

impl Score {
    /// Scores trials of a program with a touch source. `play` plays one, and returns what was felt and the reference for every quarter of a
    /// millisecond.
    pub fn of<E>(
        program: &Program,
        touch_source: &TouchConfig,
        trials: &[Trial],
        mut play: impl FnMut(&Trial) -> Result<Vec<FidelitySample>, E>,
    ) -> Result<Self, E> {
        let mut fingers: Vec<(Option<u64>, Noticing)> = Vec::new();
        let score =
            |trial: &Trial| {
                let person = trial.finger.map(|finger| finger.person);
                let samples = play(trial)?;
                let finger = fingers.iter().position(|(other, _)| *other == person).unwrap_or(fingers.len());
                if finger == fingers.len() {
                    fingers.push((person, Noticing::new(program)));
                }
                let mut fidelity = Fidelity::of(&samples);
                if let Some((_, noticing)) = fingers.get_mut(finger) {
                    noticing.add(&samples);
                    fidelity = fidelity.map(|fidelity| {
                        if noticing.changes_along(&samples) { fidelity } else { fidelity.without_ratios() }
                    });
                }
                Ok(TrialScore { person, stroke: trial.stroke_name.clone(), seed: trial.seed, fidelity })
            };
        let plays: Vec<TrialScore> = trials.iter().map(score).collect::<Result<_, E>>()?;
        let groups = independent(&plays);
        let fingers: Vec<Finger> = fingers.iter().map(|(_, noticing)| Finger::from(noticing)).collect();
        let layers = layers::layers(program, &fingers);
        let is_untouched = |title: &&LayerTitle| layers.iter().all(|layer| layer.layer != **title);
        let score = Self {
            simulated: String::new(),
            verdict: String::new(),
            touch_source: touch_source.into(),
            simulated_fingers: fingers.len(),
            metrics: METRICS.iter().filter_map(|metric| metric.score(&groups)).collect(),
            borders: layers::borders(program, &fingers),
            levels: layers::levels(program, &fingers),
            untouched_layers: program.titles.iter().filter(is_untouched).cloned().collect(),
            layers,
            plays,
        };
        Ok(Self { simulated: score.simulated_words(), verdict: score.sentence(), ..score })
    }
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
