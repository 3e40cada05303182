//! Errors of commands: one sentence each, which includes the message of its source.

use std::fmt::Display;
use std::io;
use std::path::Path;

use anyhow::anyhow;
use frixel_files::OutputFile;
pub(crate) use frixel_files::writing;
use frixel_hil_sim::StrokeError;
use frixel_lab::input::check_path;
use frixel_model::ParameterError;
use frixel_play::{PlayError, SimulationError};

/// Prefixes an error with its subject, for use in `map_err`.
pub(crate) fn at<E: Display>(subject: impl Display) -> impl FnOnce(E) -> anyhow::Error {
    move |error| anyhow!("{subject}: {error}")
}

/// Converts an error of reading `path`, for use in `map_err`.
pub(crate) fn reading(path: &Path) -> impl FnOnce(io::Error) -> anyhow::Error {
    unreadable(path, check_path(path, "check the path"))
}

/// Like [`reading`], with its own advice.
pub(crate) fn unreadable(path: &Path, advice: impl Display) -> impl FnOnce(io::Error) -> anyhow::Error {
    move |error| anyhow!("{} cannot be read ({error}): {advice}", path.display())
}

/// Converts the error that ended a play on the board named by `--port`.
pub(crate) fn of_play(port: &str, error: PlayError) -> anyhow::Error {
    match error {
        PlayError::Stopped(reason) => anyhow!("{port} {reason}"),
        error => error.into(),
    }
}

/// Converts the error that ended a play on the simulator in this process.
pub(crate) fn of_simulation(error: SimulationError) -> anyhow::Error {
    match error {
        SimulationError::Play(error) => of_play("sim", error),
        error => error.into(),
    }
}

/// Converts the error of a finger that the contact model refuses.
pub(crate) fn of_finger(error: ParameterError) -> anyhow::Error {
    at("the contact model refuses the scene's finger")(error)
}

/// Converts the error of a screen on which no stroke can be generated.
pub(crate) fn of_generated_stroke(error: StrokeError) -> anyhow::Error {
    at("no stroke can be generated for this scene's screen")(error)
}

/// Extends an error that ended a recording: names the file of the rows recorded so far, if any, and adds `advice` on
/// how to keep them.
pub(crate) fn cut_off(recording: &OutputFile, advice: &str, error: anyhow::Error) -> anyhow::Error {
    if recording.is_cut_off() {
        return anyhow!("{error}; what was recorded until then is in {}: {advice}", recording.partial().display());
    }
    error
}

/// The error of `what` on an operating system without pseudo-terminals.
#[cfg(not(unix))]
pub(crate) fn no_pseudo_terminal(what: &str) -> anyhow::Error {
    anyhow!(
        "{what} needs a pseudo-terminal, which this operating system does not have: use Linux, macOS or WSL, or play \
         on --port sim"
    )
}
