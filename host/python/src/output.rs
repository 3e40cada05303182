//! Files that the Python code writes.

use std::path::{Path, PathBuf};

use frixel_files::{Error, Inputs, OutputFile, commit_all};
use pyo3::prelude::*;
use pyo3::pybacked::PyBackedBytes;
use pyo3::types::PyDict;

use super::error::raised;

/// Name of the argument in messages.
const OPTION: &str = "the file";

/// Writes files that belong together, the bytes of each by its path: all or none. Replaces a recording of a person only
/// with `overwrite`.
#[pyfunction]
pub(crate) fn write_files(py: Python<'_>, files: Bound<'_, PyDict>, overwrite: bool) -> PyResult<()> {
    let mut given: Vec<(PathBuf, PyBackedBytes)> = Vec::new();
    for (path, bytes) in files {
        // `-` is a file here, not standard output.
        given.push((Path::new(".").join(path.extract::<PathBuf>()?), bytes.extract()?));
    }
    let written = py.detach(|| {
        let filled = given
            .iter()
            .map(|(path, bytes)| OutputFile::replacing(path, OPTION, &Inputs::default(), overwrite)?.filled(bytes));
        commit_all(filled.collect::<Result<_, _>>()?, &[])
    });
    written.map_err(|error| {
        let sentence = match error {
            Error::OfPerson(path, _) => format!(
                "{} is a recording of a person: give another name, or `overwrite=True` to replace it",
                path.display()
            ),
            error => error.to_string(),
        };
        raised(py, "FrixelError", (sentence,))
    })
}
