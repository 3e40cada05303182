//! Runs a scenario on a rig: the host's commands and the faults at their times, and the expected observations.
//!
//! The host connects and plays the scenario's scene; time zero is the end of that play command.
//!
//! [`run_in_process`] runs one on the in-process rig, and [`run`] on any [`BoardRig`]. Host and board are the real
//! ones: a [`Player`](frixel_play::Player) over a [`Device`](frixel_driver::Device), and the firmware of the rig.
//! Faults of the line are made at the host's end of it; everything else is the rig's.

mod checks;
mod direction;
mod host;
mod line;
mod state_history;

use std::collections::BTreeMap;
use std::fmt::{self, Display};

use frixel_hil_sim::{Board, BoardMemory, BoardRig, Point, RigConfig, RigError, Stroke, StrokeError, WorldOptions};
use frixel_play::{Simulation, SimulationError, ticks_spanning};
use frixel_scene::{CompileError, Program, Scenario, Scene, compile, printable};
use thiserror::Error;

use crate::simulate::{BUNDLED_SCREEN_M, REPEAT_PAUSE_S, endless_sweep, screen_m};

use host::Host;
use line::ScenarioLine;

/// Results of a scenario.
#[derive(Clone, Debug, PartialEq)]
pub struct ScenarioOutcome {
    /// Events, in the order of time.
    pub timeline: Vec<TimelineEntry>,
    /// Number of expectations.
    pub expectations: usize,
    /// Unmet expectations and failed commands, in the order of the file.
    pub unmet: Vec<Unmet>,
}

/// An event of a scenario.
#[derive(Clone, Debug, PartialEq)]
pub struct TimelineEntry {
    /// Time since the play began, ms.
    pub t_ms: f64,
    /// Description of the event.
    pub what: String,
}

impl Display for TimelineEntry {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(formatter, "{:>12.3} ms  {}", self.t_ms, printable(&self.what))
    }
}

/// An expectation that was not met, or a command that failed and was not expected to. Its text is one sentence: what
/// was expected, what was found, and when.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("{file}:{line}: {sentence}")]
pub struct Unmet {
    /// The scenario's file.
    pub file: String,
    /// Line of the expectation, or of the command that failed.
    pub line: usize,
    /// Number of the expectation in [`Scenario::expectations`]; `None` for a command.
    pub expectation: Option<usize>,
    /// The sentence.
    pub sentence: String,
}

/// Why a scenario does not run.
#[derive(Debug, Error)]
pub enum ScenarioError {
    /// A scene cannot be compiled for the rig's board.
    #[error(transparent)]
    Compile(#[from] CompileError),
    /// The stroke is invalid.
    #[error("{file}: no finger can follow this stroke: {source}")]
    Stroke {
        /// The scenario's file.
        file: String,
        /// The reason.
        source: StrokeError,
    },
    /// The world cannot be made.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
    /// The rig has ended, or cannot cause a fault.
    #[error("{file}: {source}")]
    Rig {
        /// The scenario's file, and the line of a fault.
        file: String,
        /// The reason.
        source: RigError,
    },
    /// A scene was not given.
    #[error("{file} plays {scene}, which was not given")]
    NoScene {
        /// The scenario's file.
        file: String,
        /// The scene's file.
        scene: String,
    },
}

/// The scenes of a scenario, compiled for a board, by their files' names.
pub type Programs = BTreeMap<String, Program>;

/// Compiles the scenes of a scenario for a board. `scenes` has them by their files' names.
pub fn programs(
    scenario: &Scenario,
    scenes: &BTreeMap<String, Scene>,
    board: &Board,
) -> Result<Programs, ScenarioError> {
    let compiled = scenario.scenes().map(|name| {
        let none = || ScenarioError::NoScene { file: scenario.file.clone(), scene: name.to_owned() };
        let program = compile(scenes.get(name).ok_or_else(none)?, &board.limits, board.tick_hz)?;
        Ok((name.to_owned(), program))
    });
    compiled.collect()
}

/// World and stroke of a scenario on the board of `rig`.
pub fn simulation(scenario: &Scenario, programs: &Programs, rig: &RigConfig) -> Result<Simulation, ScenarioError> {
    let world = WorldOptions { ideal: !scenario.is_realistic, ..WorldOptions::default() };
    let stroke = if let Some(stroke) = &scenario.stroke {
        let [from, to] = [stroke.from_mm, stroke.to_mm].map(|[x, y]| Point { x_m: 1e-3 * x, y_m: 1e-3 * y });
        Stroke::constant_speed(from, to, 1e-3 * stroke.speed_mm_per_s).and_then(|stroke| stroke.looped(REPEAT_PAUSE_S))
    } else {
        endless_sweep(programs.get(&scenario.scene).map_or(BUNDLED_SCREEN_M, screen_m))
    };
    let stroke = stroke.map_err(|source| ScenarioError::Stroke { file: scenario.file.clone(), source })?;
    let simulation = Simulation::of_stroke(rig.with(&world), stroke, scenario.seed);
    Ok(Simulation { seconds: scenario.seconds, ..simulation })
}

/// The program of a scenario's first scene.
pub fn first_program<'p>(scenario: &Scenario, programs: &'p Programs) -> Result<&'p Program, ScenarioError> {
    let no_scene = || ScenarioError::NoScene { file: scenario.file.clone(), scene: scenario.scene.clone() };
    programs.get(&scenario.scene).ok_or_else(no_scene)
}

/// Runs a scenario on the in-process rig. Its [`programs`] must be compiled for `config.board`.
pub fn run_in_process(
    scenario: &Scenario,
    programs: &Programs,
    config: &RigConfig,
) -> Result<ScenarioOutcome, ScenarioError> {
    let (mut memory, mut spare) = (BoardMemory::new(), vec![]);
    spare.resize_with(scenario.resets(), BoardMemory::new);
    let rig = simulation(scenario, programs, config)?.rig(&mut memory).map_err(SimulationError::from)?;
    run(scenario, programs, &mut rig.with_spare_memories(&mut spare))
}

/// A time in ticks of a board: the next whole number of them.
fn ticks_of(ms: f64, tick_hz: u32) -> u64 {
    ticks_spanning(1e-3 * ms, tick_hz)
}

/// Runs a scenario on a rig, in the world of its [`simulation`].
pub fn run(scenario: &Scenario, programs: &Programs, rig: &mut dyn BoardRig) -> Result<ScenarioOutcome, ScenarioError> {
    let line = ScenarioLine::new(scenario, first_program(scenario, programs)?, rig);
    let mut host = Host::new(scenario, programs, line.clone());
    host.run();
    line.outcome(scenario, host.failures)
}
