//! Recordings of people, which take a person's time and cannot be computed again.

use std::collections::BTreeSet;
use std::io;
use std::path::{Path, PathBuf};

use super::writer::PARQUET;
use super::{FileWriter, Inputs, OutputFile, OutputFileError, partial_beside};
use crate::input;

/// Bytes of the beginning of a file that say what it is.
const HEAD: u64 = 4096;
/// Largest footer of a Parquet file that is read.
const FOOTER_MAX_BYTES: u64 = 64 << 20;
/// The columns of a recorded stroke, and of a recording of friction.
const STROKE_COLUMNS: [&str; 3] = ["t_s", "x_mm", "y_mm"];
const FRICTION_COLUMNS: [&str; 3] = ["voltage_v_rms", "normal_force_n", "friction_n"];
/// The line of a profile that rests on what a person felt.
const PERCEPTUAL: &str = "origin = \"perceptual\"";

/// A recording that is about to be made. Its rows go to `FILE.partial`, which becomes `FILE` at the end.
#[derive(Clone, Debug)]
pub(crate) struct Recording {
    output: OutputFile,
    overwrites: bool,
    advice: &'static str,
}

impl Recording {
    /// A recording by the name that the user gave to `option`. It replaces an earlier one only if `overwrites`.
    /// `advice` says how to keep the rows of a recording that was cut off.
    pub(crate) fn new(
        path: &Path,
        option: &'static str,
        inputs: &Inputs,
        overwrites: bool,
        advice: &'static str,
    ) -> Result<Self, OutputFileError> {
        let output = OutputFile::of_person(path, option, inputs)?;
        if output.exists() && !overwrites {
            return Err(OutputFileError::Exists { path: path.to_owned(), option });
        }
        Ok(Self::of(output, overwrites, advice))
    }

    /// A recording whose file may be replaced. It replaces the rows of one that was cut off only if `overwrites`.
    pub(crate) fn of(output: OutputFile, overwrites: bool, advice: &'static str) -> Self {
        Self { output, overwrites, advice }
    }

    /// The file that the recording becomes.
    pub(crate) fn output(&self) -> &OutputFile {
        &self.output
    }

    /// Where the rows are until the recording is whole, as the user would name it.
    pub(crate) fn partial(&self) -> PathBuf {
        partial_beside(self.output.path())
    }

    /// Whether a recording that was cut off has left rows.
    pub(crate) fn is_cut_off(&self) -> bool {
        let Some(file) = self.output.file() else { return false };
        input::read(&partial_beside(file), input::CSV_MAX_BYTES)
            .is_ok_and(|bytes| has_rows(&String::from_utf8_lossy(&bytes)))
    }

    /// Removes the rows of a recording that is whole.
    pub(crate) fn discard_partial(&self) {
        if let Some(file) = self.output.file() {
            // A file that cannot be removed is named by the next recording.
            let _ = std::fs::remove_file(partial_beside(file));
        }
    }

    /// How to keep the rows of a recording that was cut off.
    pub(crate) fn advice(&self) -> &'static str {
        self.advice
    }

    /// Begins a recording. Fails if an earlier one was cut off, unless that may be overwritten: its rows then stay
    /// until the first ones of this recording.
    pub(crate) fn start(&self) -> Result<FileWriter, OutputFileError> {
        let Some(file) = self.output.file() else { return self.output.create() };
        if is_of_another_program(&partial_beside(file)) && !self.overwrites {
            return Err(OutputFileError::Foreign { partial: self.partial() });
        }
        let (mut writer, earlier) = FileWriter::recording(self.output.path(), file, &partial_beside(file))?;
        if has_rows(&earlier) && !self.overwrites {
            return Err(OutputFileError::CutOff { partial: self.partial(), advice: self.advice });
        }
        writer.begin_anew();
        if !self.overwrites {
            writer.keep_earlier();
        }
        Ok(writer)
    }

    /// Goes on with a recording that was cut off, and returns its whole rows, header included.
    pub(crate) fn resume(&self) -> Result<(FileWriter, String), OutputFileError> {
        let nothing = || OutputFileError::NothingCutOff { partial: self.partial() };
        let Some(file) = self.output.file() else { return Err(nothing()) };
        let partial = partial_beside(file);
        if !partial.exists() {
            return Err(nothing());
        }
        let (mut writer, rows) = FileWriter::recording(self.output.path(), file, &partial)?;
        writer.cut()?;
        if has_rows(&rows) { Ok((writer, rows)) } else { Err(nothing()) }
    }
}

/// Whether the play in a folder is of a person's finger on a board that is not a simulator, by its `summary.json`.
pub(crate) fn is_play_of_person(folder: &Path) -> bool {
    let summary = input::read(&folder.join("summary.json"), input::TOML_MAX_BYTES).unwrap_or_default();
    let summary: serde_json::Value = serde_json::from_slice(&summary).unwrap_or_default();
    summary.get("simulated") == Some(&serde_json::Value::Bool(false))
}

/// Whether a file is nothing that a recording leaves without a row: nothing at all, or the names of columns.
fn is_of_another_program(partial: &Path) -> bool {
    let Ok(head) = input::read_head(partial, HEAD) else { return false };
    let is_of_name = |byte: &u8| byte.is_ascii_lowercase() || byte.is_ascii_digit() || b"_,".contains(byte);
    let names = head.strip_suffix(b"\n").unwrap_or(&head);
    !has_rows(&String::from_utf8_lossy(&head)) && !names.iter().all(is_of_name)
}

/// Whether there is a row below the header. A Parquet file that was begun has one: it is written in whole row groups.
fn has_rows(text: &str) -> bool {
    text.as_bytes().starts_with(PARQUET) || text.bytes().filter(|byte| *byte == b'\n').count() > 1
}

/// Whether a file is a recording of a person, by its header: a stroke of `frixel record`, friction as `frixel fit`
/// reads it, or a profile of `frixel.experiment`; or by its metadata, if it is a Parquet file.
pub(crate) fn is_recording(path: &Path) -> bool {
    let Ok(head) = input::read_head(path, HEAD) else { return false };
    if head.starts_with(PARQUET) {
        return footer(path).is_ok_and(|footer| frixel_lab::recording::is_of_person(&footer));
    }
    let text = String::from_utf8_lossy(&head);
    // Spreadsheets begin a file with a byte order mark.
    let text = text.trim_start_matches('\u{feff}');
    let columns: BTreeSet<&str> =
        text.lines().next().unwrap_or_default().split([',', ';']).map(|cell| cell.trim_matches(['"', ' '])).collect();
    let has = |names: [&str; 3]| names.iter().all(|name| columns.contains(name));
    let is_stroke =
        has(STROKE_COLUMNS) && columns.iter().all(|name| [&STROKE_COLUMNS[..], &["force_n"]].concat().contains(name));
    is_stroke || has(FRICTION_COLUMNS) || text.lines().any(|line| line.trim() == PERCEPTUAL)
}

/// The footer of a Parquet file, its length and last bytes included.
fn footer(path: &Path) -> io::Result<Vec<u8>> {
    let end = input::read_tail(path, 8)?;
    let [a, b, c, d, ..] = end[..] else { return Ok(end) };
    let len = 8 + u64::from(u32::from_le_bytes([a, b, c, d]));
    input::read_tail(path, len.min(FOOTER_MAX_BYTES))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A summary that was a link to a device without end took all memory.
    #[cfg(unix)]
    #[test]
    fn a_device_in_place_of_a_file_is_not_read() {
        let folder = tempfile::tempdir().unwrap();
        let path = |name: &str| folder.path().join(name);
        let link = |name: &str| std::os::unix::fs::symlink("/dev/zero", path(name)).unwrap();
        link("summary.json");
        assert!(!is_play_of_person(folder.path()));
        link("felt.csv");
        assert!(!is_recording(&path("felt.csv")));
        link("rows.csv.partial");
        let recording = Recording::new(&path("rows.csv"), "-o", &Inputs::default(), false, "").unwrap();
        assert!(!recording.is_cut_off());
        assert!(recording.start().is_err() && recording.resume().is_err());
        std::fs::remove_file(path("rows.csv.partial")).unwrap();
        std::fs::File::create(path("rows.csv.partial")).unwrap().set_len(8 << 30).unwrap();
        let error = recording.resume().unwrap_err().to_string();
        assert!(error.contains("it has 8589934592 bytes, and at most 536870912 are read"), "{error}");
    }

    #[test]
    fn a_file_of_another_program_is_not_taken_for_an_empty_recording() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("rows.csv");
        let start = |overwrites| Recording::new(&path, "-o", &Inputs::default(), overwrites, "").unwrap().start();
        for foreign in ["A letter.", "A letter.\n", "t_s;x_mm", "\0\u{1}"] {
            std::fs::write(partial_beside(&path), foreign).unwrap();
            assert!(matches!(start(false), Err(OutputFileError::Foreign { .. })), "{foreign:?}");
            assert_eq!(std::fs::read_to_string(partial_beside(&path)).unwrap(), foreign);
            assert!(start(true).is_ok());
        }
        for own in ["", "t_s,x_", "t_s,x_mm,y_mm\n"] {
            std::fs::write(partial_beside(&path), own).unwrap();
            assert!(start(false).is_ok(), "{own:?}");
        }
    }
}
