//! Plays on the simulated board, in virtual time.

use frixel_hil_sim::{RigConfig, Stroke as SimulatedStroke};
use frixel_lab::GeneratedStroke;
use frixel_lab::recording::{Metadata, PlaySource, play_fields, play_values};
use frixel_lab::simulate::{PlayOptions, PlayOptionsError, StrokeOptions, off_screen_note, screen_m};
use frixel_lab::stroke_file::{self, StrokeFile, StrokeFileError};
use frixel_play::{Simulated, Simulation};
use frixel_scene::Program;
use numpy::PyReadonlyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::error::{parameter_error, raised, scene_error};
use super::profile::ProfileText;
use super::recording::{Made, columns};
use super::scene::Scene;
use super::signals::interruptible;

const M_PER_MM: f64 = 1e-3;

/// A stroke, an object of `python/frixel/stroke.py`.
#[derive(FromPyObject)]
pub(crate) enum Stroke<'py> {
    /// Straight from one place to another.
    Straight { from_mm: (f64, f64), to_mm: (f64, f64), speed_mm_s: f64, minimum_jerk: bool },
    /// The movements of a person.
    Human { seed: u64, seconds: Option<f64>, rough: bool },
    /// Through places, which are NaN while the finger is off the screen.
    Rows {
        t_s: PyReadonlyArray1<'py, f64>,
        x_mm: PyReadonlyArray1<'py, f64>,
        y_mm: PyReadonlyArray1<'py, f64>,
        load_n: Option<PyReadonlyArray1<'py, f64>>,
    },
}

impl Stroke<'_> {
    /// The options as a recording stores them.
    fn options(&self) -> StrokeOptions {
        match self {
            Self::Straight { from_mm, to_mm, speed_mm_s, minimum_jerk } => {
                let place_m = |(x_mm, y_mm): &(f64, f64)| Some([M_PER_MM * x_mm, M_PER_MM * y_mm]);
                StrokeOptions {
                    from_m: place_m(from_mm),
                    to_m: place_m(to_mm),
                    speed_m_per_s: Some(M_PER_MM * speed_mm_s),
                    minimum_jerk: *minimum_jerk,
                    ..StrokeOptions::default()
                }
            }
            Self::Human { seed, seconds, rough } => {
                let made = if *rough { GeneratedStroke::HumanRough } else { GeneratedStroke::Human };
                let (human_seed, human_seconds) = (Some(*seed), *seconds);
                StrokeOptions { name: Some(made.name().into()), human_seed, human_seconds, ..StrokeOptions::default() }
            }
            Self::Rows { .. } => StrokeOptions { name: Some(PlayOptions::FILE.into()), ..StrokeOptions::default() },
        }
    }

    /// The stroke of rows; `None` for a generated stroke.
    fn of_rows(&self) -> Result<Option<SimulatedStroke>, StrokeFileError> {
        Ok(self.csv().map(|csv| StrokeFile::read(csv.as_bytes())).transpose()?.map(|file| file.stroke))
    }

    /// The stroke on the screen of a program.
    pub(crate) fn on_screen(&self, py: Python<'_>, program: &Program) -> PyResult<Option<SimulatedStroke>> {
        if let Some(stroke) = self.of_rows().map_err(|error| parameter_error(py, error))? {
            return Ok(Some(stroke));
        }
        let generated = self.options().generated(screen_m(program), None, 1);
        generated.map_err(|error| parameter_error(py, error))
    }

    /// The rows as the text of a file.
    fn csv(&self) -> Option<String> {
        let Self::Rows { t_s, x_mm, y_mm, load_n } = self else { return None };
        let (t_s, x_mm, y_mm) = (t_s.as_array(), x_mm.as_array(), y_mm.as_array());
        let load_n = load_n.as_ref().map(PyReadonlyArray1::as_array);
        let load_n = |row: usize| load_n.and_then(|load_n| load_n.get(row).copied()).unwrap_or(f64::NAN);
        let places = t_s.iter().zip(x_mm).zip(y_mm).enumerate();
        Some(stroke_file::to_csv(places.map(|(row, ((t_s, x_mm), y_mm))| [*t_s, *x_mm, *y_mm, load_n(row)])))
    }
}

/// Rejects rows that are not a stroke of a finger. Messages name the element of an array.
#[pyfunction]
pub(crate) fn check_stroke(py: Python<'_>, stroke: Stroke<'_>) -> PyResult<()> {
    stroke.of_rows().map(|_| ()).map_err(|error| match error {
        StrokeFileError::Number { row, column, reason, .. } => {
            let argument = if column == "force_n" { "load_n" } else { column };
            parameter_error(py, format!("{argument}[{}]: {reason}", row.saturating_sub(2)))
        }
        error => parameter_error(py, error),
    })
}

/// Settings of a play, an object of `python/frixel/simulator.py`.
#[derive(FromPyObject)]
pub(crate) struct Settings<'py> {
    stroke: Option<Stroke<'py>>,
    seed: u64,
    person: Option<u64>,
    touch: Option<ProfileText>,
    ideal: bool,
    leakage: bool,
    mean_square: bool,
    rows_per_s: u32,
}

/// A checked play, with all its inputs.
struct Play<'s> {
    program: &'s Program,
    options: PlayOptions,
    /// Finger, screen, touch source and stroke.
    source: PlaySource,
    simulation: Simulation,
}

impl Settings<'_> {
    /// The play that `frixel play --port sim` makes with the same settings.
    fn play<'s>(&self, py: Python<'_>, scene: &'s Scene, seconds: Option<f64>) -> PyResult<Play<'s>> {
        let program = scene.program();
        let stroke = self.stroke.as_ref().map(Stroke::of_rows).transpose();
        let stroke = stroke.map_err(|error| parameter_error(py, error))?.flatten();
        let touch = self.touch.as_ref().map(|touch| touch.read(py)).transpose()?;
        let options = self.options(seconds);
        let simulation = options.simulation(scene.parsed(), program, (stroke, touch), &RigConfig::default());
        let simulation = simulation.map_err(|error| match error {
            PlayOptionsError::Screen(error) => scene_error(py, &error),
            error @ PlayOptionsError::RowRate { .. } => parameter_error(py, format!("rows_per_s: {error}")),
            error => parameter_error(py, error),
        })?;
        let profile = |profile: Option<&ProfileText>| profile.map(ProfileText::named);
        let source = PlaySource {
            finger: profile(scene.own_finger()),
            screen: profile(scene.own_screen()),
            touch: profile(self.touch.as_ref()),
            stroke: self.stroke.as_ref().and_then(Stroke::csv).map(String::into_bytes),
            ..PlaySource::default()
        };
        Ok(Play { program, options, source, simulation })
    }

    /// The options as a recording stores them, without the names of profiles.
    fn options(&self, seconds: Option<f64>) -> PlayOptions {
        PlayOptions {
            seconds,
            seed: self.seed,
            ideal: self.ideal,
            no_leakage: !self.leakage,
            mean_square: self.mean_square,
            finger_seed: self.person,
            rows_hz: self.rows_per_s,
            finger: None,
            screen: None,
            touch: None,
            stroke: self.stroke.as_ref().map(Stroke::options).unwrap_or_default(),
            control: false,
            stream: false,
            lines: None,
            stream_s: None,
            interrupted: false,
        }
    }
}

/// Plays a scene on the simulated board. Returns the columns of the recording, its [`Made`] as JSON, and a sentence if
/// the stroke leaves the screen.
#[pyfunction]
pub(crate) fn simulate<'py>(
    py: Python<'py>,
    scene: &Scene,
    settings: Settings<'py>,
    seconds: Option<f64>,
) -> PyResult<(Bound<'py, PyDict>, String, Option<String>)> {
    let Play { program, options, source, simulation } = settings.play(py, scene, seconds)?;
    let played = interruptible(py, |goes_on| frixel_play::simulate(program, &simulation, None, goes_on))?;
    let failed = |error: &dyn std::fmt::Display| raised(py, "PlayError", (error.to_string(),));
    let Simulated { recorder, board, .. } = played.map_err(|error| failed(&error))?;
    let of_board = Metadata::new("sim", Some(&board), true, None);
    let metadata = source.recorded(options, Metadata { ticks_per_row: simulation.ticks_per_row, ..of_board });
    let files = metadata.files.clone();
    let made = Made { metadata, files, later_scenes: Vec::new(), markers: recorder.markers().to_vec() };
    let made = serde_json::to_string(&made).map_err(|error| failed(&error))?;
    let note = off_screen_note(&simulation.stroke, screen_m(program), simulation.seconds);
    let note = note.map_err(|error| parameter_error(py, error.to_string()))?;
    Ok((columns(py, &play_fields(), play_values(recorder.rows()))?, made, note))
}
