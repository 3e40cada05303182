//! Writing of files that get their names only when they are complete.

use std::fs::{self, File, TryLockError};
use std::io::{self, ErrorKind, Seek, SeekFrom, Write, stdout};
use std::mem;
use std::path::{Path, PathBuf};

use frixel_lab::hash::hex;
use frixel_lab::input::whole_lines;
use frixel_lab::recording::MAGIC as PARQUET;
use sha2::{Digest, Sha256};
use tempfile::{NamedTempFile, PathPersistError, TempPath};

use crate::identity::is_open_at;
use crate::output_file::folder_of;
use crate::{Error, OutputFile, writing};

/// Bytes that are collected before they are written, in whole lines.
const CHUNK: usize = 64 * 1024;

/// A file that is being written. [`Self::commit`] gives it its name. If it is dropped before, an earlier result stays
/// as it was, and a recording is left as `FILE.partial` if it has a row. Errors of writing name the file.
#[derive(Debug)]
pub struct FileWriter {
    path: PathBuf,
    sink: Sink,
    /// Bytes that are not written yet.
    pending: Vec<u8>,
    hash: Sha256,
}

#[derive(Debug)]
pub(crate) enum Sink {
    StandardOutput,
    Stream(File),
    File(NewFile),
}

/// A file under a temporary name.
#[derive(Debug)]
pub(crate) struct NewFile {
    pub(crate) file: File,
    /// The temporary name; none if the file already has its own.
    temporary: Option<TempPath>,
    destination: PathBuf,
    /// Whether the name is unused. A file created there meanwhile is not replaced.
    is_new: bool,
    /// Whether rows are kept without a commit.
    pub(crate) keeps_rows: bool,
    /// Offset of the first bytes, until there are any. Content after it is of an earlier process.
    pub(crate) begins_at: Option<u64>,
    /// Error that left bytes missing at the end. Nothing is written after a gap.
    failed: Option<ErrorKind>,
}

impl FileWriter {
    pub(crate) fn new(path: &Path, sink: Sink) -> Self {
        Self { path: path.to_owned(), sink, pending: Vec::new(), hash: Sha256::new() }
    }

    /// Gives the file its name while it is still empty.
    pub(crate) fn live(mut self) -> Result<Self, Error> {
        if let Sink::File(new) = &mut self.sink
            && let Some(temporary) = new.temporary.take()
        {
            new.write(&[]).map_err(writing(&self.path))?;
            temporary.persist(&new.destination).map_err(|failed| writing(&self.path)(failed.error))?;
            new.keeps_rows = true;
        }
        Ok(self)
    }

    /// The path, as the user gave it.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Writes what is pending, and gives the file its name.
    pub fn commit(self) -> Result<(), Error> {
        commit_all(vec![self], &[])
    }

    /// The SHA-256 of all that this process has written.
    pub fn sha256(&self) -> String {
        hex(&self.hash.clone().chain_update(&self.pending).finalize())
    }

    pub(crate) fn error(&self, error: io::Error) -> Error {
        let advice = match &self.sink {
            Sink::File(new) if new.keeps_rows && new.file.metadata().is_ok_and(|file| file.len() > 0) => {
                "its rows until then are kept; check the free space of its folder"
            }
            Sink::File(_) => "no cut file is left; check the free space of its folder",
            Sink::Stream(_) => return writing(&self.path)(error),
            Sink::StandardOutput => return Error::StandardOutput(error),
        };
        Error::Unwritable(self.path.clone(), error, advice)
    }

    /// As the error of [`Write`].
    fn io_error(&self, error: io::Error) -> io::Error {
        io::Error::new(error.kind(), self.error(error))
    }

    pub(crate) fn write_out(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.hash.update(bytes);
        match &mut self.sink {
            Sink::StandardOutput => {
                let mut output = stdout().lock();
                output.write_all(bytes).and_then(|()| output.flush())
            }
            Sink::Stream(file) => file.write_all(bytes),
            Sink::File(new) => new.write(bytes),
        }
    }

    /// Writes what is pending, and waits until the disk has everything.
    fn complete(&mut self) -> Result<(), Error> {
        let pending = mem::take(&mut self.pending);
        let mut written = self.write_out(&pending);
        if let Sink::File(new) = &self.sink {
            written = written.and_then(|()| sync(&new.file));
        }
        written.map_err(|error| self.error(error))
    }

    /// Gives the file its name, and returns its folder, unless it has one already.
    fn rename(mut self) -> Result<Option<PathBuf>, Error> {
        let Sink::File(new) = &mut self.sink else { return Ok(None) };
        let Some(temporary) = new.temporary.take() else { return Ok(None) };
        if let Ok(earlier) = fs::metadata(&new.destination) {
            // A file that replaces another one has its permissions, where the file system knows them.
            let _ = new.file.set_permissions(earlier.permissions());
        }
        let rename = if new.is_new { TempPath::persist_noclobber } else { TempPath::persist };
        match rename(temporary, &new.destination) {
            Ok(()) => Ok(Some(folder_of(&new.destination).to_owned())),
            Err(PathPersistError { error, mut path }) => {
                path.disable_cleanup(true);
                Err(Error::Unnamed(self.path.clone(), error, path.to_path_buf()))
            }
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
            self.write_out(&lines).map_err(|error| self.io_error(error))?;
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        if matches!(&self.sink, Sink::File(new) if new.waits_for_row(&self.pending)) {
            return Ok(());
        }
        let pending = mem::take(&mut self.pending);
        self.write_out(&pending).map_err(|error| self.io_error(error))
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
    /// Opens the file that will become `destination`, which the user calls `path`.
    pub(crate) fn open(path: &Path, destination: &Path, written: &Path) -> Result<Self, Error> {
        let (file, temporary) = open_locked(path, written)?.into_parts();
        Ok(Self {
            file,
            temporary: Some(temporary),
            destination: destination.to_owned(),
            is_new: !destination.exists(),
            keeps_rows: false,
            begins_at: Some(0),
            failed: None,
        })
    }

    /// Makes the temporary name the last one, and places the next bytes behind the whole lines.
    pub(crate) fn stay(&mut self, each: impl FnMut(&[u8])) -> io::Result<()> {
        if let Some(mut name) = self.temporary.take() {
            name.disable_cleanup(true);
        }
        self.keeps_rows = true;
        self.begins_at = Some(whole_lines(&self.file, each)?);
        self.append(&[])
    }

    /// Whether these bytes have no row yet, so that the rows of an earlier recording are kept.
    fn waits_for_row(&self, bytes: &[u8]) -> bool {
        self.keeps_rows && self.begins_at == Some(0) && !has_rows(bytes)
    }

    fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
        if let Some(kind) = self.failed {
            return Err(kind.into());
        }
        self.append(bytes).inspect_err(|error| self.failed = Some(error.kind()))
    }

    /// Writes all bytes, or none of them, so that the file never has a partial row.
    fn append(&mut self, bytes: &[u8]) -> io::Result<()> {
        if let Some(end) = self.begins_at.take() {
            self.file.set_len(end)?;
            self.file.seek(SeekFrom::Start(end))?;
        }
        let whole = self.file.stream_position()?;
        self.file.write_all(bytes).or_else(|error| self.file.set_len(whole).and(Err(error)))
    }
}

impl Drop for NewFile {
    fn drop(&mut self) {
        if let Some(temporary) = &mut self.temporary
            && self.keeps_rows
        {
            temporary.disable_cleanup(self.file.metadata().map_or(true, |metadata| metadata.len() > 0));
        }
    }
}

/// Whether there is a row below the header. A Parquet file that was begun has one: it is written in whole row groups.
pub(crate) fn has_rows(bytes: &[u8]) -> bool {
    bytes.starts_with(PARQUET) || bytes.split(|byte| *byte == b'\n').count() > 2
}

/// Gives several files that belong together their names, in this order, once all of them are on the disk; then removes
/// the `stale` ones, which are not written this time.
pub fn commit_all(mut files: Vec<FileWriter>, stale: &[OutputFile]) -> Result<(), Error> {
    files.iter_mut().try_for_each(FileWriter::complete)?;
    let mut folders = files.into_iter().filter_map(|file| file.rename().transpose()).collect::<Result<Vec<_>, _>>()?;
    for path in stale.iter().filter_map(|output| output.file.as_deref()) {
        match fs::remove_file(path) {
            Err(error) if error.kind() != ErrorKind::NotFound => return Err(writing(path)(error)),
            _ => {}
        }
    }
    folders.dedup();
    folders.iter().try_for_each(|folder| sync_names(folder).map_err(writing(folder)))
}

/// Waits until the disk has what is in a file. Not every file system can.
fn sync(file: &File) -> io::Result<()> {
    match file.sync_all() {
        Err(error) if matches!(error.kind(), ErrorKind::InvalidInput | ErrorKind::Unsupported) => Ok(()),
        synced => synced,
    }
}

/// Waits until the disk has the names in a folder, where it can be opened: on Unix, with leave to read it.
fn sync_names(folder: &Path) -> io::Result<()> {
    #[cfg(test)]
    crate::tests::SYNCED.with_borrow_mut(|synced| synced.push(folder.to_owned()));
    File::open(folder).map_or(Ok(()), |folder| sync(&folder))
}

/// Opens the file that will become the file at `path`, for this process alone.
pub(crate) fn open_locked(path: &Path, written: &Path) -> Result<NamedTempFile, Error> {
    if fs::symlink_metadata(written).is_ok_and(|metadata| !metadata.is_file()) {
        let in_the_way = io::Error::new(ErrorKind::AlreadyExists, format!("{} is in the way", written.display()));
        return Err(writing(path)(in_the_way));
    }
    loop {
        let file = File::options().read(true).write(true).create(true).truncate(false).open(written);
        let file = file.map_err(writing(path))?;
        // Not every file system has locks.
        if let Err(TryLockError::WouldBlock) = file.try_lock() {
            return Err(Error::Busy(path.to_owned()));
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
    pub(crate) fn replace_file(&mut self, file: File) -> File {
        let Sink::File(new) = &mut self.sink else { return file };
        mem::replace(&mut new.file, file)
    }
}
