//! The CSV files of a play: `felt.csv` has the friction under the finger, `forces.csv` what a sensor
//! under the screen measured, and `events.csv` the events of the board.

use std::fmt::{self, Display};
use std::io::Write;
use std::marker::PhantomData;

use anyhow::Result;
use frixel_felt::recorder::{FeltRow, FlagNames};

use super::decimals::Decimals;
use frixel_files::FileWriter;
use frixel_lab::calibration::ForceRow;

/// A row of a CSV file. `docs/design/outputs.md` describes the columns.
pub(crate) trait CsvRow {
    /// The column names, separated by commas.
    const HEADER: &'static str;

    /// Writes the cells, separated by commas. An unknown value is an empty cell.
    fn write_cells(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result;
}

/// A CSV file that is written row by row. Lines end in a line feed.
#[derive(Debug)]
pub(crate) struct CsvFile<R> {
    writer: FileWriter,
    /// Code of the participant, for a last column, if the rows are from a real board.
    participant: Option<String>,
    rows: PhantomData<R>,
}

/// `felt.csv`.
///
/// Numbers have a fixed number of decimals; their resolutions are a microsecond, a tenth of a micrometre, a micrometre
/// per second, a nanonewton and a tenth of a millivolt. Flags are names joined by `+`, or `none`.
pub(crate) type FeltCsv = CsvFile<FeltRow>;

/// `events.csv`.
pub(crate) type EventCsv = CsvFile<EventRow>;

/// `forces.csv`, which `frixel finger calibrate` reads.
pub(crate) type ForcesCsv = CsvFile<ForceRow>;

/// A row of `events.csv`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct EventRow {
    /// Time at which the event was observed, s.
    pub t_s: f64,
    /// The state that the board entered, `host-silent` or `time-dropped`.
    pub event: &'static str,
    /// Time at which the board had received the last complete frame from a host, s.
    pub last_frame_t_s: f64,
    /// Time that a virtual board dropped in this event, s.
    pub dropped_s: Option<f64>,
}

impl<R: CsvRow> CsvFile<R> {
    /// Writes the header row into a file.
    pub(crate) fn new(writer: FileWriter) -> Result<Self> {
        Self::start(writer, None)
    }

    /// As [`Self::new`], for a play on a real board, which the column `participant` marks even without a code.
    pub(crate) fn of_person(writer: FileWriter, code: Option<&str>) -> Result<Self> {
        Self::start(writer, Some(code.unwrap_or_default().to_owned()))
    }

    fn start(writer: FileWriter, participant: Option<String>) -> Result<Self> {
        let mut csv = Self { writer, participant, rows: PhantomData };
        let last = csv.participant.as_ref().map_or("", |_| ",participant");
        csv.write_line(format_args!("{}{last}", R::HEADER))?;
        csv.flush()?;
        Ok(csv)
    }

    /// Writes one row.
    pub(crate) fn write(&mut self, row: &R) -> Result<()> {
        match &self.participant {
            None => self.write_line(Cells(row)),
            Some(code) => self.write_line(format!("{},{code}", Cells(row))),
        }
    }

    /// Writes the buffered rows to the file.
    pub(crate) fn flush(&mut self) -> Result<()> {
        Ok(self.writer.flush()?)
    }

    /// The file, which the caller commits.
    pub(crate) fn into_writer(self) -> FileWriter {
        self.writer
    }

    fn write_line(&mut self, line: impl Display) -> Result<()> {
        Ok(writeln!(self.writer, "{line}")?)
    }
}

impl CsvRow for FeltRow {
    const HEADER: &'static str = "t_s,x_mm,y_mm,speed_mm_s,reference_n,commanded_n,felt_n,voltage_v_rms,dac_code,flags";

    fn write_cells(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let cell =
            |value: Option<f64>, decimals: u32| Cell { value: value.filter(|value| value.is_finite()), decimals };
        write!(
            formatter,
            "{},{},{},{},{},{},{},{},",
            cell(Some(self.t_s), 6),
            cell(self.x_mm, 4),
            cell(self.y_mm, 4),
            cell(self.speed_mm_s, 3),
            cell(self.reference_n, 9),
            cell(self.commanded_n, 9),
            cell(self.felt_n, 9),
            cell(self.voltage_v_rms, 4)
        )?;
        if let Some(code) = self.dac_code {
            write!(formatter, "{code}")?;
        }
        formatter.write_str(",")?;
        self.flags.map_or(Ok(()), |flags| write!(formatter, "{}", FlagNames(flags)))
    }
}

impl CsvRow for EventRow {
    const HEADER: &'static str = "t_s,event,last_frame_t_s,dropped_s";

    fn write_cells(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { t_s, event, last_frame_t_s, dropped_s } = *self;
        write!(formatter, "{t_s:.6},{event},{last_frame_t_s:.6},{}", Cell { value: dropped_s, decimals: 6 })
    }
}

impl CsvRow for ForceRow {
    const HEADER: &'static str = "time_s,normal_force_n,friction_n";

    fn write_cells(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { time_s, normal_force_n, friction_n } = self;
        write!(formatter, "{time_s:.6},{normal_force_n:.9},{friction_n:.9}")
    }
}

/// Displays the cells of a row.
struct Cells<'r, R>(&'r R);

impl<R: CsvRow> Display for Cells<'_, R> {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.write_cells(formatter)
    }
}

/// Displays a number with a fixed number of decimals and zero without a minus sign, or an empty cell.
struct Cell {
    value: Option<f64>,
    decimals: u32,
}

impl Display for Cell {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Some(value) = self.value else { return Ok(()) };
        let half_step = 0.5 / 10f64.powi(self.decimals as i32);
        let value = if value.abs() < half_step { 0.0 } else { value };
        Decimals { value, decimals: self.decimals }.fmt(formatter)
    }
}
