//! Why a file is not written.

use std::io;
use std::path::{Path, PathBuf};

use thiserror::Error;

use crate::scene_file::check_path;

/// Why a file is not written. What was there before is there still.
#[derive(Debug, Error)]
pub enum OutputFileError {
    /// The command reads the file.
    #[error("{} is an input as well, and would be overwritten: {}", .path.display(), another(.option))]
    Input {
        /// Path of the file.
        path: PathBuf,
        /// The option that names it.
        option: &'static str,
    },
    /// Two outputs are one file.
    #[error("{} would be written twice: {}", .path.display(), another(.option))]
    Twice {
        /// Path of the file.
        path: PathBuf,
        /// The option that names it.
        option: &'static str,
    },
    /// A recording is there already.
    #[error("{} is there already, and a recording is not replaced: {}, or add --overwrite", .path.display(), another(.option))]
    Exists {
        /// Path of the file.
        path: PathBuf,
        /// The option that names it.
        option: &'static str,
    },
    /// A result would replace a recording of a person.
    #[error("{} is a recording of a person, which no result replaces: {}", .path.display(), another(.option))]
    OverRecording {
        /// Path of the file.
        path: PathBuf,
        /// The option that names it.
        option: &'static str,
    },
    /// A folder has what a person's finger did on a board.
    #[error(
        "{} has what a finger did on a board, which no other play replaces: {}, or add --overwrite", .path.display(),
        another(.option)
    )]
    OverPlay {
        /// Path of the file.
        path: PathBuf,
        /// The option that names its folder.
        option: &'static str,
    },
    /// An earlier recording was cut off.
    #[error("{} has the rows of a recording that was cut off: {advice}, or record anew with --overwrite", .partial.display())]
    CutOff {
        /// Path of the unfinished file.
        partial: PathBuf,
        /// How to keep the rows.
        advice: &'static str,
    },
    /// Another program's file has the name of an unfinished recording.
    #[error("{} is in the way, and no recording left it: rename it, or record with --overwrite", .partial.display())]
    Foreign {
        /// Path of the file.
        partial: PathBuf,
    },
    /// There is nothing to finish.
    #[error("there is no {} with rows of a recording that was cut off: leave --finish out", .partial.display())]
    NothingCutOff {
        /// Path of the unfinished file.
        partial: PathBuf,
    },
    /// The file may not be written.
    #[error("{} is write-protected: {}, or allow writing it", .path.display(), another(.option))]
    Protected {
        /// Path of the file.
        path: PathBuf,
        /// The option that names it.
        option: &'static str,
    },
    /// Another process writes the file.
    #[error("{} is being written by another frixel: wait for it, or give another name", .path.display())]
    Busy {
        /// Path of the file.
        path: PathBuf,
    },
    /// Another process writes into the folder.
    #[error("another frixel writes into {}: wait for it, or give another folder to --out", .path.display())]
    FolderBusy {
        /// Path of the folder.
        path: PathBuf,
    },
    /// The operating system could not write the file.
    #[error(
        "{} cannot be written ({source}): {}", .path.display(), check_path(.path, "check the folder and its free space")
    )]
    Write {
        /// Path of the file or folder.
        path: PathBuf,
        /// Error of the operating system.
        source: io::Error,
    },
    /// The operating system could not write the whole file.
    #[error(
        "{} cannot be written to its end ({source}): no cut file is left; check the free space of its folder",
        .path.display()
    )]
    Cut {
        /// Path of the file.
        path: PathBuf,
        /// Error of the operating system.
        source: io::Error,
    },
    /// The operating system could not write all rows of a file that keeps its rows.
    #[error(
        "{} cannot be written any further ({source}), and has the rows until then: check the free space of its folder",
        .path.display()
    )]
    Rows {
        /// Path of the file.
        path: PathBuf,
        /// Error of the operating system.
        source: io::Error,
    },
    /// The whole file could not get its name.
    #[error(
        "{} cannot be replaced ({source}); the new one is whole, in {}: close the program that has the old one open, \
         and rename the new one", .path.display(), .written.display()
    )]
    Rename {
        /// Path of the file.
        path: PathBuf,
        /// Path of the whole file under its other name.
        written: PathBuf,
        /// Error of the operating system.
        source: io::Error,
    },
}

impl OutputFileError {
    pub(super) fn write(path: &Path, source: io::Error) -> Self {
        Self::Write { path: path.to_owned(), source }
    }
}

/// What to do about a name that cannot be used.
fn another(option: &str) -> String {
    match option {
        "--out" => "give another folder to --out".to_owned(),
        option => format!("give another name to {option}"),
    }
}
