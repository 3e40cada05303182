//! The report of `frixel report`: the model's error, the cost of its inversion, and the cost of a scene on a board and
//! on the line.
//!
//! [`write()`] creates a [`Page`] in a folder: a self-contained `index.html`, with the numbers behind each picture as CSV
//! files beside it.

mod counts;
mod error;
pub mod example;
mod figure;
mod figures;
mod methods;
mod page;
mod reference;
mod wire;

use std::path::{Path, PathBuf};

pub use error::ReportError;
pub use figure::{Data, Figure, Value};
pub use page::Page;

use counts::Counts;

use crate::output_file::{Inputs, OutputFolder};

/// Writes the report into a folder, creating it if necessary, and returns the paths of the files.
///
/// `bench` is a file of instruction counts written by `cargo xtask bench`, for the charts of the cost of an inversion
/// and of a tick. The run times are measured anew; everything else is equal in every run.
pub fn write(folder: &Path, bench: Option<&Path>) -> Result<Vec<PathBuf>, ReportError> {
    let counts = bench.map(Counts::read).transpose()?;
    let _locked = OutputFolder::open(folder)?;
    let figures = figures::all(counts.as_ref())?;
    let page = Page { title: "The contact model, its error and its cost", maker: "frixel report", figures: &figures };
    page.write(folder, &Inputs::new(bench))
}
