//! The report of `frixel report`: the paper's figures from the model, what the model's error and its
//! inversion cost, and what a scene costs a board and the line.
//!
//! [`write()`] puts an `index.html` that needs nothing else into a folder, and beside it the numbers behind each
//! picture as CSV.

mod counts;
mod data;
mod error;
mod figures;
mod methods;
mod page;
mod reference;
mod wire;

use std::fs;
use std::path::{Path, PathBuf};

pub use error::ReportError;

use counts::Counts;

/// Writes the report into a folder, which is made when it is not there, and returns the files in it.
///
/// `bench` is a file of instruction counts as `cargo xtask bench` writes it, for charts of what an inversion and a tick
/// take. Run times are measured; all else is the same in every run.
pub fn write(folder: &Path, bench: Option<&Path>) -> Result<Vec<PathBuf>, ReportError> {
    let counts = bench.map(Counts::read).transpose()?;
    fs::create_dir_all(folder).map_err(|source| ReportError::Write { path: folder.to_owned(), source })?;
    let figures = figures::all(counts.as_ref())?;
    let mut files = Vec::new();
    let mut drawn = Vec::new();
    for figure in &figures {
        let drawing = |reason: String| ReportError::Drawing { name: figure.name, reason };
        drawn.push((figure, figure.chart.svg().map_err(|error| drawing(error.to_string()))?));
        files.push(put(folder, &format!("{}.csv", figure.name), &figure.csv)?);
    }
    files.insert(0, put(folder, "index.html", page::html(&drawn).as_bytes())?);
    Ok(files)
}

fn put(folder: &Path, name: &str, bytes: &[u8]) -> Result<PathBuf, ReportError> {
    let path = folder.join(name);
    match fs::write(&path, bytes) {
        Ok(()) => Ok(path),
        Err(source) => Err(ReportError::Write { path, source }),
    }
}
