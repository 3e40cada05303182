//! The report of `frixel report`: the paper's figures computed from the model, the model's error, the cost of its
//! inversion, and the cost of a scene on a board and on the line.
//!
//! [`write()`] creates a self-contained `index.html` in a folder, with the numbers behind each picture as CSV files
//! beside it.

mod counts;
mod data;
mod error;
mod figures;
mod methods;
mod page;
mod reference;
mod touch;
mod wire;

use std::path::{Path, PathBuf};

pub use error::ReportError;

use counts::Counts;

use crate::output_file::{Inputs, OutputFile, OutputFolder, commit_all};

/// Writes the report into a folder, creating it if necessary, and returns the paths of the files.
///
/// `bench` is a file of instruction counts written by `cargo xtask bench`, for the charts of the cost of an inversion
/// and of a tick. The run times are measured anew; everything else is equal in every run.
pub fn write(folder: &Path, bench: Option<&Path>) -> Result<Vec<PathBuf>, ReportError> {
    let counts = bench.map(Counts::read).transpose()?;
    let _locked = OutputFolder::open(folder)?;
    let inputs = Inputs::new(bench);
    let figures = figures::all(counts.as_ref())?;
    let mut paths = Vec::new();
    let mut files = Vec::new();
    let mut put = |name: &str, bytes: &[u8]| {
        let path = folder.join(name);
        files.push(OutputFile::new(&path, "--out", &inputs)?.filled(bytes)?);
        Ok::<PathBuf, ReportError>(path)
    };
    let mut drawn = Vec::new();
    for figure in &figures {
        let drawing = |reason: String| ReportError::Drawing { name: figure.name, reason };
        drawn.push((figure, figure.chart.svg().map_err(|error| drawing(error.to_string()))?));
        paths.push(put(&format!("{}.csv", figure.name), &figure.csv)?);
    }
    paths.insert(0, put("index.html", page::html(&drawn).as_bytes())?);
    commit_all(files, &[])?;
    Ok(paths)
}
