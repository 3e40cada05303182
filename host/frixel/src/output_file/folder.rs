//! A folder with one writer.

use std::fs::{self, File};
use std::path::{Path, PathBuf};

use super::OutputFileError;
use super::writer::open_locked;

/// The file whose lock says that a process writes into its folder.
const LOCK: &str = ".frixel-lock";

/// A folder into which this process alone writes, until the value is dropped or the process ends.
#[derive(Debug)]
pub struct OutputFolder {
    lock: PathBuf,
    /// Locked while it is open.
    _file: File,
}

impl OutputFolder {
    /// Creates the folder if necessary, and locks it.
    pub fn open(path: &Path) -> Result<Self, OutputFileError> {
        fs::create_dir_all(path).map_err(|source| OutputFileError::write(path, source))?;
        let lock = path.join(LOCK);
        match open_locked(path, &lock) {
            Ok(file) => Ok(Self { lock, _file: file }),
            Err(OutputFileError::Busy { path }) => Err(OutputFileError::FolderBusy { path }),
            Err(error) => Err(error),
        }
    }
}

impl Drop for OutputFolder {
    fn drop(&mut self) {
        // Without the file, the next process makes one.
        let _ = fs::remove_file(&self.lock);
    }
}
