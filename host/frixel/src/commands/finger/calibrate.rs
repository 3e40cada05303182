//! `frixel finger calibrate`: records the data that `frixel finger fit` needs.

mod forces;
mod plan;
mod recorded;

use std::path::{Path, PathBuf};

use anyhow::Result;
use clap::Args;
use frixel_lab::calibration::{align, read_board, write_csv};
use frixel_lab::recording::{Metadata, calibration_fields};
use frixel_wire::hello::Hello;

use crate::commands::argument::{participant, whole};
use crate::commands::error::cut_off;
use crate::commands::interrupt::Interrupt;
use crate::commands::parquet;
use crate::commands::terminal::say;
use frixel_files::{Inputs, OutputFile};
use recorded::Recorded;

/// Advice on how to keep the board's rows of an interrupted recording.
const CUT_OFF: &str = "add --finish, and the --forces of that run unless they came on standard input, to keep it";

#[derive(Debug, Args)]
pub(in crate::commands) struct CalibrateArgs {
    /// `sim` for the simulator in this process, or the path of a board's serial port.
    #[arg(long, default_value = "sim")]
    port: String,
    /// The recording, for `frixel finger fit`: CSV, or Parquet if its name ends in `.parquet`. Until the end, a board's
    /// reports are CSV in a file of that name with `.partial` added.
    #[arg(short, long, value_name = "DATA.csv")]
    output: PathBuf,
    /// Code of the participant, for a Parquet file: letters, digits, `-`, `_` and `.`, not a name.
    #[arg(long, value_name = "CODE", value_parser = participant)]
    participant: Option<String>,
    /// Replace an earlier recording.
    #[arg(long)]
    overwrite: bool,
    /// Play nothing; join the strokes of a recording that was cut off with their forces.
    #[arg(long)]
    finish: bool,
    /// Forces of a sensor during the run: CSV with the columns `time_s,normal_force_n,friction_n`, on any clock; `-`
    /// for standard input. A file must exist when the run begins, and is read when it is over. The simulator has a
    /// sensor of its own; `frixel sim` writes what the sensor under its screen measures to forces.csv.
    #[arg(long, value_name = "FILE.csv")]
    forces: Option<PathBuf>,
    /// Highest voltage, in volts rms, at most 150. Default: 150, or the board's limit if that is lower.
    #[arg(long, value_name = "V_RMS", value_parser = plan::voltage)]
    voltage: Option<f64>,
    /// Number of strokes, 9 to 360. Each takes 1.8 s; the interval narrows with the root of their number.
    #[arg(long, value_name = "N", default_value_t = 36, value_parser = whole(9..=360_u16))]
    strokes: u16,
    /// Seed of a simulated person. Default: the example finger.
    #[arg(long, value_name = "N")]
    finger_seed: Option<u64>,
    /// Seed of the half-periods, and of the simulator's random numbers.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Let a board that is not a simulator drive its electrode.
    #[arg(long)]
    arm: bool,
}

pub(super) fn run(args: &CalibrateArgs) -> Result<()> {
    parquet::check_output(&args.output, args.participant.as_deref())?;
    let inputs = Inputs::new(&args.forces);
    let recording = OutputFile::recording(&args.output, "-o", &inputs, args.overwrite)?;
    if args.finish {
        return finish(args, &recording).map_err(|error| cut_off(&recording, CUT_OFF, error));
    }
    let interrupt = Interrupt::watch()?;
    // A pipe can be opened only once.
    let partial = recording.is_file().then(|| recording.begin_recording(CUT_OFF)).transpose()?;
    // A file of forces that is missing or invalid ends the command before the run, not after it.
    if let Some(path) = args.forces.as_deref().filter(|path| *path != Path::new("-")) {
        forces::read(path)?;
    }
    let recorded = if args.port == "sim" {
        recorded::on_simulator(args, &recording, &interrupt).map(|recorded| (recorded, None))
    } else {
        recorded::on_port(args, &recording, &interrupt, partial).map(|(recorded, hello)| (recorded, Some(hello)))
    };
    let written = recorded.and_then(|(recorded, hello)| write(args, &recording, &recorded, hello.as_ref()));
    written.map_err(|error| cut_off(&recording, CUT_OFF, error))
}

/// Completes an interrupted recording from its rows.
fn finish(args: &CalibrateArgs, recording: &OutputFile) -> Result<()> {
    let (_partial, text) = recording.resume()?;
    let board = read_board(text.as_bytes())?;
    let copied = forces::copy(args)?.partial();
    let forces = forces::read(args.forces.as_deref().unwrap_or(&copied))?;
    write(args, recording, &(board, forces), None)
}

/// Joins the data of board and sensor, and writes them.
fn write(
    args: &CalibrateArgs,
    recording: &OutputFile,
    (board, forces): &Recorded,
    hello: Option<&Hello>,
) -> Result<()> {
    // Only a board's recording can be cut off: the simulator's file is written at the end.
    let is_simulated = !args.finish && args.port == "sim" || hello.is_some_and(|hello| hello.board.is_simulated());
    let rows = align(board, forces, is_simulated)?;
    let mut bytes = Vec::new();
    write_csv(&mut bytes, &rows)?;
    if parquet::is_parquet(&args.output) {
        let rig = if hello.is_none() && is_simulated { "sim" } else { "board" };
        let metadata = Metadata::new(rig, hello, is_simulated, args.participant.as_deref());
        parquet::write(recording, &bytes, calibration_fields(is_simulated), metadata)?;
    } else {
        recording.write(&bytes)?;
    }
    recording.discard_partial();
    forces::copy(args)?.discard_partial();
    let path = recording.path().display();
    say(recording, format_args!("  {:<16} {path}", "wrote"))?;
    let highest = rows.iter().map(|row| row.voltage_v_rms).fold(0.0, f64::max);
    let voltage = if highest < 145.0 { format!(" --voltage {highest:.0}") } else { String::new() };
    say(recording, format_args!("  {:<16} frixel finger fit {path}{voltage} -o finger.toml", "next"))
}
