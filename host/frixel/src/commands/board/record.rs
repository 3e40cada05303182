//! `frixel board record`: records the path of a finger on a board, as a stroke file.

use std::fmt::Display;
use std::io::Write;
use std::path::PathBuf;
use std::time::Duration;

use anyhow::{Result, anyhow, bail};
use clap::Args;
use frixel_driver::{Device, Event, Link};
use frixel_felt::recorder::Observation;
use frixel_files::{FileWriter, Inputs, OutputFile};
use frixel_lab::recording::{Metadata, stroke_fields};
use frixel_lab::table::{Column, Table, TableError};
use frixel_wire::hello::Hello;
use frixel_wire::message::telemetry_period_ticks;

use crate::commands::error::cut_off;
use crate::commands::interrupt::Interrupt;
use crate::commands::parquet;
use crate::commands::port;
use crate::commands::terminal::{note, say};
use crate::commands::waiting;

/// Rows a second.
const ROWS_HZ: u32 = 200;
/// Longest time between checks for Ctrl-C, and between writes to the file.
const STEP: Duration = Duration::from_millis(50);
/// Columns of the stroke file.
const HEADER: &str = "t_s,x_mm,y_mm";
/// How to keep the rows of a recording that was cut off.
const CUT_OFF: &str = "add --finish to keep them";

#[derive(Debug, Args)]
pub(in crate::commands) struct RecordArgs {
    /// Path of the board's serial port.
    #[arg(long, required_unless_present = "finish")]
    port: Option<String>,
    /// The stroke, a CSV file with the columns `t_s,x_mm,y_mm`, for `frixel play --stroke`; Parquet if its name ends in
    /// `.parquet`. Until the end, the rows are CSV in a file of that name with `.partial` added.
    #[arg(short, long, value_name = "FILE.csv")]
    output: PathBuf,
    /// Code of the participant, for a Parquet file: letters, digits, `-`, `_` and `.`, not a name.
    #[arg(long, value_name = "CODE", value_parser = crate::commands::argument::participant)]
    participant: Option<String>,
    /// Replace an earlier recording.
    #[arg(long)]
    overwrite: bool,
    /// Record nothing; complete a recording that was cut off from its rows.
    #[arg(long)]
    finish: bool,
    /// Duration. Default: until Ctrl-C.
    #[arg(long, value_name = "S", value_parser = crate::commands::argument::seconds)]
    seconds: Option<f64>,
}

pub(super) fn run(args: &RecordArgs) -> Result<()> {
    parquet::check_output(&args.output, args.participant.as_deref())?;
    let recording = OutputFile::recording(&args.output, "-o", &Inputs::default(), args.overwrite)?;
    if args.finish {
        let (writer, text) = recording.resume()?;
        let other = |error: TableError| {
            anyhow!(
                "{} is not a recorded stroke with t_s,x_mm,y_mm ({}): correct or delete the row, or record again with \
                 --overwrite",
                recording.partial().display(),
                error.found()
            )
        };
        return finish(args, &recording, writer, touched(&text).map_err(other)?, None);
    }
    // Without a port, the recording is finished above.
    let port = args.port.as_deref().unwrap_or_default();
    let interrupt = Interrupt::watch()?;
    let writer = recording.begin_recording(CUT_OFF)?;
    let device = Device::connect(port::open(port, &[])?)?;
    let mut device = waiting::watch(device, &interrupt);
    let mut rows = Rows::new(writer, device.hello().tick_hz)?;
    match record(args, &mut device, &interrupt, &mut rows) {
        Ok(()) => finish(args, &recording, rows.writer, rows.touched, Some(device.hello())),
        Err(error) => {
            drop(rows);
            Err(cut_off(&recording, CUT_OFF, error))
        }
    }
}

fn record<L: Link>(args: &RecordArgs, device: &mut Device<L>, interrupt: &Interrupt, rows: &mut Rows) -> Result<()> {
    device.subscribe(telemetry_period_ticks(device.hello().tick_hz, ROWS_HZ))?;
    let ends =
        args.seconds.map_or("Ctrl-C ends the recording".to_owned(), |seconds| format!("recording for {seconds} s"));
    note(format_args!("slide a finger over the screen; {ends}"));
    let end = args.seconds.map(|seconds| device.now() + Duration::from_secs_f64(seconds));
    while !interrupt.is_requested() && end.is_none_or(|end| device.now() < end) {
        let mut written = Ok(());
        device.wait(STEP, &mut |event| {
            if let (Event::Telemetry(telemetry), Ok(())) = (event, &written) {
                written = rows.add(&Observation::from_telemetry(&telemetry));
            }
        })?;
        written.and_then(|()| rows.flush())?;
    }
    Ok(device.subscribe(0)?)
}

/// Returns the number of rows with a touch. Fails on a row that no recording has: the file is from another command, or
/// a crash of the machine left zeros in it.
fn touched(text: &str) -> Result<u64, TableError> {
    let mut table = Table::new(text.as_bytes())?;
    let t = table.need(Column::new("t_s", "seconds"))?;
    let (x, y) = (table.need(Column::new("x_mm", "mm"))?, table.need(Column::new("y_mm", "mm"))?);
    let mut touched = 0;
    while let Some(row) = table.next_row()? {
        row.check_length()?;
        row.real(t)?;
        if row.real_if_known(x)?.is_some() || row.real_if_known(y)?.is_some() {
            row.real(x)?;
            row.real(y)?;
            touched += 1;
        }
    }
    Ok(touched)
}

/// Gives the file its name, as CSV or as Parquet.
fn finish(
    args: &RecordArgs,
    recording: &OutputFile,
    writer: FileWriter,
    touched: u64,
    board: Option<&Hello>,
) -> Result<()> {
    if touched == 0 {
        bail!(
            "nothing was recorded, because the board reported no finger: slide one over its screen while `frixel \
             board record` runs"
        );
    }
    if parquet::is_parquet(&args.output) {
        drop(writer);
        let (_rows, text) = recording.resume()?;
        let is_simulated = board.is_some_and(|hello| hello.board.is_simulated());
        let metadata = Metadata::new("board", board, is_simulated, args.participant.as_deref());
        parquet::write(recording, text.as_bytes(), stroke_fields(), metadata)?;
        recording.discard_partial();
    } else {
        writer.commit()?;
    }
    let seconds = touched as f64 / f64::from(ROWS_HZ);
    say(recording, format_args!("  {:<16} {}, {seconds:.1} s of touch", "wrote", recording.path().display()))
}

/// Writes the rows, from the first touch on.
struct Rows {
    writer: FileWriter,
    tick_hz: f64,
    first_tick: Option<u32>,
    is_down: bool,
    touched: u64,
}

impl Rows {
    fn new(writer: FileWriter, tick_hz: u32) -> Result<Self> {
        let mut rows = Self { writer, tick_hz: f64::from(tick_hz), first_tick: None, is_down: false, touched: 0 };
        rows.write(HEADER)?;
        Ok(rows)
    }

    /// Adds a row while a finger touches, and a row without a place when it lifts.
    fn add(&mut self, observation: &Observation) -> Result<()> {
        if observation.finger.is_none() && !self.is_down {
            return Ok(());
        }
        let first_tick = *self.first_tick.get_or_insert(observation.tick);
        let t_s = f64::from(observation.tick.wrapping_sub(first_tick)) / self.tick_hz;
        self.is_down = observation.finger.is_some();
        self.touched += u64::from(self.is_down);
        match observation.finger {
            Some(finger) => {
                let (x_mm, y_mm) = (1e3 * finger.x_m, 1e3 * finger.y_m);
                self.write(format_args!("{t_s:.6},{x_mm:.4},{y_mm:.4}"))
            }
            None => self.write(format_args!("{t_s:.6},,")),
        }
    }

    fn write(&mut self, line: impl Display) -> Result<()> {
        Ok(writeln!(self.writer, "{line}")?)
    }

    fn flush(&mut self) -> Result<()> {
        Ok(self.writer.flush()?)
    }
}
