//! The `frixel` command: plays friction textures on a board or on the simulator. `frixel help` says what it can do.
#![forbid(unsafe_code)]

mod commands;

use std::process::ExitCode;

use clap::Parser;
use commands::Cli;

/// Exits with 2 where the command line is not understood, with 1 where the command fails.
fn main() -> ExitCode {
    match Cli::parse().run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("frixel: {error}");
            ExitCode::FAILURE
        }
    }
}
