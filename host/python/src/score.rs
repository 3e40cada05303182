//! Scores: how faithfully simulated fingers feel a scene.

use frixel_hil_sim::{Board, WorldOptions};
use frixel_lab::GeneratedStroke;
use frixel_lab::score::{Score, TrialPlan, TrialStroke, TrialsError};
use frixel_scene::compile;
use pyo3::prelude::*;
use rayon::ThreadPoolBuilder;

use super::error::{parameter_error, raised, scene_error};
use super::profile::ProfileText;
use super::scene::Scene;
use super::signals::interruptible;
use super::simulator::Stroke;

/// The path of the fingers.
#[derive(FromPyObject)]
pub(crate) enum ScoreStroke<'py> {
    /// The name of a generated stroke.
    Generated(String),
    /// The same stroke for every finger.
    Own(Stroke<'py>),
}

/// Settings of a score, an object of `python/frixel/scoring.py`.
#[derive(FromPyObject)]
pub(crate) struct ScoreSettings<'py> {
    stroke: ScoreStroke<'py>,
    people: Option<u64>,
    strokes: u64,
    seeds: u64,
    seconds: f64,
    median_speed_mm_per_s: Option<f64>,
    touch: Option<ProfileText>,
    ideal: bool,
    jobs: usize,
}

impl ScoreSettings<'_> {
    fn world(&self, py: Python<'_>) -> PyResult<WorldOptions> {
        let touch = self.touch.as_ref().map(|touch| touch.read(py)).transpose()?;
        Ok(WorldOptions { ideal: self.ideal, touch, ..WorldOptions::default() })
    }

    fn stroke(&self, py: Python<'_>, program: &frixel_scene::Program) -> PyResult<TrialStroke> {
        let stroke = match &self.stroke {
            ScoreStroke::Generated(name) => GeneratedStroke::named(name).map(TrialStroke::Generated),
            ScoreStroke::Own(stroke) => stroke.on_screen(py, program)?.map(TrialStroke::Own),
        };
        stroke.ok_or_else(|| parameter_error(py, "a stroke is \"human\", \"human-rough\", \"sweep\" or a Stroke"))
    }
}

/// Scores a scene. Returns the output of `frixel score --json`, the table that `frixel score` prints, and the texts of
/// `score.csv` and `score-layers.csv`.
#[pyfunction]
pub(crate) fn score_scene(
    py: Python<'_>,
    scene: &Scene,
    settings: ScoreSettings<'_>,
) -> PyResult<(String, String, String, String)> {
    let (world, board) = (settings.world(py)?, Board::SIMULATOR);
    let program = py.detach(|| compile(scene.parsed(), &board.limits, board.tick_hz));
    let program = program.map_err(|error| scene_error(py, &error))?;
    let plan = TrialPlan {
        stroke: settings.stroke(py, &program)?,
        strokes: settings.strokes,
        seeds: settings.seeds,
        seconds: settings.seconds,
        median_speed_m_per_s: settings.median_speed_mm_per_s.map(|speed_mm_per_s| 1e-3 * speed_mm_per_s),
    };
    let failed = |sentence: String| raised(py, "PlayError", (sentence,));
    let pool = ThreadPoolBuilder::new().num_threads(settings.jobs).build();
    let pool = pool.map_err(|error| failed(format!("the threads of `jobs` cannot start ({error}): give fewer")))?;
    let scored = interruptible(py, |goes_on| {
        let trials = plan.of_people(settings.people, scene.parsed(), &program, goes_on)?;
        Ok(pool.install(|| Score::of(&program, &world, &trials, goes_on)))
    })?;
    let scored = scored.map_err(|error: TrialsError| parameter_error(py, error))?;
    let score = scored.map_err(|error| failed(error.to_string()))?;
    Ok((score.to_json(), score.summary(false), score.to_csv(), score.layers_csv()))
}
