//! Errors of writing a report.

use std::io;
use std::path::PathBuf;

use frixel_hil_sim::StrokeError;
use frixel_model::ParameterError;
use frixel_play::SimulationError;
use frixel_scene::CompileError;
use thiserror::Error;

/// Why a report could not be written.
#[derive(Debug, Error)]
pub(crate) enum ReportError {
    /// A file could not be written.
    #[error(transparent)]
    Output(#[from] frixel_files::Error),
    /// The file with instruction counts could not be read.
    #[error("{} cannot be read ({source}): run `cargo xtask bench` to create one", .path.display())]
    ReadBench { path: PathBuf, source: io::Error },
    /// The file with instruction counts has the wrong format.
    #[error("{}: expected a JSON object of numbers as `cargo xtask bench` writes it, found {source}", .path.display())]
    Bench { path: PathBuf, source: serde_json::Error },
    /// A plot could not be drawn.
    #[error("{name} cannot be drawn ({reason})")]
    Drawing { name: &'static str, reason: String },
    /// The numbers of a plot could not be read or written.
    #[error("the numbers of a plot: {0}")]
    Numbers(#[from] csv::Error),
    /// A constant could not be compiled.
    #[error("a constant: {0}")]
    Compile(#[from] CompileError),
    /// A constant could not be played.
    #[error("a constant: {0}")]
    Simulation(#[from] SimulationError),
    /// The stroke of a constant could not be made.
    #[error("a constant: {0}")]
    Stroke(#[from] StrokeError),
    /// The model refused a parameter.
    #[error("the contact model: {0}")]
    Parameter(#[from] ParameterError),
}
