//! Prints the hash of what a finger feels on bundled scenes, as this machine computes it.
#![forbid(unsafe_code)]

use std::process::ExitCode;

fn main() -> ExitCode {
    match frixel_wasm_check::scenes_hash() {
        Ok(hash) => {
            println!("{hash:016x}");
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("frixel-wasm-check: {error}");
            ExitCode::FAILURE
        }
    }
}
