//! Why a file is not written.

use std::io;
use std::path::PathBuf;

use frixel_lab::input::check_path;
use thiserror::Error;

/// Why a file is not written. Paths are as the user gave them, and texts are options, except where another meaning is
/// stated.
#[derive(Debug, Error)]
pub enum Error {
    /// The operating system does not write it. The text is advice.
    #[error("{0} cannot be written ({1}): {advice}", advice = check_path(.0, .2))]
    Unwritable(PathBuf, io::Error, &'static str),
    /// Standard output is not written.
    #[error("standard output cannot be written ({0}): keep its reader running, or give a file")]
    StandardOutput(io::Error),
    /// The file is whole, under the last path, but does not get its name.
    #[error(
        "{0} cannot be replaced ({1}); the complete new file is {2}: close the program that has the old one open, then \
         rename the new one"
    )]
    Unnamed(PathBuf, io::Error, PathBuf),
    /// Another process writes the file, or into the folder.
    #[error("another frixel writes to {0}: wait for it, or give another name")]
    Busy(PathBuf),
    /// The output is an input of the command as well.
    #[error("{0} is an input as well, and would be overwritten: {advice}", advice = another(.1))]
    Input(PathBuf, &'static str),
    /// Another output of the command is the same file.
    #[error("{0} would be written twice: {advice}", advice = another(.1))]
    Twice(PathBuf, &'static str),
    /// The file is write-protected.
    #[error("{0} is write-protected: {advice}, or make it writable", advice = another(.1))]
    Protected(PathBuf, &'static str),
    /// A result would replace a recording of a person.
    #[error("{0} is a recording of a person, and results do not overwrite it: {advice}", advice = another(.1))]
    OfPerson(PathBuf, &'static str),
    /// A recording would replace a file.
    #[error("{0} already exists, and recordings are not overwritten: {new}, or add --overwrite", new = another(.1))]
    Exists(PathBuf, &'static str),
    /// A recording that was cut off has left its rows. The text is advice on how to keep them.
    #[error("{0} has the rows of a recording that was cut off: {1}, or record again with --overwrite")]
    CutOff(PathBuf, &'static str),
    /// A file that no recording has left is where the rows would be.
    #[error("{0} is in the way, and is not from a recording that was cut off: rename it, or record with --overwrite")]
    InTheWay(PathBuf),
    /// There is no recording to finish.
    #[error("no recording was cut off, since {0} does not exist: leave --finish out")]
    NoRows(PathBuf),
}

/// Advice for a name that cannot be used.
fn another(option: &str) -> String {
    let name = if option == "--out" { "folder" } else { "name" };
    format!("give another {name} to {option}")
}
