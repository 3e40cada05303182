//! The one reader of files of this module: regular ones, of at most a stated size.

use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use frixel_lab::input::{Bounded, CSV_MAX_BYTES, InputError};
use pyo3::prelude::*;
use pyo3::types::PyBytes;

/// The bytes of a regular file, of at most as many as a table or a recording has.
pub(crate) fn read(path: &Path) -> io::Result<Vec<u8>> {
    read_at_most(path, CSV_MAX_BYTES)
}

/// The bytes of a regular file, of at most so many.
pub(crate) fn read_at_most(path: &Path, max_bytes: u64) -> io::Result<Vec<u8>> {
    let metadata = fs::metadata(path)?;
    // Others may have no end, and the opening of a pipe waits for its writer. Reading a folder is an error already.
    if !metadata.is_file() && !metadata.is_dir() {
        return Err(InputError::NotAFile { what: "pipe, a socket or a device" }.into());
    }
    let mut bytes = Vec::new();
    Bounded::of_file(File::open(path)?, metadata.len(), max_bytes)?.read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// The bytes of a regular file, for the Python files.
#[pyfunction]
pub(crate) fn read_file(py: Python<'_>, path: PathBuf) -> PyResult<Bound<'_, PyBytes>> {
    Ok(PyBytes::new(py, &py.detach(|| read(&path))?))
}
