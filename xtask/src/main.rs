//! The commands for developers, run through the cargo alias `cargo xtask`.

mod bench;
mod budgets;
mod check;
mod command;
mod licences;
mod outcome;
mod portability;
mod stages;
mod stamps;
mod studio;
mod studio_tests;
mod test_programs;

use std::env;
use std::process::ExitCode;

use bench::programs::{self, Pace};

const USAGE: &str = "\
cargo xtask test     format, lints, cross-builds, all tests, docs, budgets: what CI runs
cargo xtask bench    instructions and estimated cycles on emulated processors, and image sizes
         --bless     and writes down what each kind of layer costs, which compiler and board use
cargo xtask budgets  the same, held against budgets.toml, and random scenes against the loader's estimate for them
cargo xtask portability
                     the crates of a page for WebAssembly; the command for Windows and macOS
cargo xtask studio   the studio as one HTML file; its path is the last line
cargo xtask studio-test
                     the studio in a browser: needs node, npm and Chromium
cargo xtask soak     what takes too long for every change: every f32 through the tables, fits of 200
                     people, thousands of random scenes
cargo xtask programs PACE FIRST COUNT
                     random scenes from seed FIRST on, under touch sources of a PACE that is usual or fast
";

fn main() -> ExitCode {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let result = match arguments.as_slice() {
        ["test"] => check::test(),
        ["budgets"] => check::budgets().map(drop),
        ["portability"] => portability::check(),
        ["studio"] => studio::build().map(|path| println!("{}", path.display())),
        ["studio-test"] => studio_tests::run_all().map(drop),
        ["soak"] => check::soak(),
        ["bench", "--bless"] => bench::bench().and_then(|figures| {
            print!("{}", figures.table());
            bench::costs::bless(&figures)
        }),
        ["programs", pace, first, count] => match (Pace::named(pace), first.parse(), count.parse()) {
            (Some(pace), Ok(first), Ok(count)) => programs::check(pace, first, count),
            _ => Err(format!("no such random scenes: {}\n{USAGE}", arguments.join(" "))),
        },
        ["bench"] => bench::bench().map(|figures| print!("{}", figures.table())),
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
