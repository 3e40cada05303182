//! Files that the Python code reads.

use std::path::PathBuf;

use frixel_lab::input::{CSV_MAX_BYTES, read, read_toml};
use pyo3::prelude::*;
use pyo3::types::PyBytes;

/// The bytes of a regular file: a table or a recording, or TOML text.
#[pyfunction]
pub(crate) fn read_file(py: Python<'_>, path: PathBuf, is_toml: bool) -> PyResult<Bound<'_, PyBytes>> {
    let bytes = py.detach(|| if is_toml { read_toml(&path) } else { read(&path, CSV_MAX_BYTES) });
    Ok(PyBytes::new(py, &bytes?))
}
