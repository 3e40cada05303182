//! Prints the hash of the friction that a finger feels on bundled scenes, computed natively.
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
