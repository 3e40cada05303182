//! Checks that the crates compile for other platforms: WebAssembly, Windows, macOS. That scenes have the same bits in
//! WebAssembly is checked in the studio's page (`studio_tests.rs`).

use std::process::Command;

use crate::command::{add_target, cargo_in, run};

const WASM: &str = "wasm32-unknown-unknown";
/// Targets that the whole command compiles for. Functions that need a pseudo-terminal fail there at run time.
const COMMAND_TARGETS: [&str; 2] = ["x86_64-pc-windows-gnu", "aarch64-apple-darwin"];
/// The crates for use in a web page: they use no clocks, files, threads or processes. The `clippy.toml` of each
/// disallows these.
const WASM_CRATES: [&str; 3] = ["frixel-scene", "frixel-driver", "frixel-hil-sim"];

/// Runs all checks of this module.
pub(crate) fn check() -> Result<(), String> {
    page_crates()?;
    for target in COMMAND_TARGETS {
        add_target(target)?;
        run(&format!("command for {target}"), &mut cargo(&["check", "--package", "frixel", "--target", target]))?;
    }
    Ok(())
}

/// Compiles the crates for web pages for WebAssembly, with clippy's disallowed types and methods as errors.
fn page_crates() -> Result<(), String> {
    add_target(WASM)?;
    let mut arguments = vec!["clippy", "--target", WASM, "--no-default-features", "--lib"];
    arguments.extend(WASM_CRATES.iter().flat_map(|name| ["--package", name]));
    arguments.extend(["--", "-D", "warnings"]);
    run("crates of the page for WebAssembly", &mut cargo(&arguments))
}

fn cargo(arguments: &[&str]) -> Command {
    let mut command = cargo_in(".");
    let (subcommand, rest) = arguments.split_first().unwrap_or((&"", &[]));
    command.args([subcommand, "--locked"]).args(rest);
    command
}
