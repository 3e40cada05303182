//! `frixel play`: a scene on the simulator or on a board.

mod bars;
mod board;
mod simulator;

use std::path::{Path, PathBuf};

use frixel::output::{FeltCsv, Report};
use frixel::scene::Program;

use bars::Bars;

use super::PlayArgs;
use super::error::CommandError;

pub(super) fn run(args: &PlayArgs) -> Result<(), CommandError> {
    let Played { report, files, failure } =
        if args.port == "sim" { simulator::play(args)? } else { board::play(args)? };
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
