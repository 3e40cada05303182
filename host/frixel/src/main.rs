//! The `frixel` command: plays friction textures on a board or on the simulator. `frixel help` lists the commands.
#![forbid(unsafe_code)]

mod commands;

use std::process::ExitCode;

use clap::Parser;
use commands::Cli;

/// Exits with 2 when the command line is invalid, and with 1 when the command fails.
fn main() -> ExitCode {
    let cli = Cli::try_parse().unwrap_or_else(|error| commands::with_nested_tip(error).exit());
    match cli.run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            commands::report_error(&error);
            ExitCode::FAILURE
        }
    }
}
