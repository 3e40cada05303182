//! Writing of a file that has its name only when it is whole.

use std::fs::{self, File, TryLockError};
use std::io::{self, ErrorKind, Read, Seek, SeekFrom, Write, stdout};
use std::mem;
use std::path::{Path, PathBuf};

use anyhow::{Result, anyhow};
use frixel_lab::hash::hex;
use sha2::{Digest, Sha256};
use tempfile::{NamedTempFile, PersistError, TempPath};
use thiserror::Error;

use super::identity::is_open_at;
use super::{OutputFile, writing};
use crate::input::{Bounded, CSV_MAX_BYTES};

/// Bytes that are collected before they are written, in whole lines.
const CHUNK: usize = 64 * 1024;
/// The first bytes of a Parquet file.
pub(super) const PARQUET: &[u8] = b"PAR1";

/// Another process writes the file.
#[derive(Debug, Error)]
#[error("{} is being written by another frixel: wait for it, or give another name", .0.display())]
pub(crate) struct Busy(PathBuf);

/// A file that is being written. It has its name after [`Self::commit`]; dropped before, a result is as it was, and a
/// recording is left as `FILE.partial` if it has a row.
#[derive(Debug)]
pub(crate) struct FileWriter {
    path: PathBuf,
    sink: Sink,
    /// Bytes that are not written yet.
    pending: Vec<u8>,
    hash: Sha256,
}

#[derive(Debug)]
enum Sink {
    StandardOutput,
    Stream(File),
    File(NewFile),
    Committed,
}

#[derive(Debug)]
struct NewFile {
    file: NamedTempFile,
    destination: PathBuf,
    /// Whether rows stay if there is no commit.
    keeps_rows: bool,
    /// Whether no file has the name: one that comes meanwhile keeps it.
    is_new: bool,
    /// Length of the whole rows in the file, bytes.
    len: u64,
    has_rows: bool,
    /// Why bytes are missing at the end. Nothing is written behind a gap.
    failed: Option<ErrorKind>,
}

impl FileWriter {
    fn new(path: &Path, sink: Sink) -> Self {
        Self { path: path.to_owned(), sink, pending: Vec::new(), hash: Sha256::new() }
    }

    pub(super) fn standard_output() -> Self {
        Self::new("standard output".as_ref(), Sink::StandardOutput)
    }

    pub(super) fn stream(path: &Path) -> Result<Self> {
        let file = File::options().append(true).open(path).map_err(writing(path))?;
        Ok(Self::new(path, Sink::Stream(file)))
    }

    pub(super) fn result(path: &Path, destination: &Path, written: &Path) -> Result<Self> {
        let file = open_locked(path, written)?;
        // A process that was killed may have left it.
        file.as_file().set_len(0).map_err(writing(path))?;
        Ok(Self::new(path, Sink::File(NewFile::new(file, destination))))
    }

    /// Gives the file its name already, while it has nothing.
    pub(super) fn live(mut self) -> Result<Self> {
        if let Sink::File(mut new) = mem::replace(&mut self.sink, Sink::Committed) {
            let file = new.file.persist(&new.destination).map_err(|failed| writing(&self.path)(failed.error))?;
            let name = TempPath::try_from_path(&new.destination).map_err(writing(&self.path))?;
            new.file = NamedTempFile::from_parts(file, name);
            new.file.disable_cleanup(true);
            self.sink = Sink::File(NewFile { keeps_rows: true, ..new });
        }
        Ok(self)
    }

    /// A recording, and the whole rows of the file that an earlier one has left, which stays until this one has a row.
    pub(super) fn recording(path: &Path, destination: &Path, written: &Path) -> Result<(Self, Option<String>)> {
        let mut file = open_locked(path, written)?;
        let mut bytes = Vec::new();
        let len = file.as_file().metadata().map_err(writing(written))?.len();
        file.disable_cleanup(len > 0);
        let bounded = Bounded::of_file(file.as_file_mut(), len, CSV_MAX_BYTES).map_err(io::Error::from);
        bounded.and_then(|mut file| file.read_to_end(&mut bytes)).map_err(writing(written))?;
        if !bytes.starts_with(PARQUET) {
            // A process that was killed may have left a part of a row.
            bytes.truncate(bytes.iter().rposition(|byte| *byte == b'\n').map_or(0, |end| end + 1));
        }
        let new = NewFile { keeps_rows: true, ..NewFile::new(file, destination) };
        let earlier = (len > 0).then(|| String::from_utf8_lossy(&bytes).into_owned());
        Ok((Self::new(path, Sink::File(new)), earlier))
    }

    /// Continues after `rows`, which [`Self::recording`] returned.
    pub(super) fn go_on(&mut self, rows: &str) -> Result<()> {
        let Sink::File(new) = &mut self.sink else { return Ok(()) };
        (new.len, new.has_rows) = (rows.len() as u64, true);
        new.cut().map_err(|source| self.error(source))
    }

    /// The path, as the user gave it.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Writes what is pending, and gives the file its name.
    pub(crate) fn commit(mut self) -> Result<()> {
        self.complete()?;
        self.rename()
    }

    /// Writes what is pending, and returns the SHA-256 of all that this process has written.
    pub(crate) fn sha256(&mut self) -> Result<String> {
        self.flush().map_err(|source| self.error(source))?;
        Ok(hex(&self.hash.clone().finalize()))
    }

    /// The error of this file for one of the operating system.
    pub(crate) fn error(&self, error: io::Error) -> anyhow::Error {
        match &self.sink {
            Sink::File(new) if new.keeps_rows && new.has_rows => anyhow!(
                "{} cannot be written any further ({error}), and has the rows until then: check the free space of its \
                 folder",
                new.file.path().display()
            ),
            Sink::File(_) => anyhow!(
                "{} cannot be written to its end ({error}): no cut file is left; check the free space of its folder",
                self.path.display()
            ),
            _ => writing(&self.path)(error),
        }
    }

    /// Writes what is pending, and waits until the disk has everything.
    fn complete(&mut self) -> Result<()> {
        self.flush().map_err(|source| self.error(source))?;
        let Sink::File(new) = &self.sink else { return Ok(()) };
        let synced = new.failed.map_or(Ok(()), |kind| Err(kind.into())).and_then(|()| new.file.as_file().sync_all());
        match synced {
            // Not every file system can.
            Err(error) if !matches!(error.kind(), ErrorKind::InvalidInput | ErrorKind::Unsupported) => {
                Err(self.error(error))
            }
            _ => Ok(()),
        }
    }

    fn rename(mut self) -> Result<()> {
        let Sink::File(new) = mem::replace(&mut self.sink, Sink::Committed) else { return Ok(()) };
        if let Ok(earlier) = fs::metadata(&new.destination) {
            // A file that replaces another one has its permissions, where the file system knows them.
            let _ = new.file.as_file().set_permissions(earlier.permissions());
        }
        let NewFile { file, destination, is_new, .. } = new;
        let renamed = if is_new { file.persist_noclobber(&destination) } else { file.persist(&destination) };
        renamed.map(drop).map_err(|PersistError { error, mut file }| {
            // It is whole, and stays under the name that it has.
            file.disable_cleanup(true);
            anyhow!(
                "{} cannot be replaced ({error}); the new one is whole, in {}: close the program that has the old one \
                 open, and rename the new one",
                self.path.display(),
                file.path().display()
            )
        })
    }

    fn write_out(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.hash.update(bytes);
        match &mut self.sink {
            Sink::StandardOutput => {
                let mut output = stdout().lock();
                output.write_all(bytes).and_then(|()| output.flush())
            }
            Sink::Stream(file) => file.write_all(bytes),
            Sink::File(new) => new.write(bytes),
            Sink::Committed => Ok(()),
        }
    }
}

impl Write for FileWriter {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.pending.extend_from_slice(bytes);
        if self.pending.len() >= CHUNK || !matches!(self.sink, Sink::File(_)) {
            let end = self.pending.iter().rposition(|byte| *byte == b'\n').map_or(self.pending.len(), |at| at + 1);
            let rest = self.pending.split_off(end);
            let lines = mem::replace(&mut self.pending, rest);
            self.write_out(&lines)?;
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        let pending = mem::take(&mut self.pending);
        if pending.is_empty() {
            return Ok(());
        }
        if matches!(&self.sink, Sink::File(new) if new.waits_for_row(&pending)) {
            self.pending = pending;
            return Ok(());
        }
        self.write_out(&pending)
    }
}

impl Drop for FileWriter {
    fn drop(&mut self) {
        if matches!(&self.sink, Sink::File(new) if new.keeps_rows) {
            let _ = self.flush();
        }
    }
}

impl NewFile {
    fn new(file: NamedTempFile, destination: &Path) -> Self {
        let (destination, is_new) = (destination.to_owned(), !destination.exists());
        Self { file, destination, keeps_rows: false, is_new, len: 0, has_rows: false, failed: None }
    }

    /// Whether these bytes are no row yet, for which the rows of an earlier recording are not given up.
    fn waits_for_row(&self, bytes: &[u8]) -> bool {
        self.keeps_rows && self.len == 0 && self.file.path() != self.destination && !has_rows(bytes)
    }

    /// Writes bytes, or none of them: a file that keeps its rows has no part of one.
    fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
        if let Some(kind) = self.failed {
            return Err(kind.into());
        }
        if self.len == 0 {
            self.cut()?;
        }
        if let Err(error) = self.file.as_file_mut().write_all(bytes) {
            self.failed = Some(error.kind());
            let _ = self.cut();
            return Err(error);
        }
        self.has_rows |= self.len > 0 || has_rows(bytes);
        self.len += bytes.len() as u64;
        if self.keeps_rows && self.has_rows {
            self.file.disable_cleanup(true);
        }
        Ok(())
    }

    /// Removes what is behind the whole rows.
    fn cut(&mut self) -> io::Result<()> {
        let file = self.file.as_file_mut();
        file.set_len(self.len)?;
        file.seek(SeekFrom::Start(self.len)).map(drop)
    }
}

/// Whether there is a row below the header. A Parquet file that was begun has one: it is written in whole row groups.
pub(super) fn has_rows(bytes: &[u8]) -> bool {
    bytes.starts_with(PARQUET) || bytes.split(|byte| *byte == b'\n').count() > 2
}

/// Gives several files that belong together their names, in this order, once all of them are on the disk; then removes
/// the `stale` ones, which are not written this time.
pub(crate) fn commit_all(mut files: Vec<FileWriter>, stale: &[OutputFile]) -> Result<()> {
    files.iter_mut().try_for_each(FileWriter::complete)?;
    files.into_iter().try_for_each(FileWriter::rename)?;
    for path in stale.iter().filter_map(OutputFile::file) {
        match fs::remove_file(path) {
            Err(error) if error.kind() != ErrorKind::NotFound => return Err(writing(path)(error)),
            _ => {}
        }
    }
    Ok(())
}

/// Opens the file that will become the file at `path`, for this process alone.
pub(super) fn open_locked(path: &Path, written: &Path) -> Result<NamedTempFile> {
    if fs::symlink_metadata(written).is_ok_and(|metadata| !metadata.is_file()) {
        let in_the_way = io::Error::new(ErrorKind::AlreadyExists, format!("{} is in the way", written.display()));
        return Err(writing(path)(in_the_way));
    }
    loop {
        let file = File::options().read(true).write(true).create(true).truncate(false).open(written);
        let file = file.map_err(writing(path))?;
        // Not every file system has locks.
        if let Err(TryLockError::WouldBlock) = file.try_lock() {
            return Err(Busy(path.to_owned()).into());
        }
        // The process that held the lock may have renamed or removed the file before it ended.
        if !cfg!(unix) || is_open_at(&file, written) {
            let name = TempPath::try_from_path(written).map_err(writing(path))?;
            return Ok(NamedTempFile::from_parts(file, name));
        }
    }
}

#[cfg(test)]
impl FileWriter {
    /// Puts another open file in the place of this one, and returns it.
    pub(super) fn replace_file(&mut self, file: File) -> File {
        let Sink::File(new) = &mut self.sink else { return file };
        std::mem::replace(new.file.as_file_mut(), file)
    }
}
