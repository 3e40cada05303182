//! `frixel record`: the way of a finger on a board, as a stroke file.

use std::fmt::Display;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::PathBuf;
use std::time::Duration;

use clap::Args;
use frixel_driver::{DEFAULT_BAUD, Device, Event, SerialLink};
use frixel_scene::recorder::Observation;

use super::error::CommandError;
use super::interrupt::Interrupt;
use super::terminal::{note, print_line};
use super::waiting;

/// Rows a second.
const ROWS_HZ: u32 = 200;
/// Longest time between two looks for Ctrl-C.
const STEP: Duration = Duration::from_millis(50);

#[derive(Debug, Args)]
pub(super) struct RecordArgs {
    /// Path of the board's serial port.
    #[arg(long)]
    port: String,
    /// The stroke, a CSV file with the columns `t_s,x_mm,y_mm`, for `frixel play --stroke`.
    #[arg(short, long, value_name = "FILE.csv")]
    output: PathBuf,
    /// How long to record. Without it, until Ctrl-C.
    #[arg(long, value_name = "S", value_parser = super::argument::seconds)]
    seconds: Option<f64>,
}

pub(super) fn run(args: &RecordArgs) -> Result<(), CommandError> {
    let interrupt = Interrupt::watch()?;
    let device = Device::connect(SerialLink::open(&args.port, DEFAULT_BAUD)?)?;
    let mut device = waiting::watch(device, &interrupt);
    let mut file = Rows::create(args, device.hello().tick_hz)?;
    device.subscribe(device.hello().tick_hz / ROWS_HZ)?;
    note("slide a finger over the screen; Ctrl-C ends the record");
    let end = args.seconds.map(|seconds| device.now() + Duration::from_secs_f64(seconds));
    let mut written = Ok(());
    while !interrupt.is_requested() && end.is_none_or(|end| device.now() < end) && written.is_ok() {
        device.wait(STEP, &mut |event| {
            if let (Event::Telemetry(telemetry), Ok(())) = (event, &written) {
                written = file.add(&Observation::from_telemetry(&telemetry));
            }
        })?;
    }
    device.subscribe(0)?;
    written?;
    file.finish()
}

/// The file, from the first touch on.
struct Rows {
    path: PathBuf,
    writer: BufWriter<File>,
    tick_hz: f64,
    first_tick: Option<u32>,
    is_down: bool,
    touched: u64,
}

impl Rows {
    fn create(args: &RecordArgs, tick_hz: u32) -> Result<Self, CommandError> {
        let path = args.output.clone();
        let file = File::create(&path).map_err(CommandError::writing(&path))?;
        let writer = BufWriter::new(file);
        let mut rows = Self { path, writer, tick_hz: f64::from(tick_hz), first_tick: None, is_down: false, touched: 0 };
        rows.write("t_s,x_mm,y_mm")?;
        Ok(rows)
    }

    /// Adds a row while a finger is there, and one without a place when it leaves.
    fn add(&mut self, observation: &Observation) -> Result<(), CommandError> {
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

    fn write(&mut self, line: impl Display) -> Result<(), CommandError> {
        writeln!(self.writer, "{line}").map_err(CommandError::writing(&self.path))
    }

    fn finish(mut self) -> Result<(), CommandError> {
        self.writer.flush().map_err(CommandError::writing(&self.path))?;
        if self.touched == 0 {
            return Err(CommandError::NothingRecorded { path: self.path });
        }
        let seconds = self.touched as f64 / f64::from(ROWS_HZ);
        print_line(format_args!("  {:<16} {}, {seconds:.1} s of touch", "wrote", self.path.display()))
    }
}
