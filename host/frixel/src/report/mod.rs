//! The report of `frixel report`: the model's error, the cost of its inversion, and what a scene costs and leaves out.
//!
//! [`write()`] creates a [`Page`] in a folder: a self-contained `index.html`, which begins with the answers, with the
//! numbers behind each picture as CSV files beside it.

mod counts;
mod error;
mod figure;
mod figures;
mod finger;
mod methods;
mod page;
mod reference;
mod wire;

use std::path::{Path, PathBuf};

pub use error::ReportError;
pub use figure::{Data, Figure, Value};
pub use page::{Answer, Page};

use counts::Counts;
use frixel_scene::Program;

use crate::output_file::{Inputs, OutputFolder};

/// The scene that a report is about.
#[derive(Clone, Copy, Debug)]
pub struct Subject<'s> {
    /// Name of the scene, for a person.
    pub name: &'s str,
    /// The scene, compiled for the simulated board. Its finger is the one that figures are drawn for.
    pub program: &'s Program,
}

/// Writes the report into a folder, creating it if necessary, and returns the paths of the files.
///
/// `bench` is a file of instruction counts written by `cargo xtask bench`, in place of those of this version. `inputs`
/// are the files that were read. The run times are measured anew; everything else is equal in every run.
pub fn write(
    folder: &Path,
    subject: &Subject,
    bench: Option<&Path>,
    inputs: &Inputs,
) -> Result<Vec<PathBuf>, ReportError> {
    let counts = bench.map_or_else(Counts::committed, Counts::read)?;
    let _locked = OutputFolder::open(folder)?;
    let (answers, figures) = figures::all(subject, &counts)?;
    let title = "The contact model, its error and its cost";
    Page { title, maker: "frixel report", answers: &answers, figures: &figures }.write(folder, inputs)
}
