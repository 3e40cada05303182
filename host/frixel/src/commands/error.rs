//! The error messages of commands, one sentence each.

use std::io;
use std::path::{Path, PathBuf};

use super::selftest::WiresError;
use super::studio::StudioError;
use crate::output::{DrawingError, FeltLogError};
use crate::output_file::OutputFileError;
use crate::report::ReportError;
#[cfg(unix)]
use crate::rigs::ServerError;
use crate::scene_file::{SceneFileError, check_path};
use crate::stream::StreamError;
use frixel_driver::{DeviceError, PortError};
#[cfg(unix)]
use frixel_hil_sim::emulated::EmulatorError;
use frixel_hil_sim::{StrokeError, WorldError};
use frixel_lab::calibration::CalibrationError;
use frixel_lab::fit::FitError;
use frixel_lab::model_csv::CsvError;
use frixel_lab::recording::{Difference, RecordingError, ReplayError, StrokeOptionsError};
use frixel_lab::scenario::ScenarioError;
use frixel_lab::score::TrialsError;
use frixel_lab::simulation::RehearsalError;
use frixel_lab::stroke_file::StrokeFileError;
use frixel_lab::sweep::{CellError, PlanError, StudyError};
use frixel_lab::threshold::Guessed;
use frixel_model::ParameterError;
use frixel_play::{PlayError, SimulationError, StopReason};
use frixel_scene::{CompileError, Shown, Warning};
use frixel_session::store::LimitsError;
use rayon::ThreadPoolBuildError;
use thiserror::Error;

#[derive(Debug, Error)]
pub(crate) enum CommandError {
    #[error(transparent)]
    SceneFile(#[from] SceneFileError),
    #[error(transparent)]
    Compile(#[from] CompileError),
    #[error(transparent)]
    Device(#[from] DeviceError),
    #[error(transparent)]
    Rehearsal(#[from] RehearsalError),
    #[error("no firmware takes a series resistance of {series_kohm} kOhm: {source}")]
    SeriesResistance { series_kohm: f64, source: LimitsError },
    #[error(transparent)]
    Port(#[from] PortError),
    #[error("{source}; {advice}")]
    NoSuchPort { source: PortError, advice: String },
    #[cfg(unix)]
    #[error(transparent)]
    Server(#[from] ServerError),
    #[error(transparent)]
    Output(#[from] OutputFileError),
    #[error(transparent)]
    Drawing(#[from] DrawingError),
    #[error(transparent)]
    Studio(#[from] StudioError),
    #[error(transparent)]
    Report(#[from] ReportError),
    #[error(transparent)]
    Plan(#[from] PlanError),
    #[error(transparent)]
    Study(#[from] StudyError),
    #[error("{cell}: {source}")]
    Cell { cell: String, source: CellError },
    #[error("{}: {found} of {of} cells are there: play the others with `frixel sweep PLAN.toml -o {}`", folder.display(), folder.display())]
    CellsMissing { folder: PathBuf, found: usize, of: usize },
    #[error("{} is no {what} ({reason}): delete it, and play the sweep again", path.display())]
    NoSweepFile { path: PathBuf, what: &'static str, reason: String },
    #[error("{}: this {what} cannot be read ({source}): {advice}", path.display())]
    SweepInput { path: PathBuf, what: &'static str, source: io::Error, advice: &'static str },
    #[error("{}: this scenario cannot be read ({source}): {advice}", file.display())]
    ScenarioUnreadable { file: PathBuf, source: io::Error, advice: String },
    #[error(transparent)]
    Scenario(#[from] ScenarioError),
    #[error(
        "{}: {unmet} {} not as expected: see above", file.display(),
        if *unmet == 1 { "thing was" } else { "things were" }
    )]
    Unmet { file: PathBuf, unmet: usize },
    #[error(
        "{}: --expect compares with what this scenario expects, and it expects nothing: add an [[expect]] \
         (docs/scenarios.md)", file.display()
    )]
    NothingExpected { file: PathBuf },
    #[error(transparent)]
    World(#[from] WorldError),
    #[error(transparent)]
    Play(PlayError),
    #[cfg(unix)]
    #[error(transparent)]
    Emulator(#[from] EmulatorError),
    #[cfg(not(unix))]
    #[error(
        "{what} needs a pseudo-terminal, which this operating system does not have: use Linux, macOS or WSL, or play on \
         --port sim"
    )]
    NoPseudoTerminal { what: &'static str },
    #[error("the contact model rejects the scene's finger: {0}")]
    Finger(ParameterError),
    #[error(transparent)]
    Trials(#[from] TrialsError),
    #[error("the threads of --jobs cannot start: {0}; give a smaller number")]
    Threads(ThreadPoolBuildError),
    #[error("{}: {source}", path.display())]
    Stroke { path: PathBuf, source: StrokeFileError },
    #[error("no stroke can be generated for this scene's screen: {0}")]
    GeneratedStroke(StrokeError),
    #[error("--from and --to: {0}; give two places that differ")]
    StraightStroke(StrokeError),
    #[error("--times: {0}")]
    StrokeTooOften(StrokeOptionsError),
    #[error("--from and --to are the same place: give two places that differ")]
    StrokeInPlace,
    #[error("{scene} has no layer that plays a stream: add one with `kind = \"stream\"`, or leave --stream out")]
    NoStreamLayer { scene: String },
    #[error("{input}: {source}")]
    ModelCsv { input: String, source: CsvError },
    #[error("{}: {source}", path.display())]
    Fit { path: PathBuf, source: FitError },
    #[error(transparent)]
    Calibration(CalibrationError),
    #[error("{}: {source}", path.display())]
    Forces { path: PathBuf, source: CalibrationError },
    #[error("the run was interrupted: start it again")]
    ExperimentInterrupted,
    #[error(
        "--voltage {found} is above what this board drives, {limit_v_rms:.0} V rms: give at most that, or leave \
         --voltage out"
    )]
    VoltageAboveBoard { found: f64, limit_v_rms: f64 },
    #[error(
        "--voltage {found} states the friction of the contact model, and an empirical law is stated at the highest voltage \
         of the data: leave --voltage out"
    )]
    VoltageOfLaw { found: f64 },
    #[error(
        "--finger-seed draws the finger of --port sim only; the finger on {port} is its own: leave --finger-seed out"
    )]
    FingerOnBoard { port: String },
    #[error("the answers ended at trial {trial}: answer each trial with 1 or 2 and Enter")]
    NoAnswer { trial: usize },
    #[error("{count} answers to trial {trial} were neither 1 nor 2: answer each trial with 1 or 2 and Enter")]
    WrongAnswers { trial: usize, count: u32 },
    #[error(
        "{} of {} answers are right, which is no better than guessing, so that there is no threshold: check that the \
         electrode is driven, and press less hard", .0.right, .0.trials
    )]
    Guessed(Guessed),
    #[error("--observer answers in place of a person, and feels no board on {port}: leave --port out")]
    ObserverOnBoard { port: String },
    #[error("the noise cannot be made ({0})")]
    Noise(hound::Error),
    #[error("{source}; what was recorded until then is in {}: {advice}", partial.display())]
    RecordingCutOff { source: Box<CommandError>, partial: PathBuf, advice: &'static str },
    #[error("{}: {reason}: give the options of the session that was cut off, or begin a new one with --overwrite", partial.display())]
    OtherSession { partial: PathBuf, reason: String },
    #[error(
        "{} is no recorded stroke, which has t_s,x_mm,y_mm ({found}): correct or delete the row, or record anew with \
         --overwrite", partial.display()
    )]
    OtherRow { partial: PathBuf, found: String },
    #[error("a board at {port} measures no forces: give those of a sensor with --forces FILE.csv, or --forces -")]
    NoForces { port: String },
    #[error("{rows} no answer; the column `status` says why")]
    InvalidRows { rows: String },
    #[error("{} cannot be read ({source}): {}", path.display(), check_path(path, "check the path"))]
    Read { path: PathBuf, source: io::Error },
    #[error(
        "{} cannot be written ({source}): {}", path.display(), check_path(path, "check the folder and its free space")
    )]
    Write { path: PathBuf, source: io::Error },
    #[error("{} is no picture that can be played: {reason}", path.display())]
    Picture { path: PathBuf, reason: String },
    #[error(
        "{name} lasts {} s, longer than a day (86400 s): give a shorter stroke; its times are in seconds", Shown(*.seconds)
    )]
    StrokeTooLong { name: String, seconds: f64 },
    #[error(
        "{name} is nowhere on the screen, which is {width_mm} by {height_mm} mm: give places in mm from its top left corner"
    )]
    StrokeOffScreen { name: String, width_mm: f64, height_mm: f64 },
    #[error(
        "a stroke moves the finger of --port sim, --port qemu and --port pico only; a board at {port} has its own: leave \
         out --stroke and --from"
    )]
    StrokeOnBoard { port: String },
    #[error(
        "--ideal, --no-leakage, --finger-seed and --touch change the world of --port sim, --port qemu and --port pico \
         only; a board at {port} has its own: leave them out"
    )]
    WorldOnBoard { port: String },
    #[error("{port} sends telemetry at most {max} times a second, --csv-hz {found} is more; give {max} or less")]
    CsvTooFast { port: String, found: u32, max: u32 },
    #[error("--csv-hz {found} does not divide the board's {tick_hz} ticks a second; give {nearest}")]
    CsvUneven { found: u32, tick_hz: u32, nearest: String },
    #[error("{} s is shorter than one tick of the board, {tick_s} s: play for longer", Shown(*.seconds))]
    TooShort { seconds: f64, tick_s: f64 },
    #[error(
        "{port} is a board with an electrode: add --arm, and hold the board's arm switch, to let it drive hundreds of volts"
    )]
    NotArmed { port: String },
    #[error(
        "a real board plays only what was measured on this finger: {warning}; fit the finger again up to this voltage and load, or lower the scene's"
    )]
    NotMeasured { warning: Warning },
    #[error(
        "nothing is recorded, because the board saw no finger: slide one over its screen while `frixel record` runs"
    )]
    NothingRecorded,
    #[error("{failed} of the checks of {port} failed; docs/hardware.md says what each part needs")]
    SelftestFailed { port: String, failed: usize },
    #[error(transparent)]
    Wires(#[from] WiresError),
    #[error("\"{}\" has no name for a scene: give one such as wood, or scenes/wood.toml", name.display())]
    SceneName { name: PathBuf },
    #[error(
        "{} is the name of a picture, and a scene needs another: frixel new {scene} --picture {picture}", name.display()
    )]
    SceneNameOfPicture { name: PathBuf, scene: String, picture: String },
    #[error("{} is there already, and is not overwritten: give another name, or remove it", path.display())]
    SceneExists { path: PathBuf },
    #[error("standard input has either the lines of --control or the samples of --stream -: give --stream a file")]
    ControlAndStream,
    #[error(transparent)]
    FeltLog(#[from] FeltLogError),
    #[error(
        "--with-log joins the log of a virtual board at a port, --port {port} records what is felt itself: leave it out"
    )]
    LogInVirtualTime { port: String },
    #[error(
        "{} ends {behind_s:.1} s before the play did: give the felt.csv of the `frixel sim` whose port this is",
        path.display()
    )]
    LogTooShort { path: PathBuf, behind_s: f64 },
    #[error(
        "--with-log joins the log of a virtual board, and the board at this port is not one: leave it out, so that what \
         a finger does on it is recorded"
    )]
    LogOfARealBoard,
    #[error(transparent)]
    Feed(#[from] StreamError),
    #[error(
        "--stream-hz says how many samples a second come on standard input: put --stream - before it, or leave it out"
    )]
    StreamRateAlone,
    #[error("samples on standard input have no rate of their own: put --stream-hz beside --stream -")]
    StreamRateMissing,
    #[error("{} has a sample rate of its own: leave --stream-hz out", path.display())]
    StreamRateOfFile { path: PathBuf },
    #[error(
        "--watch follows the file while a board plays in real time, --port {port} does not: start `frixel sim` and give its port"
    )]
    WatchInVirtualTime { port: String },
    #[error(
        "--watch on the simulator plays anew after each change, and standard input can be read only once: leave out \
         --control or --stream -, or start `frixel sim` and give its port"
    )]
    WatchReadsInputOnce,
    #[error(
        "--watch sends a saved scene while it plays, and a stream runs dry meanwhile: leave out --watch or --stream"
    )]
    WatchWithStream,
    #[error("the emulated board's serial port is too slow for a stream: leave --stream out, or play on --port sim")]
    StreamOnEmulated,
    #[error("{port} {reason}")]
    Stopped { port: String, reason: StopReason },
    #[error("{}: {source}", path.display())]
    Recording { path: PathBuf, source: RecordingError },
    #[error("--participant goes into a Parquet file, and {} is none by its name: give one that ends in .parquet", path.display())]
    ParticipantInTable { path: PathBuf },
    #[error("{} cannot be played again: {source}", path.display())]
    NoReplay { path: PathBuf, source: Box<ReplayError> },
    #[error(
        "{} plays other bits: {difference}; the file was changed, or this machine computes differently", path.display()
    )]
    ReplayDiffers { path: PathBuf, difference: Difference },
    #[error("{} is no Parquet file by its name: give --record a name that ends in .parquet", path.display())]
    NotParquetName { path: PathBuf },
    #[error("{} is no PNG file by its name: give the picture a name that ends in .png", path.display())]
    NotPng { path: PathBuf },
    #[error("Ctrl-C cannot be watched for: {0}")]
    Interrupt(#[from] ctrlc::Error),
}

impl CommandError {
    /// Why a play on the board named by `--port` ended early.
    pub(crate) fn of_play(port: &str, error: PlayError) -> Self {
        match error {
            PlayError::Stopped(reason) => Self::Stopped { port: port.to_owned(), reason },
            error => Self::Play(error),
        }
    }

    /// Why a play on the simulator in this process ended early.
    pub(crate) fn of_simulation(error: SimulationError) -> Self {
        match error {
            SimulationError::Play(error) => Self::of_play("sim", error),
            SimulationError::World(error) => error.into(),
        }
    }

    /// Converts an error of reading `path`, for use in `map_err`.
    pub(crate) fn reading(path: &Path) -> impl FnOnce(io::Error) -> Self {
        let path = path.to_owned();
        move |source| Self::Read { path, source }
    }

    /// Converts an error of the recording at `path`, for use in `map_err`.
    pub(crate) fn recording(path: &Path) -> impl FnOnce(RecordingError) -> Self {
        let path = path.to_owned();
        move |source| Self::Recording { path, source }
    }

    /// Converts an error of writing `path`, for use in `map_err`.
    pub(crate) fn writing(path: &Path) -> impl FnOnce(io::Error) -> Self {
        let path = path.to_owned();
        move |source| Self::Write { path, source }
    }
}
