//! A simulated board with the wires of the self-test, on a pseudo-terminal, in real time: for `frixel board selftest
//! --wires --port PATH` without a board.
//!
//!     cargo run --release -p frixel-hil-sim --example looped_board               # in order
//!     cargo run --release -p frixel-hil-sim --example looped_board latch-late    # with one thing wrong
#![allow(clippy::disallowed_types, clippy::disallowed_methods, reason = "it runs in real time, with a terminal")]

use std::process::ExitCode;

use frixel_hil_sim::looped_board::Defect;

#[cfg(unix)]
fn main() -> ExitCode {
    use frixel_hil_sim::looped_board::{LoopedRig, TerminalPort};

    let Some(wrong) = wrong() else {
        let names: Vec<&str> = Defect::ALL.iter().map(|(name, _)| *name).collect();
        eprintln!("say what is wrong, one of: {}", names.join(", "));
        return ExitCode::FAILURE;
    };
    match TerminalPort::open() {
        Ok(port) => {
            println!("{}", port.path());
            match LoopedRig::new(port, wrong).run() {
                Ok(wrong) => println!("the self-test has ended; measurements that are not right: {wrong}"),
                Err(stop) => println!("the self-test has stopped: {stop}"),
            }
            ExitCode::SUCCESS
        }
        Err(error) => {
            eprintln!("no pseudo-terminal: {error}");
            ExitCode::FAILURE
        }
    }
}

#[cfg(not(unix))]
fn main() -> ExitCode {
    eprintln!("there are no pseudo-terminals here");
    ExitCode::FAILURE
}

/// The board's defect, named by the first argument.
fn wrong() -> Option<Defect> {
    std::env::args().nth(1).map_or(Some(Defect::Nothing), |name| Defect::named(&name))
}
