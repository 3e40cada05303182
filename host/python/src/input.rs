//! Files that the Python code reads.

use std::path::PathBuf;

use frixel_lab::input::{CSV_MAX_BYTES, TOML_MAX_BYTES, read};
use pyo3::prelude::*;
use pyo3::types::PyBytes;

/// The bytes of a regular file: a table or a recording, or TOML text.
#[pyfunction]
pub(crate) fn read_file(py: Python<'_>, path: PathBuf, is_toml: bool) -> PyResult<Bound<'_, PyBytes>> {
    let max_bytes = if is_toml { TOML_MAX_BYTES } else { CSV_MAX_BYTES };
    Ok(PyBytes::new(py, &py.detach(|| read(&path, max_bytes))?))
}
