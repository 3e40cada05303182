//! Plays on the simulated board, in virtual time.

use std::ops::ControlFlow;
use std::time::{Duration, Instant};

use frixel_hil_sim::{
    Person, Point, RigConfig, Stroke as SimulatedStroke, StrokeError, StrokeRow, TouchConfig, WorldConfig,
};
use frixel_lab::default_stroke::default_stroke;
use frixel_lab::recording::{play_fields, play_values};
use frixel_lab::simulation::{Simulation, simulate_while};
use frixel_model::FrictionLaw;
use frixel_scene::Program;
use numpy::PyReadonlyArray1;
use pyo3::prelude::*;
use pyo3::types::PyDict;

use super::error::{parameter_error, raised, scene_error};
use super::profile::ProfileText;
use super::recording::columns;
use super::scene::Scene;

const M_PER_MM: f64 = 1e-3;
/// Duration of a person's stroke unless another is given, s.
const HUMAN_S: f64 = 10.0;
/// Time between two places of a stroke that are looked at, s.
const CHECK_PERIOD_S: f64 = 1e-3;
/// Longest play, s: a day.
const SECONDS_MAX: f64 = 86_400.0;
/// Time between two looks at Python's signals.
const SIGNALS_PERIOD: Duration = Duration::from_millis(50);

/// A stroke, an object of `python/frixel/stroke.py`.
#[derive(FromPyObject)]
pub(crate) enum Stroke<'py> {
    /// Straight from one place to another.
    Straight { from_mm: (f64, f64), to_mm: (f64, f64), speed_mm_s: f64, minimum_jerk: bool },
    /// As a person moves.
    Human { seed: u64, seconds: Option<f64>, rough: bool },
    /// Through places, not a number while the finger is off the screen.
    Rows {
        t_s: PyReadonlyArray1<'py, f64>,
        x_mm: PyReadonlyArray1<'py, f64>,
        y_mm: PyReadonlyArray1<'py, f64>,
        load_n: Option<PyReadonlyArray1<'py, f64>>,
    },
}

impl Stroke<'_> {
    fn on(&self, program: &Program, seconds: Option<f64>) -> Result<SimulatedStroke, StrokeError> {
        match self {
            Self::Straight { from_mm, to_mm, speed_mm_s, minimum_jerk } => {
                let [from, to] = [from_mm, to_mm].map(|(x, y)| point(*x, *y));
                let stroke = SimulatedStroke::constant_speed(from, to, M_PER_MM * speed_mm_s)?;
                let duration_s = stroke.duration_s();
                if *minimum_jerk { SimulatedStroke::minimum_jerk(from, to, duration_s) } else { Ok(stroke) }
            }
            Self::Human { seed, seconds: own, rough } => {
                let (width_m, height_m) = screen_m(program);
                let human = if *rough { SimulatedStroke::human_rough } else { SimulatedStroke::human };
                human(width_m, height_m, own.or(seconds).unwrap_or(HUMAN_S), None, *seed)
            }
            Self::Rows { t_s, x_mm, y_mm, load_n } => {
                let (t_s, x_mm, y_mm) = (t_s.as_array(), x_mm.as_array(), y_mm.as_array());
                let load_n = load_n.as_ref().map(PyReadonlyArray1::as_array);
                let places = t_s.iter().zip(x_mm).zip(y_mm).enumerate();
                let rows: Vec<StrokeRow> = places
                    .map(|(row, ((t_s, x_mm), y_mm))| StrokeRow {
                        t_s: *t_s,
                        place: (!x_mm.is_nan()).then(|| point(*x_mm, *y_mm)),
                        normal_load_n: load_n.and_then(|load_n| load_n.get(row).copied()).filter(|load| !load.is_nan()),
                    })
                    .collect();
                SimulatedStroke::through_rows(&rows)
            }
        }
    }
}

fn point(x_mm: f64, y_mm: f64) -> Point {
    Point { x_m: M_PER_MM * x_mm, y_m: M_PER_MM * y_mm }
}

fn screen_m(program: &Program) -> (f64, f64) {
    (program.header.screen_width_m.into(), program.header.screen_height_m.into())
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
    rows_per_s: u32,
}

/// A play with all that it needs, checked.
struct Play<'s> {
    program: &'s Program,
    simulation: Simulation,
    own_finger: Option<FrictionLaw>,
    through_finger: bool,
}

impl Settings<'_> {
    /// The play that `frixel play --port sim` makes with the same settings.
    fn play<'s>(&self, py: Python<'_>, scene: &'s Scene, seconds: Option<f64>) -> PyResult<Play<'s>> {
        let program = scene.program();
        let tick_hz = RigConfig::default().board.tick_hz;
        let checked = |seconds: f64| {
            let is_playable = seconds * f64::from(tick_hz) >= 1.0 && seconds <= SECONDS_MAX;
            let message = || format!("a play lasts from a tick to {SECONDS_MAX} s, found {seconds} s");
            if is_playable { Ok(seconds) } else { Err(parameter_error(py, message())) }
        };
        seconds.map_or(Ok(0.0), checked)?;
        let refused = |error: StrokeError| parameter_error(py, error);
        let stroke = match &self.stroke {
            Some(stroke) => stroke.on(program, seconds).map_err(refused)?,
            None => default_stroke(program, seconds).map_err(refused)?,
        };
        let seconds = checked(seconds.unwrap_or(stroke.duration_s()))?;
        let mut rig = RigConfig::default();
        if !is_on_screen(&stroke, screen_m(program), seconds) {
            let (width_mm, height_mm) = (scene.parsed().screen().width_mm, scene.parsed().screen().height_mm);
            let message =
                format!("the stroke is never on the screen of {width_mm} mm by {height_mm} mm: move it there");
            return Err(parameter_error(py, message));
        }
        if self.rows_per_s == 0 || !tick_hz.is_multiple_of(self.rows_per_s) {
            let message = format!("rows_per_s divides {tick_hz} evenly, found {}", self.rows_per_s);
            return Err(parameter_error(py, message));
        }
        let person = self.person.map(|seed| {
            let screen = scene.parsed().screen_without_skin().map_err(|error| scene_error(py, &error))?;
            let person = Person::drawn(seed);
            let contact = person.contact(1e-6 * screen.coating_gap_um()).map_err(|error| parameter_error(py, error))?;
            Ok::<_, PyErr>((person, contact))
        });
        let person = person.transpose()?;
        let touch = self.touch.as_ref().map(|touch| touch.touch_source(py)).transpose()?;
        rig.world = self.world(rig.world, person.as_ref().map(|(person, _)| person), touch);
        // A draft may take longer than a board has time for.
        rig.board.limits.tick_cycles_max = u32::MAX;
        let through_finger = !self.ideal || person.is_some() || stroke.has_loads();
        let ticks_per_row = tick_hz / self.rows_per_s;
        let simulation = Simulation { rig, stroke, seconds, seed: self.seed, ticks_per_row };
        Ok(Play { program, simulation, own_finger: person.map(|(_, contact)| contact.into()), through_finger })
    }

    fn world(&self, ideal: WorldConfig, person: Option<&Person>, touch: Option<TouchConfig>) -> WorldConfig {
        if self.ideal {
            return WorldConfig { touch: touch.map_or(ideal.touch, TouchConfig::without_losses), ..ideal };
        }
        let realistic = ideal.realistic();
        let fingertip = person.map_or(realistic.fingertip, |person| person.fingertip);
        let fingertip = if self.leakage { fingertip } else { fingertip.without_leakage() };
        WorldConfig { fingertip, touch: touch.unwrap_or(realistic.touch), ..realistic }
    }
}

fn is_on_screen(stroke: &SimulatedStroke, (width_m, height_m): (f64, f64), seconds: f64) -> bool {
    let end_s = seconds.min(stroke.duration_s());
    let mut times = (0..).map(|step| CHECK_PERIOD_S * f64::from(step)).take_while(|t_s| *t_s <= end_s);
    times.any(|t_s| {
        let finger = stroke.at(t_s);
        finger.is_some_and(|finger| (0.0..=width_m).contains(&finger.x_m) && (0.0..=height_m).contains(&finger.y_m))
    })
}

/// Plays a scene on the simulated board. Returns the columns of the record.
#[pyfunction]
pub(crate) fn simulate<'py>(
    py: Python<'py>,
    scene: &Scene,
    settings: Settings<'py>,
    seconds: Option<f64>,
) -> PyResult<Bound<'py, PyDict>> {
    let Play { program, simulation, own_finger, through_finger } = settings.play(py, scene, seconds)?;
    let mut signal = None;
    let played = py.detach(|| {
        let mut looked_at = Instant::now();
        simulate_while(program, &simulation, own_finger, through_finger, &mut || {
            if looked_at.elapsed() >= SIGNALS_PERIOD {
                looked_at = Instant::now();
                #[allow(clippy::redundant_closure_for_method_calls, reason = "the method is of one lifetime only")]
                let looked = Python::attach(|py| py.check_signals());
                signal = looked.err();
            }
            if signal.is_some() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
        })
        .map(|simulated| simulated.recorder)
    });
    if let Some(signal) = signal {
        return Err(signal);
    }
    let recorder = played.map_err(|error| raised(py, "PlayError", (error.to_string(),)))?;
    columns(py, &play_fields(), play_values(recorder.rows()))
}
