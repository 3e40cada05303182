//! Studies of many simulated fingers: every combination of scenes, screens, touch sources, values of a scene's fields
//! and people, each a [`Cell`].
//!
//! A [`Plan`] defines the cells, and a [`Sweep`] makes each from its number. A cell holds all that its plays need, so
//! that it is played by any process on any machine ([`Cell::play`]), and its key is a hash of that content. [`Study`]
//! puts results together, in whatever order and by however many processes they were made: intervals are computed from
//! the results of single fingers.

mod cell;
mod cells;
#[cfg(not(target_arch = "wasm32"))]
mod files;
mod parameter;
#[cfg(not(target_arch = "wasm32"))]
mod picture;
mod plan;
mod result_file;
mod study;
#[cfg(not(target_arch = "wasm32"))]
mod tables;

use serde::Serialize;

pub use cell::{Cell, CellError, CellResult, LayerResult};
pub use cells::{Index, Source, Sweep};
#[cfg(not(target_arch = "wasm32"))]
pub use files::PlanFileError;
pub use parameter::Value;
pub use plan::{Plan, PlanError, Range, Values};
pub use result_file::CellResultError;
pub use study::{Group, LayerShare, Study};
#[cfg(not(target_arch = "wasm32"))]
pub use tables::StudyError;

/// The folder of the results of cells, in the folder of a study.
pub const CELLS: &str = "cells";

/// The JSON of a cell, of a result, or of an index, as files have it.
pub fn json(value: &impl Serialize) -> String {
    // Numbers, strings and maps with names always serialise.
    serde_json::to_string(value).unwrap_or_default()
}
