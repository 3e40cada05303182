//! Writing of a file that has its name only when it is whole.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, ErrorKind, Read, Seek, SeekFrom, Write, stdout};
use std::path::{Path, PathBuf};

use super::identity::is_file_at;
use super::{OutputFile, OutputFileError};
use crate::input::{Bounded, CSV_MAX_BYTES};

/// Bytes that are collected before they are written, in whole lines.
const CHUNK: usize = 64 * 1024;

/// The first bytes of a Parquet file.
pub(super) const PARQUET: &[u8] = b"PAR1";

/// A file that is being written. It has its name after [`Self::commit`]; dropped before, a result is as it was, and a
/// recording is left as `FILE.partial` if it has a row.
#[derive(Debug)]
pub(crate) struct FileWriter {
    path: PathBuf,
    sink: Sink,
    /// Bytes that are not written yet.
    pending: Vec<u8>,
}

#[derive(Debug)]
enum Sink {
    StandardOutput,
    Stream(File),
    File(NewFile),
}

/// What becomes of a file that is not committed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Unfinished {
    /// It is removed.
    Removed,
    /// It stays if it has a row below its header.
    KeepsRows,
    /// It has its name already, and stays.
    IsNamed,
}

#[derive(Debug)]
struct NewFile {
    file: File,
    /// Where the bytes go until the commit.
    written: PathBuf,
    destination: PathBuf,
    len: u64,
    lines: u64,
    /// Whether it is a Parquet file, whose rows are no lines: every write is a whole row group of one.
    is_parquet: bool,
    /// Why bytes are missing at the end. Nothing is written behind a gap.
    failed: Option<ErrorKind>,
    unfinished: Unfinished,
    /// The first write replaces what is there.
    begins_anew: bool,
    /// A file that has the name already keeps it.
    is_new: bool,
}

impl FileWriter {
    pub(super) fn standard_output() -> Self {
        Self { path: "standard output".into(), sink: Sink::StandardOutput, pending: Vec::new() }
    }

    pub(super) fn stream(path: &Path) -> Result<Self, OutputFileError> {
        let file = OpenOptions::new().append(true).open(path);
        let file = file.map_err(|source| OutputFileError::write(path, source))?;
        Ok(Self { path: path.to_owned(), sink: Sink::Stream(file), pending: Vec::new() })
    }

    pub(super) fn result(path: &Path, destination: &Path, written: &Path) -> Result<Self, OutputFileError> {
        let file = open_locked(path, written)?;
        let mut writer = Self::new(path, destination, written, file, Unfinished::Removed);
        writer.clear()?;
        Ok(writer)
    }

    pub(super) fn live(path: &Path, destination: &Path) -> Result<Self, OutputFileError> {
        let removed = match fs::remove_file(destination) {
            Err(error) if error.kind() != ErrorKind::NotFound => Err(error),
            _ => Ok(()),
        };
        let file = removed.and_then(|()| OpenOptions::new().write(true).create_new(true).open(destination));
        let file = file.map_err(|source| OutputFileError::write(path, source))?;
        Ok(Self::new(path, destination, destination, file, Unfinished::IsNamed))
    }

    /// A recording that goes on behind the whole rows of `written`, which are returned.
    pub(super) fn recording(
        path: &Path,
        destination: &Path,
        written: &Path,
    ) -> Result<(Self, String), OutputFileError> {
        let failed = |source| OutputFileError::write(written, source);
        let mut file = open_locked(path, written)?;
        let mut bytes = Vec::new();
        let len = file.metadata().map_err(failed)?.len();
        let bounded = Bounded::of_file(&mut file, len, CSV_MAX_BYTES).map_err(io::Error::from);
        bounded.and_then(|mut file| file.read_to_end(&mut bytes)).map_err(failed)?;
        let mut writer = Self::new(path, destination, written, file, Unfinished::KeepsRows);
        if !bytes.starts_with(PARQUET) {
            // A process that was killed may have left a part of a row.
            bytes.truncate(bytes.iter().rposition(|byte| *byte == b'\n').map_or(0, |end| end + 1));
        }
        if let Sink::File(new) = &mut writer.sink {
            new.len = bytes.len() as u64;
            new.lines = count_lines(&bytes);
        }
        Ok((writer, String::from_utf8_lossy(&bytes).into_owned()))
    }

    /// Removes everything that was written, by this process or by one before.
    pub(crate) fn clear(&mut self) -> Result<(), OutputFileError> {
        self.pending.clear();
        if let Sink::File(new) = &mut self.sink {
            (new.len, new.lines) = (0, 0);
        }
        self.cut()
    }

    /// Lets the first write replace the rows of a process before: without one, they stay.
    pub(super) fn begin_anew(&mut self) {
        if let Sink::File(new) = &mut self.sink {
            new.begins_anew = true;
        }
    }

    /// Lets a file that has the name at the commit keep it: the commit then fails with [`OutputFileError::Rename`].
    pub(super) fn keep_earlier(&mut self) {
        if let Sink::File(new) = &mut self.sink {
            new.is_new = true;
        }
    }

    /// Removes the part of a row at the end.
    pub(super) fn cut(&mut self) -> Result<(), OutputFileError> {
        let Sink::File(new) = &mut self.sink else { return Ok(()) };
        let cut = new.file.set_len(new.len).and_then(|()| new.file.seek(SeekFrom::Start(new.len)));
        cut.map(drop).map_err(|source| self.error(source))
    }

    fn new(path: &Path, destination: &Path, written: &Path, file: File, unfinished: Unfinished) -> Self {
        let (written, destination) = (written.to_owned(), destination.to_owned());
        let (begins_anew, is_new) = (false, false);
        let new = NewFile {
            file,
            written,
            destination,
            len: 0,
            lines: 0,
            is_parquet: false,
            failed: None,
            unfinished,
            begins_anew,
            is_new,
        };
        Self { path: path.to_owned(), sink: Sink::File(new), pending: Vec::new() }
    }

    /// The path, as the user gave it.
    pub(crate) fn path(&self) -> &Path {
        &self.path
    }

    /// Writes what is pending, and gives the file its name.
    pub(crate) fn commit(mut self) -> Result<(), OutputFileError> {
        self.complete()?;
        self.rename()
    }

    /// The error of this file for one of the operating system.
    pub(crate) fn error(&self, source: io::Error) -> OutputFileError {
        match &self.sink {
            Sink::File(new) if new.is_kept() => OutputFileError::Rows { path: new.written.clone(), source },
            Sink::File(_) => OutputFileError::Cut { path: self.path.clone(), source },
            _ => OutputFileError::write(&self.path, source),
        }
    }

    /// Writes what is pending, and waits until the disk has everything.
    fn complete(&mut self) -> Result<(), OutputFileError> {
        self.flush().map_err(|source| self.error(source))?;
        let Sink::File(new) = &mut self.sink else { return Ok(()) };
        if let Some(kind) = new.failed {
            return Err(self.error(kind.into()));
        }
        match new.file.sync_all() {
            // Not every file system can.
            Err(error) if !matches!(error.kind(), ErrorKind::InvalidInput | ErrorKind::Unsupported) => {
                Err(self.error(error))
            }
            _ => Ok(()),
        }
    }

    fn rename(&mut self) -> Result<(), OutputFileError> {
        let Sink::File(new) = &mut self.sink else { return Ok(()) };
        if new.unfinished == Unfinished::IsNamed {
            return Ok(());
        }
        if let Ok(earlier) = fs::metadata(&new.destination) {
            // A file that replaces another one has its permissions, where the file system knows them.
            let _ = new.file.set_permissions(earlier.permissions());
        }
        // The file is whole: from here on it stays under whichever name it has.
        new.unfinished = Unfinished::IsNamed;
        let renamed = if new.is_new {
            rename_new(&new.written, &new.destination)
        } else {
            fs::rename(&new.written, &new.destination)
        };
        renamed.map_err(|source| OutputFileError::Rename {
            path: self.path.clone(),
            written: new.written.clone(),
            source,
        })
    }

    fn write_out(&mut self, bytes: &[u8]) -> io::Result<()> {
        match &mut self.sink {
            Sink::StandardOutput => {
                let mut output = stdout().lock();
                output.write_all(bytes).and_then(|()| output.flush())
            }
            Sink::Stream(file) => file.write_all(bytes),
            Sink::File(new) => new.write(bytes),
        }
    }
}

impl Write for FileWriter {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if !matches!(self.sink, Sink::File(_)) {
            return self.write_out(bytes).map(|()| bytes.len());
        }
        self.pending.extend_from_slice(bytes);
        if self.pending.len() >= CHUNK {
            let end = self.pending.iter().rposition(|byte| *byte == b'\n').map_or(self.pending.len(), |at| at + 1);
            let rest = self.pending.split_off(end);
            let lines = std::mem::replace(&mut self.pending, rest);
            self.write_out(&lines)?;
        }
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        let pending = std::mem::take(&mut self.pending);
        if pending.is_empty() { Ok(()) } else { self.write_out(&pending) }
    }
}

impl Drop for FileWriter {
    fn drop(&mut self) {
        if matches!(&self.sink, Sink::File(new) if new.unfinished == Unfinished::KeepsRows) {
            let _ = self.flush();
        }
    }
}

impl NewFile {
    /// Writes bytes, or none of them: a file that keeps its rows has no part of one.
    fn write(&mut self, bytes: &[u8]) -> io::Result<()> {
        if let Some(kind) = self.failed {
            return Err(kind.into());
        }
        if std::mem::take(&mut self.begins_anew) {
            (self.len, self.lines) = (0, 0);
            self.file.set_len(0).and_then(|()| self.file.seek(SeekFrom::Start(0)))?;
        }
        if self.len == 0 {
            self.is_parquet = bytes.starts_with(PARQUET);
        }
        if let Err(error) = self.file.write_all(bytes) {
            self.failed = Some(error.kind());
            let _ = self.file.set_len(self.len).and_then(|()| self.file.seek(SeekFrom::Start(self.len)));
            return Err(error);
        }
        self.len += bytes.len() as u64;
        self.lines += count_lines(bytes);
        Ok(())
    }

    fn is_kept(&self) -> bool {
        match self.unfinished {
            Unfinished::Removed => false,
            Unfinished::KeepsRows => self.lines > 1 || (self.is_parquet && self.len > 0),
            Unfinished::IsNamed => true,
        }
    }
}

impl Drop for NewFile {
    fn drop(&mut self) {
        if !self.is_kept() {
            // Nothing can be done about a file that cannot be removed.
            let _ = fs::remove_file(&self.written);
        }
    }
}

/// Gives several files that belong together their names. The earlier ones, and `stale` ones that are not written this
/// time, are removed before: whatever ends the process, no file of an earlier run stands beside one of this run.
pub(crate) fn commit_all(mut files: Vec<FileWriter>, stale: &[OutputFile]) -> Result<(), OutputFileError> {
    for file in &mut files {
        file.complete()?;
    }
    let destinations = files.iter().filter_map(|file| match &file.sink {
        Sink::File(new) => Some(new.destination.as_path()),
        _ => None,
    });
    // The first is replaced in one step.
    let earlier: Vec<&Path> = stale.iter().filter_map(OutputFile::file).chain(destinations.skip(1)).collect();
    for path in earlier {
        match fs::remove_file(path) {
            Err(error) if error.kind() != ErrorKind::NotFound => {
                return Err(OutputFileError::write(path, error));
            }
            _ => {}
        }
    }
    files.iter_mut().try_for_each(FileWriter::rename)
}

/// Renames a file, unless another one has the name already. That is looked at in one step with the renaming, except on
/// file systems without hard links.
fn rename_new(written: &Path, destination: &Path) -> io::Result<()> {
    match fs::hard_link(written, destination) {
        Ok(()) => fs::remove_file(written),
        Err(error) if error.kind() == ErrorKind::AlreadyExists => Err(error),
        Err(_) if destination.exists() => Err(ErrorKind::AlreadyExists.into()),
        Err(_) => fs::rename(written, destination),
    }
}

fn count_lines(bytes: &[u8]) -> u64 {
    bytes.split_inclusive(|byte| *byte == b'\n').filter(|line| line.ends_with(b"\n")).count() as u64
}

/// Opens the file that will become the file at `path`, for this process alone.
pub(super) fn open_locked(path: &Path, written: &Path) -> Result<File, OutputFileError> {
    let failed = |source| OutputFileError::write(path, source);
    if fs::symlink_metadata(written).is_ok_and(|metadata| !metadata.is_file()) {
        let source = io::Error::new(ErrorKind::AlreadyExists, format!("{} is in the way", written.display()));
        return Err(failed(source));
    }
    loop {
        let options = OpenOptions::new().read(true).write(true).create(true).truncate(false).open(written);
        let file = options.map_err(failed)?;
        match file.try_lock() {
            Err(TryLockError::WouldBlock) => return Err(OutputFileError::Busy { path: path.to_owned() }),
            // Not every file system has locks.
            Ok(()) | Err(TryLockError::Error(_)) => {}
        }
        // The process that held the lock may have renamed or removed the file before it ended.
        if is_file_at(&file, written) {
            return Ok(file);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Inputs, Recording};
    use super::*;

    /// Whatever ends the renaming, no file of the run before stands beside one of this run.
    #[test]
    fn a_set_that_is_renamed_in_part_has_no_file_of_an_earlier_run() {
        let folder = tempfile::tempdir().unwrap();
        let names = ["a", "b", "c", "stale"];
        let outputs = names.map(|name| {
            let path = folder.path().join(name);
            fs::write(&path, "earlier").unwrap();
            OutputFile::new(&path, "--out", &Inputs::default()).unwrap()
        });
        let [a, b, c, stale] = outputs;
        let files = [&a, &b, &c].map(|output| output.filled(b"of this run").unwrap()).into();
        fs::remove_file(folder.path().join(".b.frixel-tmp")).unwrap();
        assert!(matches!(commit_all(files, &[stale]), Err(OutputFileError::Rename { .. })));
        let read = |name: &str| fs::read_to_string(folder.path().join(name)).ok();
        assert_eq!(read("a").as_deref(), Some("of this run"));
        assert_eq!(["b", "c", "stale"].map(read), [None, None, None]);
    }

    /// A file that another process gives the name between the look and the commit.
    #[test]
    fn a_new_file_replaces_none_that_came_meanwhile() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("rows.csv");
        let output = OutputFile::new(&path, "-o", &Inputs::default()).unwrap();
        let recording = Recording::new(&path, "-o", &Inputs::default(), false, "").unwrap();
        for rows in ["a result\n", "a,recording\n1,2\n"] {
            let mut writer =
                if rows.starts_with("a result") { output.create().unwrap() } else { recording.start().unwrap() };
            writer.keep_earlier();
            writer.write_all(rows.as_bytes()).unwrap();
            fs::write(&path, "came meanwhile").unwrap();
            let Err(OutputFileError::Rename { written, .. }) = writer.commit() else { panic!("it is replaced") };
            assert_eq!(fs::read_to_string(&path).unwrap(), "came meanwhile");
            assert_eq!(fs::read_to_string(written).unwrap(), rows);
            fs::remove_file(&path).unwrap();
        }
    }

    /// Nothing is written behind a gap: rows that are missing in the middle would not be noticed.
    #[test]
    fn a_file_with_a_gap_takes_no_more_and_gets_no_name() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("rows");
        let mut file = OutputFile::new(&path, "-o", &Inputs::default()).unwrap().filled(b"one\n").unwrap();
        file.flush().unwrap();
        let Sink::File(new) = &mut file.sink else { panic!("a file") };
        let whole = std::mem::replace(&mut new.file, File::open(&new.written).unwrap());
        assert!(file.write_all(b"two\n").and_then(|()| file.flush()).is_err(), "it is open for reading only");
        let Sink::File(new) = &mut file.sink else { panic!("a file") };
        new.file = whole;
        assert!(file.write_all(b"three\n").and_then(|()| file.flush()).is_err());
        assert!(file.commit().is_err() && !path.exists());
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
    }
}
