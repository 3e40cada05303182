//! The `frixel` command: plays friction textures on a board or on the simulator. `frixel help` says what it can do.
#![forbid(unsafe_code)]

mod commands;

use std::process::ExitCode;

use commands::Cli;

fn main() -> ExitCode {
    let cli = match Cli::read() {
        Ok(cli) => cli,
        Err(code) => return code,
    };
    match cli.run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("frixel: {error}");
            ExitCode::FAILURE
        }
    }
}
