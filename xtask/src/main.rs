//! The developer's commands, through the cargo alias `cargo xtask`.

use std::env;
use std::process::{Command, ExitCode};

/// Target of the boards; the crates that run on them are built for it.
const BOARD_TARGET: &str = "thumbv7em-none-eabihf";
/// Crates that run on a board.
const BOARD_CRATES: [&str; 3] = ["frixel-model", "frixel-wire", "frixel-render"];

const USAGE: &str = "\
cargo xtask test    format, lints, cross-builds, all tests, docs: what CI runs
";

fn main() -> ExitCode {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let result = match arguments.as_slice() {
        ["test"] => test(),
        _ => Err(format!("no such command: {}\n{USAGE}", arguments.join(" "))),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("xtask: {message}");
            ExitCode::FAILURE
        }
    }
}

/// Everything that has to hold before a change is taken.
fn test() -> Result<(), String> {
    cargo("format", &["fmt", "--all", "--check"], &[])?;
    cargo("lints", &["clippy", "--workspace", "--all-targets", "--locked", "--", "-D", "warnings"], &[])?;
    cross_build()?;
    cargo("tests", &["test", "--workspace", "--locked"], &[])?;
    cargo("docs", &["doc", "--workspace", "--no-deps", "--locked"], &[("RUSTDOCFLAGS", "-D warnings")])
}

/// Builds what runs on a board for the board, with warnings as errors, in a target folder of its own so that its
/// flags do not rebuild everything else.
fn cross_build() -> Result<(), String> {
    add_target(BOARD_TARGET)?;
    let mut arguments = vec!["build", "--locked", "--target", BOARD_TARGET, "--target-dir", "target/cross"];
    for name in BOARD_CRATES {
        arguments.extend(["--package", name]);
    }
    cargo("cross-build", &arguments, &[("RUSTFLAGS", "-D warnings")])
}

fn add_target(target: &str) -> Result<(), String> {
    run("rustup target", Command::new("rustup").args(["target", "add", target]))
}

fn cargo(name: &str, arguments: &[&str], variables: &[(&str, &str)]) -> Result<(), String> {
    let program = env::var("CARGO").unwrap_or_else(|_| "cargo".into());
    run(name, Command::new(program).args(arguments).envs(variables.iter().copied()))
}

fn run(name: &str, command: &mut Command) -> Result<(), String> {
    eprintln!("== {name}");
    match command.status() {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(format!("{name} failed ({status}): {command:?}")),
        Err(error) => Err(format!("{name} could not be started ({error}): {command:?}")),
    }
}
