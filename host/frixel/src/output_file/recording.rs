//! Recordings of people, which take a person's time and cannot be computed again.

use std::collections::BTreeSet;
use std::io;
use std::path::{Path, PathBuf};

use anyhow::{Result, bail};

use super::writer::{PARQUET, has_rows};
use super::{FileWriter, Inputs, OutputFile, partial_beside};
use crate::input;

/// Bytes of the beginning of a file that say what it is.
const HEAD: u64 = 4096;
/// Largest footer of a Parquet file that is read.
const FOOTER_MAX_BYTES: u64 = 64 << 20;
/// The columns of a recorded stroke, the one that a person's play adds to it, and those of a recording of friction.
const STROKE_COLUMNS: [&str; 3] = ["t_s", "x_mm", "y_mm"];
const PARTICIPANT: &str = "participant";
const FRICTION_COLUMNS: [&str; 3] = ["voltage_v_rms", "normal_force_n", "friction_n"];
/// The line of a profile that rests on what a person felt, and a part of the summary of a person's play.
const PERCEPTUAL: &str = "origin = \"perceptual\"";
const OF_A_PERSON: &str = "\"simulated\":false";

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
    ) -> Result<Self> {
        let output = OutputFile::replacing(path, option, inputs)?;
        if !overwrites {
            output.check_new()?;
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
        let read = |file| input::read(&partial_beside(file), input::CSV_MAX_BYTES);
        self.output.file().is_some_and(|file| read(file).is_ok_and(|bytes| has_rows(&bytes)))
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
    pub(crate) fn start(&self) -> Result<FileWriter> {
        let Some(file) = self.output.file() else { return self.output.create() };
        let (name, advice) = (self.partial(), self.advice);
        let name = name.display();
        let (writer, earlier) = FileWriter::recording(self.output.path(), file, &partial_beside(file))?;
        match earlier {
            Some(_) if self.overwrites => Ok(writer),
            Some(rows) if has_rows(rows.as_bytes()) => {
                bail!("{name} has the rows of a recording that was cut off: {advice}, or record anew with --overwrite")
            }
            Some(_) => bail!("{name} is in the way, and no recording left it: rename it, or record with --overwrite"),
            None => Ok(writer),
        }
    }

    /// Goes on with a recording that was cut off, and returns its whole rows, header included.
    pub(crate) fn resume(&self) -> Result<(FileWriter, String)> {
        if let Some(file) = self.output.file().filter(|file| partial_beside(file).exists()) {
            let (mut writer, rows) = FileWriter::recording(self.output.path(), file, &partial_beside(file))?;
            if let Some(rows) = rows.filter(|rows| has_rows(rows.as_bytes())) {
                writer.go_on(&rows)?;
                return Ok((writer, rows));
            }
        }
        let name = self.partial();
        bail!("there is no {} with rows of a recording that was cut off: leave --finish out", name.display())
    }
}

/// Whether a file is a recording of a person, by its content: a stroke of `frixel board record`, friction as `frixel
/// finger fit` reads it, a profile that rests on what a person felt, or `felt.csv`, `summary.json` or the Parquet file
/// of a play.
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
    let is_stroke = || columns.iter().all(|name| STROKE_COLUMNS.contains(name) || *name == "force_n");
    let is_of_person = has(STROKE_COLUMNS) && (is_stroke() || columns.contains(PARTICIPANT));
    is_of_person
        || has(FRICTION_COLUMNS)
        || text.lines().any(|line| line.trim() == PERCEPTUAL)
        || (text.starts_with('{') && text.contains(OF_A_PERSON))
}

/// The footer of a Parquet file, its length and last bytes included.
fn footer(path: &Path) -> io::Result<Vec<u8>> {
    let end = input::read_tail(path, 8)?;
    let [a, b, c, d, ..] = end[..] else { return Ok(end) };
    let len = 8 + u64::from(u32::from_le_bytes([a, b, c, d]));
    input::read_tail(path, len.min(FOOTER_MAX_BYTES))
}
