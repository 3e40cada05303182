//! Places of outputs.

use std::fs::{self, File};
use std::io::{self, ErrorKind, stdout};
use std::path::{Path, PathBuf};
use std::thread;
use std::time::Duration;

use frixel_lab::input::read;

use crate::identity::{is_open_at, is_same_file};
use crate::writer::{NewFile, Sink};
use crate::{Error, FileWriter, Inputs, is_of_person, writing};

/// Time between tries to open a file that another process has.
const BUSY_PERIOD: Duration = Duration::from_millis(10);

/// Whether a name is that of standard output: `-`, or one of the file or device that it was opened as.
fn is_standard_output(path: &Path) -> bool {
    path == Path::new("-") || is_open_at(stdout(), path)
}

/// Path of the file that a name refers to, or would create, without symbolic links. None for a device, a pipe, or a
/// file that this process was started with: no other file can take its name.
fn file_at(path: &Path) -> io::Result<Option<PathBuf>> {
    if is_standard_output(path) || path.starts_with("/dev/fd") || path.starts_with("/proc") {
        return Ok(None);
    }
    match fs::metadata(path) {
        Ok(metadata) if metadata.is_dir() => Err(ErrorKind::IsADirectory.into()),
        Ok(metadata) if metadata.is_file() => path.canonicalize().map(Some),
        Ok(_) => Ok(None),
        // Creating the file or its folder reports what is missing.
        Err(error) if matches!(error.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) => {
            Ok(Some(without_links(path)))
        }
        Err(error) => Err(error),
    }
}

/// The file that an unused name would create. A dangling link is followed.
fn without_links(path: &Path) -> PathBuf {
    let file = fs::read_link(path).map_or_else(|_| path.to_owned(), |target| folder_of(path).join(target));
    match (folder_of(&file).canonicalize(), file.file_name()) {
        (Ok(folder), Some(name)) => folder.join(name),
        _ => file,
    }
}

/// The folder of a file.
pub(crate) fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// A file that is about to be written, where it overwrites no input.
#[derive(Clone, Debug)]
pub struct OutputFile {
    path: PathBuf,
    option: &'static str,
    /// Where the file is; none for a stream.
    pub(crate) file: Option<PathBuf>,
    /// Whether it replaces a recording of a person.
    pub(crate) overwrites: bool,
}

impl OutputFile {
    /// A result by the name that the user gave to `option`; `-` is standard output. Rejects a name that has a recording
    /// of a person.
    pub fn new(path: &Path, option: &'static str, inputs: &Inputs) -> Result<Self, Error> {
        Self::replacing(path, option, inputs, false)
    }

    /// Like [`Self::new`], but replaces a recording of a person if it `overwrites`.
    pub fn replacing(path: &Path, option: &'static str, inputs: &Inputs, overwrites: bool) -> Result<Self, Error> {
        let output = Self::at(path, option, inputs, overwrites)?;
        if !overwrites && output.file.as_deref().is_some_and(is_of_person) {
            return Err(Error::OfPerson(output.path, option));
        }
        Ok(output)
    }

    /// A recording of a person, which replaces a file only if it `overwrites`.
    pub fn recording(path: &Path, option: &'static str, inputs: &Inputs, overwrites: bool) -> Result<Self, Error> {
        let output = Self::at(path, option, inputs, overwrites)?;
        output.check_new()?;
        Ok(output)
    }

    fn at(path: &Path, option: &'static str, inputs: &Inputs, overwrites: bool) -> Result<Self, Error> {
        let file = file_at(path).map_err(writing(path))?;
        let output = Self { path: path.to_owned(), option, file, overwrites };
        output.check_inputs(inputs)?;
        let earlier = output.file.as_ref().and_then(|file| fs::metadata(file).ok());
        if earlier.is_some_and(|earlier| earlier.permissions().readonly()) {
            return Err(Error::Protected(output.path, option));
        }
        Ok(output)
    }

    /// Rejects an output that would overwrite an input.
    pub fn check_inputs(&self, inputs: &Inputs) -> Result<(), Error> {
        let beside = self.file.iter().flat_map(|file| [hidden_beside(file), partial_beside(file)]);
        match [self.path.clone()].into_iter().chain(beside).find(|path| inputs.has(path)) {
            Some(input) => Err(Error::Input(input, self.option)),
            None => Ok(()),
        }
    }

    /// Rejects an output that would overwrite another one of the same command.
    pub fn check_apart_from(&self, other: &Self) -> Result<(), Error> {
        let is_same = |(file, other): (&Path, &Path)| file == other || is_same_file(file, other);
        if self.file.as_deref().zip(other.file.as_deref()).is_some_and(is_same) {
            return Err(Error::Twice(self.path.clone(), self.option));
        }
        Ok(())
    }

    /// Rejects a recording that would replace a file, unless it overwrites.
    pub fn check_new(&self) -> Result<(), Error> {
        if !self.overwrites && self.file.as_deref().is_some_and(Path::exists) {
            return Err(Error::Exists(self.path.clone(), self.option));
        }
        Ok(())
    }

    /// The path, as the user gave it.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Whether the output goes to standard output, which then must not carry messages for people.
    pub fn is_standard_output(&self) -> bool {
        is_standard_output(&self.path)
    }

    /// Whether the output is a file, beside which other files can be written.
    pub fn is_file(&self) -> bool {
        self.file.is_some()
    }

    /// Starts to write the file. The earlier file stays intact until [`FileWriter::commit`].
    pub fn create(&self) -> Result<FileWriter, Error> {
        let sink = match &self.file {
            Some(file) => Sink::File(NewFile::open(&self.path, file, &hidden_beside(file))?),
            None if self.is_standard_output() => Sink::StandardOutput,
            None => Sink::Stream(File::options().append(true).open(&self.path).map_err(writing(&self.path))?),
        };
        Ok(FileWriter::new(&self.path, sink))
    }

    /// Starts to write a log that others read while it grows. It replaces an earlier file at once, and only ever has
    /// complete rows.
    pub fn create_live(&self) -> Result<FileWriter, Error> {
        self.create()?.live()
    }

    /// Opens a file of lines for appending, and calls `each` with every line in it. Waits while another process
    /// appends, after one call of `waits`. Removes the partial last line that a killed process left.
    pub fn append(&self, each: impl FnMut(&[u8]), waits: impl FnOnce()) -> Result<FileWriter, Error> {
        let Some(file) = &self.file else { return self.create() };
        let mut lines = when_free(|| NewFile::open(&self.path, file, file), waits)?;
        lines.stay(each).map_err(writing(&self.path))?;
        Ok(FileWriter::new(&self.path, Sink::File(lines)))
    }

    /// Writes the whole file.
    pub fn write(&self, bytes: &[u8]) -> Result<(), Error> {
        self.filled(bytes)?.commit()
    }

    /// Writes the whole file, which other processes may write at the same moment with the same content.
    pub fn write_shared(&self, bytes: &[u8]) -> Result<(), Error> {
        let is_there = || read(&self.path, bytes.len() as u64).is_ok_and(|there| there == bytes);
        when_free(|| if is_there() { Ok(()) } else { self.write(bytes) }, || ())
    }

    /// Like [`Self::write`], without the commit.
    pub fn filled(&self, bytes: &[u8]) -> Result<FileWriter, Error> {
        let mut writer = self.create()?;
        writer.write_out(bytes).map_err(|error| writer.error(error))?;
        Ok(writer)
    }

    /// Writes the whole file unless there is one already, and returns whether it did.
    pub fn write_new(&self, bytes: &[u8]) -> Result<bool, Error> {
        if self.file.as_deref().is_some_and(Path::exists) {
            return Ok(false);
        }
        self.write(bytes).map(|()| true)
    }
}

/// Tries until no other process has the file. Calls `waits` before the second try.
fn when_free<T>(open: impl Fn() -> Result<T, Error>, waits: impl FnOnce()) -> Result<T, Error> {
    let mut waits = Some(waits);
    loop {
        match open() {
            Err(Error::Busy(_)) => {
                waits.take().into_iter().for_each(|waits| waits());
                thread::sleep(BUSY_PERIOD);
            }
            opened => return opened,
        }
    }
}

/// Path of a result that is not complete.
fn hidden_beside(file: &Path) -> PathBuf {
    let name = file.file_name().unwrap_or_default().to_string_lossy();
    file.with_file_name(format!(".{name}.frixel-tmp"))
}

/// Path of a recording that is not complete.
pub(crate) fn partial_beside(file: &Path) -> PathBuf {
    let mut name = file.file_name().unwrap_or_default().to_owned();
    name.push(".partial");
    file.with_file_name(name)
}
