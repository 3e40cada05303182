//! Why a report cannot be made.

use std::io;
use std::path::PathBuf;

use frixel_hil_sim::StrokeError;
use frixel_model::{InverseError, ParameterError, StateError, TableError};
use frixel_wire::payload::WriteError;
use thiserror::Error;

use crate::player::PlayError;
use frixel_scene::CompileError;

/// Why a report cannot be made.
#[derive(Debug, Error)]
pub enum ReportError {
    /// The folder or a file in it cannot be written.
    #[error("{} cannot be written ({source}): check the folder and its free space", .path.display())]
    Write {
        /// The file or folder.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// The file with instruction counts cannot be read.
    #[error("{} cannot be read ({source}): `cargo xtask bench` writes such a file", .path.display())]
    ReadBench {
        /// The file.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// The file with instruction counts is not one.
    #[error("{}: expected a JSON object of numbers as `cargo xtask bench` writes it, found {source}", .path.display())]
    Bench {
        /// The file.
        path: PathBuf,
        /// What the parser said.
        source: serde_json::Error,
    },
    /// A picture could not be drawn.
    #[error("{name} cannot be drawn ({reason})")]
    Drawing {
        /// The picture.
        name: &'static str,
        /// What the drawing library said.
        reason: String,
    },
    /// The numbers behind a picture could not be written as CSV.
    #[error("the numbers behind a picture: {0}")]
    Numbers(#[from] csv::Error),
    /// The model refuses a parameter.
    #[error("the contact model: {0}")]
    Parameter(#[from] ParameterError),
    /// The model has no state.
    #[error("the contact model: {0}")]
    State(#[from] StateError),
    /// The model has no voltage.
    #[error("the contact model: {0}")]
    Inverse(#[from] InverseError),
    /// A table cannot be built.
    #[error("a table of the contact model: {0}")]
    Table(#[from] TableError),
    /// A scene cannot be framed.
    #[error("a scene on the wire: {0}")]
    Wire(#[from] WriteError),
    /// A scene does not compile.
    #[error(transparent)]
    Texture(#[from] CompileError),
    /// The stroke over the texture cannot be made.
    #[error(transparent)]
    Stroke(#[from] StrokeError),
    /// The texture cannot be simulated.
    #[error(transparent)]
    Simulation(#[from] PlayError),
}
