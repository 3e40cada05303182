//! Checks that the crates compile for other platforms: WebAssembly, Windows, macOS. That scenes have the same bits in
//! WebAssembly is checked in the studio's page (`studio_tests.rs`).

use crate::command::{WASM, cargo_in, run};
use crate::needs::Need;
use crate::studio;

const WINDOWS: &str = "x86_64-pc-windows-gnu";
const MACOS: &str = "aarch64-apple-darwin";
/// What [`other_systems`] needs.
pub(crate) const NEEDS: [Need; 2] = [Need::Target(WINDOWS), Need::Target(MACOS)];
/// The crates of the page whose code differs for WebAssembly. The `clippy.toml` of these, and of those that they
/// depend on, disallows clocks, files, threads and processes on every platform.
const WASM_CRATES: [&str; 3] = ["frixel-hil-sim", "frixel-lab", "frixel-studio"];

/// Compiles the whole command for Windows and macOS. Functions that need a pseudo-terminal fail there at run time.
pub(crate) fn other_systems() -> Result<(), String> {
    for target in [WINDOWS, MACOS] {
        let check = ["check", "--locked", "--package", "frixel", "--target", target];
        run(&format!("command for {target}"), cargo_in(".").args(check))?;
    }
    Ok(())
}

/// Compiles the crates of the page for WebAssembly, with clippy's warnings as errors.
pub(crate) fn page_crates() -> Result<(), String> {
    // In the profile of the page, whose build shares what the compiler itself takes.
    let mut arguments = vec!["clippy", "--locked", "--target", WASM, "--profile", studio::PROFILE, "--lib"];
    arguments.extend(WASM_CRATES.iter().flat_map(|name| ["--package", name]));
    arguments.extend(["--", "-D", "warnings"]);
    run("crates of the page for WebAssembly", cargo_in(".").args(arguments))
}
