//! The files that commands write. No command writes one in another way.
//!
//! | what is written | type | where, until it is whole |
//! |---|---|---|
//! | a result, which can be computed again | `OutputFile` | a hidden file beside it, which is removed on failure |
//! | a recording of a person | `Recording` | `FILE.partial`, in whole rows, which stays on failure |
//! | a log that others read while it grows | `OutputFile::create_live` | under its own name, in whole rows |
//!
//! - No output replaces an input of the same command ([`Inputs`]), by whatever links it is named.
//! - No output replaces a recording of a person, unless the user says so.
//! - A file has its name only when it is whole: it is renamed when everything is on the disk.
//! - Files that belong together are renamed together (`commit_all`), so that none of an earlier run stands beside one
//!   of a later run.
//! - A folder has one writer at a time ([`OutputFolder`]).
//!
//! Standard output, devices and pipes are written directly: they have no content that could be lost.

mod error;
mod folder;
mod identity;
mod recording;
mod writer;

use std::fs;
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};

pub use error::OutputFileError;
pub use folder::OutputFolder;
pub(crate) use recording::{Recording, is_play_of_person, is_recording};
pub(crate) use writer::{FileWriter, commit_all};

use identity::{is_same_file, is_standard_input, is_standard_output};

/// The name for standard output.
const STANDARD_OUTPUT: &str = "-";
/// Longest chain of symbolic links that is followed, as on Linux.
const LINKS_MAX: usize = 40;

/// The files that a command reads, which it does not overwrite. Standard input is always one of them.
#[derive(Clone, Debug, Default)]
pub struct Inputs(Vec<PathBuf>);

impl Inputs {
    /// These files. Names that lead to no file are ignored.
    pub fn new<P: Into<PathBuf>>(paths: impl IntoIterator<Item = P>) -> Self {
        Self(paths.into_iter().map(Into::into).collect())
    }

    /// Rejects an output that would overwrite one of the files.
    pub(crate) fn check(&self, output: &OutputFile) -> Result<(), OutputFileError> {
        match output.written_paths().iter().find(|path| self.has(path)) {
            Some(path) => Err(OutputFileError::Input { path: path.clone(), option: output.option }),
            None => Ok(()),
        }
    }

    fn has(&self, path: &Path) -> bool {
        fs::metadata(path).is_ok_and(|metadata| metadata.is_file())
            && (is_standard_input(path) || self.0.iter().any(|input| is_same_file(input, path)))
    }
}

/// The place of an output.
#[derive(Clone, Debug)]
enum Place {
    StandardOutput,
    /// A device, a pipe, or a file that this process was started with: no other file can take its name.
    Stream,
    /// A file, or none yet, by its path without symbolic links.
    File(PathBuf),
}

impl Place {
    fn of(path: &Path) -> io::Result<Self> {
        if path == Path::new(STANDARD_OUTPUT) || is_standard_output(path) {
            return Ok(Self::StandardOutput);
        }
        let is_open_file = path.starts_with("/dev/fd") || path.starts_with("/proc");
        match fs::metadata(path) {
            Ok(metadata) if metadata.is_dir() => Err(ErrorKind::IsADirectory.into()),
            Ok(metadata) if metadata.is_file() && !is_open_file => Ok(Self::File(path.canonicalize()?)),
            Ok(_) => Ok(Self::Stream),
            // Whoever creates the file or its folder says what is missing.
            Err(error) if matches!(error.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) => {
                Ok(Self::File(without_links(path)))
            }
            Err(error) => Err(error),
        }
    }
}

/// The file that a name that leads to none would create.
fn without_links(path: &Path) -> PathBuf {
    let mut path = path.to_owned();
    for _ in 0..LINKS_MAX {
        let Ok(target) = fs::read_link(&path) else { break };
        path = path.parent().unwrap_or(Path::new("")).join(target);
    }
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    match (folder.canonicalize(), path.file_name()) {
        (Ok(folder), Some(name)) => folder.join(name),
        _ => path,
    }
}

/// A result that is about to be written, where it overwrites no input and no recording of a person.
#[derive(Clone, Debug)]
pub(crate) struct OutputFile {
    path: PathBuf,
    option: &'static str,
    place: Place,
}

impl OutputFile {
    /// A file by the name that the user gave to `option`; `-` is standard output.
    pub(crate) fn new(path: &Path, option: &'static str, inputs: &Inputs) -> Result<Self, OutputFileError> {
        let output = Self::of_person(path, option, inputs)?;
        match &output.place {
            Place::File(file) if is_recording(file) => {
                Err(OutputFileError::OverRecording { path: output.path.clone(), option })
            }
            _ => Ok(output),
        }
    }

    /// As [`Self::new`], for a file that may replace a recording of a person.
    fn of_person(path: &Path, option: &'static str, inputs: &Inputs) -> Result<Self, OutputFileError> {
        let place = Place::of(path).map_err(|source| OutputFileError::write(path, source))?;
        let output = Self { path: path.to_owned(), option, place };
        inputs.check(&output)?;
        match &output.place {
            Place::File(file) if fs::metadata(file).is_ok_and(|metadata| metadata.permissions().readonly()) => {
                Err(OutputFileError::Protected { path: output.path.clone(), option })
            }
            _ => Ok(output),
        }
    }

    /// The path, as the user gave it.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Whether the output goes to standard output, where no messages for people belong then.
    pub(crate) fn is_standard_output(&self) -> bool {
        matches!(self.place, Place::StandardOutput)
    }

    /// Whether the output has a name that other files can stand beside.
    pub(crate) fn is_file(&self) -> bool {
        self.file().is_some()
    }

    /// Whether there is a file already.
    pub(crate) fn exists(&self) -> bool {
        self.file().is_some_and(Path::exists)
    }

    /// Rejects an output that would overwrite another one of the same command.
    pub(crate) fn check_apart_from(&self, other: &Self) -> Result<(), OutputFileError> {
        let is_same = match (&self.place, &other.place) {
            (Place::File(file), Place::File(other)) => file == other || is_same_file(file, other),
            _ => false,
        };
        if is_same {
            return Err(OutputFileError::Twice { path: self.path.clone(), option: self.option });
        }
        Ok(())
    }

    /// The file, unless the output is a stream.
    fn file(&self) -> Option<&Path> {
        match &self.place {
            Place::File(file) => Some(file),
            _ => None,
        }
    }

    /// Every path that writing this output may change.
    fn written_paths(&self) -> Vec<PathBuf> {
        match &self.place {
            Place::StandardOutput => Vec::new(),
            Place::Stream => vec![self.path.clone()],
            Place::File(file) => vec![self.path.clone(), hidden_beside(file), partial_beside(file)],
        }
    }

    /// Starts to write the file. It is whole, or as it was before, until [`FileWriter::commit`].
    pub(crate) fn create(&self) -> Result<FileWriter, OutputFileError> {
        match &self.place {
            Place::StandardOutput => Ok(FileWriter::standard_output()),
            Place::Stream => FileWriter::stream(&self.path),
            Place::File(file) => FileWriter::result(&self.path, file, &hidden_beside(file)),
        }
    }

    /// Starts to write a log that others read while it grows. It replaces an earlier file at once, and always has whole
    /// rows.
    pub(crate) fn create_live(&self) -> Result<FileWriter, OutputFileError> {
        match &self.place {
            Place::File(file) => FileWriter::live(&self.path, file),
            _ => self.create(),
        }
    }

    /// Writes the whole file.
    pub(crate) fn write(&self, bytes: &[u8]) -> Result<(), OutputFileError> {
        self.filled(bytes)?.commit()
    }

    /// As [`Self::write`], before the commit.
    pub(crate) fn filled(&self, bytes: &[u8]) -> Result<FileWriter, OutputFileError> {
        let mut writer = self.create()?;
        match writer.write_all(bytes) {
            Err(source) => Err(writer.error(source)),
            Ok(()) => Ok(writer),
        }
    }

    /// Writes the whole file unless there is one already, and returns whether it did.
    pub(crate) fn write_new(&self, bytes: &[u8]) -> Result<bool, OutputFileError> {
        if self.exists() {
            return Ok(false);
        }
        let mut writer = self.filled(bytes)?;
        writer.keep_earlier();
        writer.commit().map(|()| true)
    }
}

/// Where a result is written until it is whole.
fn hidden_beside(file: &Path) -> PathBuf {
    let name = file.file_name().unwrap_or_default().to_string_lossy();
    file.with_file_name(format!(".{name}.frixel-tmp"))
}

/// Where a recording is written until it is whole.
fn partial_beside(file: &Path) -> PathBuf {
    let mut name = file.file_name().unwrap_or_default().to_owned();
    name.push(".partial");
    file.with_file_name(name)
}
