//! Why a report could not be written.

use std::io;
use std::path::PathBuf;

use frixel_lab::simulation::RehearsalError;
use frixel_model::{InverseError, ParameterError, StateError, TableError};
use frixel_wire::payload::WriteError;
use thiserror::Error;

use frixel_scene::CompileError;

/// Why a report could not be written.
#[derive(Debug, Error)]
pub enum ReportError {
    /// A file could not be written.
    #[error(transparent)]
    Output(#[from] anyhow::Error),
    /// The picture of the scenes that are measured could not be encoded.
    #[error("the picture of a scene: {0}")]
    Picture(#[from] png::EncodingError),
    /// The file with instruction counts could not be read.
    #[error("{} cannot be read ({source}): `cargo xtask bench` writes such a file", .path.display())]
    ReadBench {
        /// Path of the file.
        path: PathBuf,
        /// Error of the operating system.
        source: io::Error,
    },
    /// The file with instruction counts has the wrong format.
    #[error("{}: expected a JSON object of numbers as `cargo xtask bench` writes it, found {source}", .path.display())]
    Bench {
        /// Path of the file.
        path: PathBuf,
        /// Error of the parser.
        source: serde_json::Error,
    },
    /// A picture could not be drawn.
    #[error("{name} cannot be drawn ({reason})")]
    Drawing {
        /// Name of the picture.
        name: &'static str,
        /// Error message of the drawing library.
        reason: String,
    },
    /// The numbers behind a picture could not be written as CSV.
    #[error("the numbers behind a picture: {0}")]
    Numbers(#[from] csv::Error),
    /// The model rejected a parameter.
    #[error("the contact model: {0}")]
    Parameter(#[from] ParameterError),
    /// The model could not compute a contact state.
    #[error("the contact model: {0}")]
    State(#[from] StateError),
    /// The model could not compute a voltage.
    #[error("the contact model: {0}")]
    Inverse(#[from] InverseError),
    /// A table could not be built.
    #[error("a table of the contact model: {0}")]
    Table(#[from] TableError),
    /// A scene could not be encoded into frames.
    #[error("a scene on the wire: {0}")]
    Wire(#[from] WriteError),
    /// The simulated board did not take the scene.
    #[error(transparent)]
    Rehearsal(#[from] RehearsalError),
    /// A scene could not be compiled.
    #[error(transparent)]
    Texture(#[from] CompileError),
}
