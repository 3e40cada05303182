//! `felt.csv`: what happened under the finger, a row at a time.

use std::fmt::{self, Display};
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use frixel_wire::fault::Flags;

use super::OutputError;

const HEADER: &str = "t_s,x_mm,y_mm,speed_mm_s,wanted_n,asked_n,felt_n,voltage_v_rms,dac_code,flags\n";

/// A row of `felt.csv`. What is not known is `None`, an empty cell. Frictions are totals.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FeltRow {
    /// Time since the scene began to play, s.
    pub t_s: f64,
    /// The finger's true place from the left edge of the screen, mm.
    pub x_mm: Option<f64>,
    /// The finger's true place from the top edge of the screen, mm.
    pub y_mm: Option<f64>,
    /// The finger's true speed, mm/s.
    pub speed_mm_s: Option<f64>,
    /// Friction that the scene wants there, N.
    pub wanted_n: Option<f64>,
    /// Friction that the board asked its inverse for, N.
    pub asked_n: Option<f64>,
    /// Friction that the finger felt, N.
    pub felt_n: Option<f64>,
    /// Rms voltage of the envelope, V.
    pub voltage_v_rms: Option<f64>,
    /// Code that went to the DAC.
    pub dac_code: Option<i16>,
    /// What limited the board.
    pub flags: Option<Flags>,
}

/// Writes `felt.csv` while the scene plays.
///
/// Numbers have fixed decimals: a microsecond, a tenth of a micrometre, a micrometre a second, a nanonewton, a tenth
/// of a millivolt. Flags are names joined by `+`, or `none`. Lines end in a line feed.
#[derive(Debug)]
pub struct FeltCsv {
    path: PathBuf,
    writer: BufWriter<File>,
}

impl FeltCsv {
    /// Creates the file, or empties it, and writes the header row.
    pub fn create(path: &Path) -> Result<Self, OutputError> {
        let file = File::create(path).map_err(|source| OutputError::File { path: path.to_owned(), source })?;
        let mut csv = Self { path: path.to_owned(), writer: BufWriter::new(file) };
        csv.put(HEADER)?;
        Ok(csv)
    }

    /// Writes a row.
    pub fn write(&mut self, row: &FeltRow) -> Result<(), OutputError> {
        self.put(row)
    }

    /// Writes what is held back so far.
    pub fn flush(&mut self) -> Result<(), OutputError> {
        self.writer.flush().map_err(|source| OutputError::File { path: self.path.clone(), source })
    }

    /// Writes what is still held back. Dropping does it as well, and hides errors.
    pub fn finish(mut self) -> Result<(), OutputError> {
        self.writer.flush().map_err(|source| OutputError::File { path: self.path, source })
    }

    fn put(&mut self, text: impl Display) -> Result<(), OutputError> {
        write!(self.writer, "{text}").map_err(|source| OutputError::File { path: self.path.clone(), source })
    }
}

impl Display for FeltRow {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let cell =
            |value: Option<f64>, decimals: usize| Cell { value: value.filter(|value| value.is_finite()), decimals };
        write!(
            formatter,
            "{},{},{},{},{},{},{},{},",
            cell(Some(self.t_s), 6),
            cell(self.x_mm, 4),
            cell(self.y_mm, 4),
            cell(self.speed_mm_s, 3),
            cell(self.wanted_n, 9),
            cell(self.asked_n, 9),
            cell(self.felt_n, 9),
            cell(self.voltage_v_rms, 4)
        )?;
        if let Some(code) = self.dac_code {
            write!(formatter, "{code}")?;
        }
        formatter.write_str(",")?;
        if let Some(flags) = self.flags {
            write_flags(formatter, flags)?;
        }
        formatter.write_str("\n")
    }
}

fn write_flags(formatter: &mut fmt::Formatter<'_>, flags: Flags) -> fmt::Result {
    let mut joint = "";
    for name in flags.names() {
        write!(formatter, "{joint}{name}")?;
        joint = "+";
    }
    let unnamed = flags.unnamed().0;
    if unnamed != 0 {
        // Flags of newer firmware.
        write!(formatter, "{joint}0x{unnamed:04x}")?;
    } else if flags.0 == 0 {
        formatter.write_str("none")?;
    }
    Ok(())
}

/// A number with fixed decimals, zero never with a minus; or nothing.
struct Cell {
    value: Option<f64>,
    decimals: usize,
}

impl Display for Cell {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Some(value) = self.value else { return Ok(()) };
        let half_step = 0.5 / 10f64.powi(self.decimals as i32);
        let value = if value.abs() < half_step { 0.0 } else { value };
        write!(formatter, "{value:.*}", self.decimals)
    }
}
