//! One simulated finger on one scene: the input of its plays, and their result.

use std::collections::BTreeMap;

use frixel_felt::judge::Verdict;
use frixel_hil_sim::{Board, Person, StrokeError, WorldOptions};
use frixel_model::ParameterError as ContactError;
use frixel_play::{GoesOn, SimulationError};
use frixel_scene::{CompileError, Diagnostic, NamedProfile, ProfileError, Program, Scene, SharedFiles, compile};
use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::parameter::{Value, has_at, nearest_field};
use crate::GeneratedStroke;
use crate::score::{Score, TrialFinger, TrialPlan};

/// Input of the plays of one simulated finger.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Cell {
    /// Hash of its content: equal for equal cells, and different for different ones.
    pub key: String,
    /// Version of frixel. Results may differ between versions.
    pub version: String,
    /// Name of the scene.
    pub scene: String,
    /// The values that the plan sets, by the paths of their fields.
    pub parameters: BTreeMap<String, Value>,
    /// Text of the scene, with these values.
    pub text: String,
    /// The bytes of the files that the scene names, by these names.
    pub files: SharedFiles,
    /// The screen; absent for the scene's own.
    pub screen: Option<NamedProfile>,
    /// The touch source.
    pub touch: NamedProfile,
    /// Number of the simulated person, from 1.
    pub person: u64,
    /// Kind of the strokes.
    pub stroke: GeneratedStroke,
    /// Number of strokes.
    pub strokes: u64,
    /// Repetitions of each stroke.
    pub seeds: u64,
    /// Duration of a stroke, s.
    pub seconds: f64,
    /// Median speed of the strokes, mm/s; absent for the person's own.
    pub median_speed_mm_per_s: Option<f64>,
    /// Whether the world has no noise, load changes, losses and offsets.
    pub ideal: bool,
}

/// Result of one finger on a layer.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LayerResult {
    /// Number and name of the layer.
    pub layer: String,
    /// Number of the layer's table in the scene: copies of a layer have the same one.
    pub table: usize,
    /// Whether it notices the layer: `felt`, `maybe`, `not_felt` or `unknown`.
    pub verdict: Verdict,
    /// Felt contrast within the layer, in Weber steps.
    pub contrast_weber_steps: f64,
}

/// Result of one finger.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CellResult {
    /// Key of the cell.
    pub cell: String,
    /// Name of the scene.
    pub scene: String,
    /// The values that the plan set.
    pub parameters: BTreeMap<String, Value>,
    /// Name of the screen; absent for the scene's own.
    pub screen: Option<String>,
    /// Name of the touch source.
    pub touch: String,
    /// Number of the simulated person.
    pub person: u64,
    /// Moisture of the person's skin, in standard deviations from the middle of the population.
    pub moisture: f64,
    /// Highest rms voltage of the scene, V.
    pub voltage_v_rms: f64,
    /// The layers that the finger touched for long enough, from bottom to top.
    pub layers: Vec<LayerResult>,
    /// Means over the finger's plays, by the names of the columns of `score.csv`. A number that exists in no play is
    /// absent.
    pub means: BTreeMap<String, f64>,
}

/// Why a cell cannot be played.
#[derive(Debug, Error)]
pub enum CellError {
    /// The cell is of another version.
    #[error(
        "this cell is from frixel {found}, and this is {}: make the cells again from their plan",
        env!("CARGO_PKG_VERSION")
    )]
    OtherVersion {
        /// Version of the cell.
        found: String,
    },
    /// The scene has mistakes.
    #[error(transparent)]
    Compile(#[from] CompileError),
    /// A parameter is not a field of the scene, but resembles one.
    #[error("{source}; did you mean `{nearest}`?")]
    Misspelt {
        /// The field that the scene has.
        nearest: String,
        /// The mistakes of the scene with the parameter.
        source: CompileError,
    },
    /// The screen or the touch source is not bundled, or has mistakes.
    #[error(transparent)]
    Profile(#[from] ProfileError),
    /// The contact model refuses the person on this screen.
    #[error("the contact model refuses the finger of person {person}: {source}")]
    Finger {
        /// Number of the person.
        person: u64,
        /// The reason.
        source: ContactError,
    },
    /// The screen is too small for a stroke.
    #[error("no stroke can be generated for this scene's screen: {0}")]
    Stroke(#[from] StrokeError),
    /// A play failed.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
}

impl Cell {
    /// Subject of an error: the scene, with the value of the parameter to blame, if one is, or else with all values
    /// that the plan sets.
    pub fn subject(&self, error: &CellError) -> String {
        let blamed = self.blamed(error);
        let values = self.parameters.iter().filter(|(path, _)| blamed.is_none_or(|blamed| *path == blamed));
        let values: Vec<String> = values.map(|(path, value)| format!("{path} = {value}")).collect();
        let with = if values.is_empty() { String::new() } else { format!(" with {}", values.join(", ")) };
        format!("{}{with}", self.scene)
    }

    /// Plays the cell. The result is the same on every machine and for any number of threads. When `goes_on` breaks, it
    /// fails with [`SimulationError::Interrupted`].
    pub fn play(&self, goes_on: GoesOn<'_>) -> Result<CellResult, CellError> {
        if self.version != env!("CARGO_PKG_VERSION") {
            return Err(CellError::OtherVersion { found: self.version.clone() });
        }
        let (scene, world, program) = self.compiled()?;
        let coating_gap_m = scene.screen().coating_gap_m();
        let person = self.person;
        let finger =
            TrialFinger::of_person(person, coating_gap_m).map_err(|source| CellError::Finger { person, source })?;
        let trials = TrialPlan {
            stroke: self.stroke.into(),
            strokes: self.strokes,
            seeds: self.seeds,
            seconds: self.seconds,
            median_speed_m_per_s: self.median_speed_mm_per_s.map(|speed_mm_per_s| 1e-3 * speed_mm_per_s),
        };
        let trials = trials.trials(&program, Some(finger), goes_on)?;
        let score = Score::of(&program, &world, &trials, goes_on)?;
        Ok(self.result(&score, program.header.voltage_max_v_rms.into()))
    }

    /// Compiles the cell's scene, without playing it. Its mistakes are the same for all people.
    pub fn check(&self) -> Result<(), CellError> {
        self.compiled().map(drop)
    }

    /// The parameter to blame for an error: the one that stands where the first mistake of the scene is.
    pub(super) fn blamed(&self, error: &CellError) -> Option<&str> {
        let (CellError::Compile(source) | CellError::Misspelt { source, .. }) = error else { return None };
        let mistake = source.diagnostics.first().filter(|mistake| mistake.file == self.scene)?;
        let is_there = |path: &&String| has_at(&self.text, path, (mistake.line, mistake.column));
        self.parameters.keys().find(is_there).map(String::as_str)
    }

    fn refused(&self, source: CompileError) -> CellError {
        match self.nearest_field(&source) {
            Some(nearest) => CellError::Misspelt { nearest, source },
            None => source.into(),
        }
    }

    /// The field of the scene that is most like a parameter which the scene does not know.
    fn nearest_field(&self, error: &CompileError) -> Option<String> {
        let unknown: Vec<&str> = error.diagnostics.iter().filter_map(Diagnostic::unknown_field).collect();
        let is_unknown = |path: &&String| path.rsplit('.').next().is_some_and(|field| unknown.contains(&field));
        self.parameters.keys().filter(is_unknown).find_map(|path| nearest_field(&self.text, path))
    }

    fn compiled(&self) -> Result<(Scene, WorldOptions, Program), CellError> {
        let mut scene = Scene::parse(&self.text, &self.scene, &self.files).map_err(|error| self.refused(error))?;
        if let Some(screen) = &self.screen {
            scene = scene.with_screen(screen.read()?, &screen.name);
        }
        let world = WorldOptions { ideal: self.ideal, touch: Some(self.touch.read()?), ..WorldOptions::default() };
        let board = Board::SIMULATOR;
        let program = compile(&scene, &board.limits, board.tick_hz).map_err(|error| self.refused(error))?;
        Ok((scene, world, program))
    }

    fn result(&self, score: &Score, voltage_v_rms: f64) -> CellResult {
        let layer = |layer: &crate::score::LayerScore| LayerResult {
            layer: layer.layer.to_string(),
            table: layer.layer.number().table,
            verdict: layer.simulated_fingers.of_one(),
            contrast_weber_steps: layer.contrast_weber_steps,
        };
        CellResult {
            cell: self.key.clone(),
            scene: self.scene.clone(),
            parameters: self.parameters.clone(),
            screen: self.screen.as_ref().map(|screen| screen.name.clone()),
            touch: self.touch.name.clone(),
            person: self.person,
            moisture: Person::drawn(self.person).moisture,
            voltage_v_rms,
            layers: score.layers.iter().map(layer).collect(),
            means: score.metrics.iter().map(|metric| (metric.key.to_owned(), metric.mean)).collect(),
        }
    }
}
