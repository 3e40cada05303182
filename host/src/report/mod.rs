//! The report of `frixel report`: the paper's figures from the model, and what the model's error and its inversion cost.
//!
//! [`write`] puts an `index.html` that needs nothing else into a folder, and beside it the numbers behind each picture as
//! CSV.

mod chart;
mod data;
mod error;
mod figures;
mod page;

use std::fs;
use std::path::{Path, PathBuf};

pub use error::ReportError;

/// Writes the report into a folder, which is made when it is not there, and returns the files in it.
pub fn write(folder: &Path) -> Result<Vec<PathBuf>, ReportError> {
    fs::create_dir_all(folder).map_err(|source| ReportError::Write { path: folder.to_owned(), source })?;
    let figures = figures::all()?;
    let mut files = Vec::new();
    let mut drawn = Vec::new();
    for figure in &figures {
        let drawing = |reason: String| ReportError::Drawing { name: figure.name, reason };
        drawn.push((figure, figure.chart.svg().map_err(|error| drawing(error.to_string()))?));
        let csv = figure.data.csv().map_err(|error| drawing(error.to_string()))?;
        files.push(put(folder, &format!("{}.csv", figure.name), &csv)?);
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
