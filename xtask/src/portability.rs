//! Checks that the crates compile and run on other platforms: WebAssembly, Windows, macOS.

use std::env;
use std::process::Command;

use crate::command::{add_target, cargo_in, root, run, text_of};
use crate::outcome::{Outcome, skip};

const WASM: &str = "wasm32-unknown-unknown";
/// Targets that the whole command compiles for. Functions that need a pseudo-terminal fail there at run time.
const COMMAND_TARGETS: [&str; 2] = ["x86_64-pc-windows-gnu", "aarch64-apple-darwin"];
/// The crates for use in a web page: they use no clocks, files, threads or processes. The `clippy.toml` of each
/// disallows these.
const WASM_CRATES: [&str; 3] = ["frixel-scene", "frixel-driver", "frixel-hil-sim"];
/// The crate that plays scenes with those three crates, natively or in WebAssembly.
const WASM_CHECK: &str = "frixel-wasm-check";

/// Runs all checks of this module.
pub(crate) fn check() -> Result<Outcome, String> {
    page_crates()?;
    for target in COMMAND_TARGETS {
        add_target(target)?;
        run(&format!("command for {target}"), &mut cargo(&["check", "--package", "frixel", "--target", target]))?;
    }
    same_bits_in_wasm()
}

/// Compiles the crates for web pages for WebAssembly, with clippy's disallowed types and methods as errors.
fn page_crates() -> Result<(), String> {
    add_target(WASM)?;
    let mut arguments = vec!["clippy", "--target", WASM, "--no-default-features", "--lib"];
    arguments.extend(WASM_CRATES.iter().flat_map(|name| ["--package", name]));
    arguments.extend(["--", "-D", "warnings"]);
    run("crates of the page for WebAssembly", &mut cargo(&arguments))
}

/// Plays bundled scenes in node and natively: every friction, voltage and DAC code must be equal.
fn same_bits_in_wasm() -> Result<Outcome, String> {
    if Command::new("node").arg("--version").output().is_err() {
        return skip("scenes in WebAssembly", "node is not installed (Debian: `apt-get install nodejs`)".to_owned());
    }
    run("scenes for WebAssembly", &mut cargo(&["build", "--package", WASM_CHECK, "--lib", "--target", WASM]))?;
    let target_folder = env::var_os("CARGO_TARGET_DIR").map_or_else(|| root().join("target"), Into::into);
    let module = target_folder.join(WASM).join("debug/frixel_wasm_check.wasm");
    let native = text_of(&mut cargo(&["run", "--quiet", "--package", WASM_CHECK]))?;
    let wasm = text_of(Command::new("node").arg(root().join("host/wasm-check/run.mjs")).arg(module))?;
    eprintln!("hash of the scenes: {} natively, {} in WebAssembly", native.trim(), wasm.trim());
    if native == wasm {
        Ok(Outcome::Passed)
    } else {
        Err("what a finger feels in WebAssembly differs from what it feels natively".into())
    }
}

fn cargo(arguments: &[&str]) -> Command {
    let mut command = cargo_in(".");
    let (subcommand, rest) = arguments.split_first().unwrap_or((&"", &[]));
    command.args([subcommand, "--locked"]).args(rest);
    command
}
