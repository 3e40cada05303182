//! Recordings of people, which take a person's time and cannot be computed again. Their rows go to `FILE.partial`,
//! which becomes `FILE` at the end.

use std::fs;
use std::io::{self, Read};
use std::path::PathBuf;

use frixel_lab::input::{Bounded, CSV_MAX_BYTES, read};

use crate::output_file::partial_beside;
use crate::writer::{NewFile, Sink, has_rows};
use crate::{Error, FileWriter, OutputFile, writing};

impl OutputFile {
    /// Path of the rows of a recording that is not complete, as the user would write it.
    pub fn partial(&self) -> PathBuf {
        partial_beside(self.path())
    }

    /// Whether an interrupted recording has left rows.
    pub fn is_cut_off(&self) -> bool {
        let rows = |file: &PathBuf| read(&partial_beside(file), CSV_MAX_BYTES);
        self.file.as_ref().is_some_and(|file| rows(file).is_ok_and(|rows| has_rows(&rows)))
    }

    /// Removes the partial file of a complete recording.
    pub fn discard_partial(&self) {
        if let Some(file) = &self.file {
            // A file that cannot be removed is named by the next recording.
            let _ = fs::remove_file(partial_beside(file));
        }
    }

    /// Begins a recording. Fails if an earlier one was interrupted, with `advice` on how to keep its rows. If the
    /// output overwrites, the old rows stay until the first new ones are written.
    pub fn begin_recording(&self, advice: &'static str) -> Result<FileWriter, Error> {
        let Some((partial, earlier)) = self.open_partial()? else { return self.create() };
        if !self.overwrites && has_rows(&earlier) {
            return Err(Error::CutOff(self.partial(), advice));
        }
        if !self.overwrites && !earlier.is_empty() {
            return Err(Error::InTheWay(self.partial()));
        }
        Ok(FileWriter::new(self.path(), Sink::File(partial)))
    }

    /// Resumes an interrupted recording, and returns its complete rows, header included. They stay unchanged until more
    /// are written, or the recording is committed.
    pub fn resume(&self) -> Result<(FileWriter, String), Error> {
        if let Some((mut partial, mut rows)) = self.open_partial()?
            && has_rows(&rows)
        {
            // A process that was killed may have left a part of a row.
            rows.truncate(rows.iter().rposition(|byte| *byte == b'\n').map_or(0, |end| end + 1));
            partial.begins_at = Some(rows.len() as u64);
            let writer = FileWriter::new(self.path(), Sink::File(partial));
            return Ok((writer, String::from_utf8_lossy(&rows).into_owned()));
        }
        Err(Error::NoRows(self.partial()))
    }

    /// The file of the rows, and what an earlier recording has left there; none for a stream.
    fn open_partial(&self) -> Result<Option<(NewFile, Vec<u8>)>, Error> {
        let Some(file) = &self.file else { return Ok(None) };
        let (path, mut earlier) = (partial_beside(file), Vec::new());
        let mut partial = NewFile::open(self.path(), file, &path)?;
        partial.keeps_rows = true;
        let len = partial.file.metadata().map_err(writing(&path))?.len();
        let bytes = Bounded::of_file(&mut partial.file, len, CSV_MAX_BYTES).map_err(io::Error::from);
        bytes.and_then(|mut bytes| bytes.read_to_end(&mut earlier)).map_err(writing(&path))?;
        Ok(Some((partial, earlier)))
    }
}
