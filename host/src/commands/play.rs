//! `frixel play`: a scene on the simulator or on a board.

mod bars;
mod board;
mod simulator;

use std::path::{Path, PathBuf};

use frixel::output::{FeltRow, FeltWriter};
use frixel::scene::Program;

use bars::Bars;

use super::PlayArgs;
use super::error::CommandError;
use super::summary::Summary;

pub(super) fn run(args: &PlayArgs) -> Result<(), CommandError> {
    let summary = if args.port == "sim" { simulator::play(args)? } else { board::play(args)? };
    if args.json {
        println!("{}", summary.to_json());
    } else {
        print!("{}", summary.to_text());
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
    let path = folder.join("felt.csv");
    let write = || {
        std::fs::create_dir_all(folder)?;
        let mut writer = FeltWriter::new(std::io::BufWriter::new(std::fs::File::create(&path)?))?;
        rows.iter().try_for_each(|row| writer.write(row))?;
        writer.flush()
    };
    write().map_err(CommandError::file(&path))?;
    Ok(path)
}
