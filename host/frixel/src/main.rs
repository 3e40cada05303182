//! The `frixel` command. `frixel help` lists its commands.
#![forbid(unsafe_code)]

use std::process::ExitCode;

fn main() -> ExitCode {
    frixel::main()
}
