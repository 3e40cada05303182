//! The one reader of files of this module: regular ones, of at most a stated size.

use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use pyo3::prelude::*;
use pyo3::types::PyBytes;

/// Largest file that is read: that of the command for tables and recordings.
const FILE_MAX_BYTES: u64 = 512 << 20;

/// The bytes of a regular file.
pub(crate) fn read(path: &Path) -> io::Result<Vec<u8>> {
    let metadata = fs::metadata(path)?;
    // Others may have no end, and the opening of a pipe waits for its writer. Reading a folder is an error already.
    if !metadata.is_file() && !metadata.is_dir() {
        return Err(io::Error::other("it is a pipe, a socket or a device, and a regular file is expected"));
    }
    let mut bytes = Vec::new();
    // A file that grows meanwhile is read up to one byte more than it can have.
    if metadata.len() <= FILE_MAX_BYTES {
        File::open(path)?.take(FILE_MAX_BYTES + 1).read_to_end(&mut bytes)?;
    }
    if metadata.len().max(bytes.len() as u64) > FILE_MAX_BYTES {
        return Err(io::Error::other(format!("it has more than {FILE_MAX_BYTES} bytes, the most that are read")));
    }
    Ok(bytes)
}

/// The bytes of a regular file, for the Python files.
#[pyfunction]
pub(crate) fn read_file(py: Python<'_>, path: PathBuf) -> PyResult<Bound<'_, PyBytes>> {
    Ok(PyBytes::new(py, &py.detach(|| read(&path))?))
}
