//! The files that commands write. No command writes one in another way.
//!
//! | what is written | type | where, until it is whole |
//! |---|---|---|
//! | a result, which can be computed again | `OutputFile` | a hidden file beside it, which is removed on failure |
//! | a recording of a person | `Recording` | `FILE.partial`, in whole rows, which stays on failure |
//! | a log that others read while it grows | `OutputFile::create_live` | under its own name, in whole rows |
//!
//! - No output replaces an input of the same command ([`Inputs`]), by whatever links it is named.
//! - No output replaces a recording of a person, unless the user says so. Its content tells what it is.
//! - A file gets its name when everything is on the disk, in one step: the earlier one stays until then.
//! - Files that belong together are renamed together (`commit_all`); the last one may have the hashes of the others.
//! - A folder has one writer at a time ([`OutputFolder`]).
//!
//! Standard output, devices and pipes are written directly: they have no content that could be lost.

mod identity;
mod recording;
#[cfg(test)]
mod tests;
mod writer;

use std::fs;
use std::io::{self, ErrorKind, Write, stdin, stdout};
use std::path::{Path, PathBuf};

use anyhow::{Result, anyhow, bail};
use tempfile::NamedTempFile;

pub(crate) use recording::{Recording, is_recording};
pub(crate) use writer::{Busy, FileWriter, commit_all};

use crate::scene_file::check_path;
use identity::{is_open_at, is_same_file};
use writer::open_locked;

/// The name for standard output.
const STANDARD_OUTPUT: &str = "-";
/// The file whose lock says that a process writes into its folder.
const LOCK: &str = ".frixel-lock";

/// Converts an error of writing `path`, for use in `map_err`.
pub(crate) fn writing(path: &Path) -> impl FnOnce(io::Error) -> anyhow::Error {
    let advice = check_path(path, "check the folder and its free space");
    move |error| anyhow!("{} cannot be written ({error}): {advice}", path.display())
}

/// Advice for a name that cannot be used.
fn another(option: &str) -> String {
    let name = if option == "--out" { "folder" } else { "name" };
    format!("give another {name} to {option}")
}

/// The files that a command reads, which it does not overwrite. Standard input is always one of them.
#[derive(Clone, Debug, Default)]
pub struct Inputs(Vec<PathBuf>);

impl Inputs {
    /// These files. Names that lead to no file are ignored.
    pub fn new<P: Into<PathBuf>>(paths: impl IntoIterator<Item = P>) -> Self {
        Self(paths.into_iter().map(Into::into).collect())
    }

    /// Rejects an output that would overwrite one of the files.
    pub(crate) fn check(&self, output: &OutputFile) -> Result<()> {
        let another = another(output.option);
        match output.written_paths().iter().find(|path| self.has(path)) {
            Some(path) => bail!("{} is an input as well, and would be overwritten: {another}", path.display()),
            None => Ok(()),
        }
    }

    fn has(&self, path: &Path) -> bool {
        fs::metadata(path).is_ok_and(|metadata| metadata.is_file())
            && (is_open_at(stdin(), path) || self.0.iter().any(|input| is_same_file(input, path)))
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
    pub fn open(path: &Path) -> Result<Self> {
        fs::create_dir_all(path).map_err(writing(path))?;
        match open_locked(path, &path.join(LOCK)) {
            Err(error) if error.is::<Busy>() => {
                bail!("another frixel writes into {}: wait for it, or give another folder to --out", path.display())
            }
            locked => Ok(Self { _lock: locked? }),
        }
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
        if path == Path::new(STANDARD_OUTPUT) || is_open_at(stdout(), path) {
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

/// The file that a name that leads to none would create. A link that leads to none yet is followed.
fn without_links(path: &Path) -> PathBuf {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    if let Ok(target) = fs::read_link(path) {
        return folder.join(target);
    }
    match (folder.canonicalize(), path.file_name()) {
        (Ok(folder), Some(name)) => folder.join(name),
        _ => path.to_owned(),
    }
}

/// A file that is about to be written, where it overwrites no input.
#[derive(Clone, Debug)]
pub(crate) struct OutputFile {
    path: PathBuf,
    option: &'static str,
    place: Place,
}

impl OutputFile {
    /// A result by the name that the user gave to `option`; `-` is standard output. Rejects a name that has a recording
    /// of a person.
    pub(crate) fn new(path: &Path, option: &'static str, inputs: &Inputs) -> Result<Self> {
        let output = Self::replacing(path, option, inputs)?;
        if output.file().is_some_and(is_recording) {
            let another = another(option);
            bail!("{} is a recording of a person, which no result replaces: {another}", path.display());
        }
        Ok(output)
    }

    /// As [`Self::new`], for a file that may replace a recording of a person.
    pub(crate) fn replacing(path: &Path, option: &'static str, inputs: &Inputs) -> Result<Self> {
        let place = Place::of(path).map_err(writing(path))?;
        let output = Self { path: path.to_owned(), option, place };
        inputs.check(&output)?;
        let earlier = output.file().and_then(|file| fs::metadata(file).ok());
        if earlier.is_some_and(|earlier| earlier.permissions().readonly()) {
            bail!("{} is write-protected: {}, or allow writing it", path.display(), another(option));
        }
        Ok(output)
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

    /// Rejects an output that would overwrite another one of the same command.
    pub(crate) fn check_apart_from(&self, other: &Self) -> Result<()> {
        let is_same = |(file, other): (&Path, &Path)| file == other || is_same_file(file, other);
        if self.file().zip(other.file()).is_some_and(is_same) {
            bail!("{} would be written twice: {}", self.path.display(), another(self.option));
        }
        Ok(())
    }

    /// Rejects an output that has a file already.
    pub(crate) fn check_new(&self) -> Result<()> {
        if self.file().is_some_and(Path::exists) {
            let (path, another) = (self.path.display(), another(self.option));
            bail!("{path} is there already, and a recording is not replaced: {another}, or add --overwrite");
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
    pub(crate) fn create(&self) -> Result<FileWriter> {
        match &self.place {
            Place::StandardOutput => Ok(FileWriter::standard_output()),
            Place::Stream => FileWriter::stream(&self.path),
            Place::File(file) => FileWriter::result(&self.path, file, &hidden_beside(file)),
        }
    }

    /// Starts to write a log that others read while it grows. It replaces an earlier file at once, and always has whole
    /// rows.
    pub(crate) fn create_live(&self) -> Result<FileWriter> {
        self.create()?.live()
    }

    /// Writes the whole file.
    pub(crate) fn write(&self, bytes: &[u8]) -> Result<()> {
        self.filled(bytes)?.commit()
    }

    /// As [`Self::write`], before the commit.
    pub(crate) fn filled(&self, bytes: &[u8]) -> Result<FileWriter> {
        let mut writer = self.create()?;
        match writer.write_all(bytes) {
            Err(source) => Err(writer.error(source)),
            Ok(()) => Ok(writer),
        }
    }

    /// Writes the whole file unless there is one already, and returns whether it did.
    pub(crate) fn write_new(&self, bytes: &[u8]) -> Result<bool> {
        if self.file().is_some_and(Path::exists) {
            return Ok(false);
        }
        self.write(bytes).map(|()| true)
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
