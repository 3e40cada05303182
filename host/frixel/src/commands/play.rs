//! `frixel play`: a scene on the simulator or on a board.

mod bars;
mod board;
mod emulated;
mod live;
mod simulator;
mod watch;

use std::path::{Path, PathBuf};

use frixel::output::{FeltCsv, Report};
use frixel_scene::Program;

use bars::Bars;

use super::PlayArgs;
use super::error::CommandError;

pub(super) fn run(args: &PlayArgs) -> Result<(), CommandError> {
    let Played { report, files, failure } = match args.port.as_str() {
        "sim" => simulator::play(args)?,
        "qemu" => emulated::play(args)?,
        _ => board::play(args)?,
    };
    if args.json {
        println!("{}", report.to_json());
    } else {
        print!("{}", report.summary());
        for file in files {
            println!("  {:<16} {}", "wrote", file.display());
        }
    }
    failure.map_or(Ok(()), Err)
}

/// What came of playing.
struct Played {
    report: Report,
    files: Vec<PathBuf>,
    /// Why it ended before its time, where that is a failure. What was played until then is in the report and the files.
    failure: Option<CommandError>,
}

/// A board in virtual time has played before anybody saves anything.
fn refuse_watch(args: &PlayArgs) -> Result<(), CommandError> {
    if args.watch { Err(CommandError::WatchInVirtualTime { port: args.port.clone() }) } else { Ok(()) }
}

/// Says what the compiler has to say of a scene: conversions, roundings.
fn tell_notes(program: &Program) {
    for note in &program.notes {
        eprintln!("{note}");
    }
}

/// Creates `felt.csv` in a folder that is made when it is not there.
fn create_felt_csv(folder: &Path) -> Result<(FeltCsv, PathBuf), CommandError> {
    std::fs::create_dir_all(folder).map_err(CommandError::writing(folder))?;
    let path = folder.join("felt.csv");
    Ok((FeltCsv::create(&path)?, path))
}

/// Ticks between two rows of `felt.csv`.
fn ticks_per_row(csv_hz: u32, tick_hz: u32) -> Result<u32, CommandError> {
    let divides = |rate: &u32| tick_hz.is_multiple_of(*rate);
    if csv_hz > 0 && divides(&csv_hz) {
        return Ok(tick_hz / csv_hz);
    }
    let below = (1..csv_hz.min(tick_hz)).rev().find(divides);
    let above = (csv_hz..=tick_hz).find(divides);
    let nearest: Vec<String> = [below, above].iter().flatten().map(u32::to_string).collect();
    Err(CommandError::CsvUneven { asked: csv_hz, tick_hz, nearest: nearest.join(" or ") })
}

/// Refuses a time in which not one tick passes.
fn check_seconds(seconds: f64, tick_hz: u32) -> Result<(), CommandError> {
    let tick_s = 1.0 / f64::from(tick_hz);
    if seconds < tick_s { Err(CommandError::TooShort { seconds, tick_s }) } else { Ok(()) }
}
