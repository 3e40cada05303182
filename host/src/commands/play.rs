//! `frixel play`: a scene on the simulator or on a board.

mod bars;
mod board;
mod simulator;

use std::path::{Path, PathBuf};

use frixel::output::{FeltCsv, FeltRow};
use frixel::scene::Program;

use bars::Bars;

use super::PlayArgs;
use super::error::CommandError;

pub(super) fn run(args: &PlayArgs) -> Result<(), CommandError> {
    let (report, files) = if args.port == "sim" { simulator::play(args)? } else { board::play(args)? };
    if args.json {
        println!("{}", report.to_json());
    } else {
        print!("{}", report.summary());
        for file in files {
            println!("  {:<16} {}", "wrote", file.display());
        }
    }
    Ok(())
}

/// Says what the compiler has to say of a scene: conversions, roundings.
fn tell_notes(program: &Program) {
    for note in &program.notes {
        eprintln!("{note}");
    }
}

/// Writes `felt.csv` into a folder that is made when it is not there.
fn write_felt_csv(folder: &Path, rows: &[FeltRow]) -> Result<PathBuf, CommandError> {
    std::fs::create_dir_all(folder).map_err(CommandError::writing(folder))?;
    let path = folder.join("felt.csv");
    let mut csv = FeltCsv::create(&path)?;
    rows.iter().try_for_each(|row| csv.write(row))?;
    csv.finish()?;
    Ok(path)
}
