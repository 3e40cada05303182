//! The `frixel` command. `frixel help` lists what it can do.
#![forbid(unsafe_code)]

use std::process::ExitCode;

fn main() -> ExitCode {
    frixel::main()
}
