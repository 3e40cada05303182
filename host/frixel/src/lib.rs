//! The `frixel` command: plays friction textures on a board or on the simulator, records them, draws charts and writes
//! reports.
#![forbid(unsafe_code)]

mod commands;
mod input;
pub mod output;
mod report;
pub mod rigs;
pub mod scene_file;
pub mod stream;

use std::process::ExitCode;

use clap::Parser;

use commands::Cli;

/// Runs the `frixel` command with the arguments of this process.
///
/// Exits with 2 when the command line is invalid; returns 1 when the command fails.
pub fn main() -> ExitCode {
    let cli = Cli::try_parse().unwrap_or_else(|error| commands::with_tip(error).exit());
    match cli.run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            commands::report_error(&error);
            ExitCode::FAILURE
        }
    }
}
