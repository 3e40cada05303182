//! Output files of the `frixel` command and of the Python module. Files are written by this crate and by no other one
//! of the host; beside `frixel`, it is the only one that uses the operating system for more than reading.
//!
//! | what is written | method | where, until it is whole |
//! |---|---|---|
//! | a result, which can be computed again | [`OutputFile::create`] | a hidden file beside it, removed on failure |
//! | a recording of a person | [`OutputFile::begin_recording`] | `FILE.partial`, in whole rows, kept on failure |
//! | lines to which a later process adds | [`OutputFile::append`] | under its own name, in whole lines |
//! | a log that others read while it grows | [`OutputFile::create_live`] | under its own name, in whole rows |
//!
//! - No output replaces an input of the same command ([`Inputs`]), by whatever links it is named.
//! - No output replaces a recording of a person, unless the user requests it. Recordings are recognised by their
//!   content.
//! - A file gets its name when everything is on the disk, in one step: the earlier one stays until then.
//! - Files that belong together are renamed together ([`commit_all`]); the last one may have the hashes of the others.
//! - A folder has one writer at a time ([`OutputFolder`]).
//!
//! Standard output, devices and pipes are written directly: they have no content that could be lost.
#![forbid(unsafe_code)]

mod error;
mod identity;
mod output_file;
mod recording;
#[cfg(test)]
mod tests;
mod writer;

use std::fs;
use std::io::{self, stdin};
use std::path::{Path, PathBuf};

use frixel_lab::input::{Bounded, open};
use tempfile::NamedTempFile;

pub use error::Error;
pub use output_file::OutputFile;
pub use writer::{FileWriter, commit_all};

use identity::{is_open_at, is_same_file};
use writer::open_locked;

/// The file whose lock shows that a process writes into its folder.
const LOCK: &str = ".frixel-lock";

/// Converts an error of writing `path`, for use in `map_err`.
pub fn writing(path: &Path) -> impl FnOnce(io::Error) -> Error {
    |error| Error::Unwritable(path.to_owned(), error, "check the folder and its free space")
}

/// Creates a folder, and the folders around it, unless it exists.
pub fn create_folder(path: &Path) -> Result<(), Error> {
    fs::create_dir_all(path).map_err(|error| {
        let advice = if path.is_file() { "it is a file: name a folder" } else { "check the folder and its free space" };
        Error::Unwritable(path.to_owned(), error, advice)
    })
}

/// Whether a file is a recording of a person, by its content: see [`frixel_lab::recording::is_of_person`].
pub fn is_of_person(path: &Path) -> bool {
    let file = open(path, u64::MAX).map(Bounded::into_inner);
    file.and_then(frixel_lab::recording::is_of_person).unwrap_or(false)
}

/// The files that a command reads, which it does not overwrite. Standard input is always one of them.
#[derive(Clone, Debug, Default)]
pub struct Inputs(Vec<PathBuf>);

impl Inputs {
    /// These files. Names that lead to no file are ignored.
    pub fn new<P: Into<PathBuf>>(paths: impl IntoIterator<Item = P>) -> Self {
        Self(paths.into_iter().map(Into::into).collect())
    }

    fn has(&self, path: &Path) -> bool {
        path.is_file() && (is_open_at(stdin(), path) || self.0.iter().any(|input| is_same_file(input, path)))
    }
}

/// A folder into which this process alone writes, until the value is dropped or the process ends.
#[derive(Debug)]
pub struct OutputFolder {
    /// Locked while it is open, and removed then.
    _lock: NamedTempFile,
}

impl OutputFolder {
    /// Creates the folder if necessary, and locks it.
    pub fn open(path: &Path) -> Result<Self, Error> {
        create_folder(path)?;
        Ok(Self { _lock: open_locked(path, &path.join(LOCK))? })
    }
}
