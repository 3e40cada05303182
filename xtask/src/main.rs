//! The commands for developers, run through the cargo alias `cargo xtask`.

mod bench;
mod budgets;
mod check;
mod command;
#[cfg(test)]
mod dependency_uses;
mod dist;
mod fuzz;
mod hardware;
mod inputs;
mod licences;
mod machine_paths;
mod needs;
mod outcome;
mod packages;
mod pico_rig;
mod portability;
mod python;
mod results;
mod soak;
mod stages;
mod stamps;
mod studio;
mod studio_tests;
mod test_programs;

use std::env;
use std::process::ExitCode;
use std::time::Duration;

use bench::programs::{self, Pace};
use check::{CLIPPY, M0_PLUS_TARGET, M3_TARGET, M4F_TARGET, M33_TARGET, Tier, WASM_TARGET};
use needs::{Need, require};

const USAGE: &str = "\
cargo xtask test     format, lints, images, all tests but those on emulators, the studio in a browser, docs
         --all       and what is slow: tests on emulators, budgets, Python, other systems, fuzz targets; CI runs it
cargo xtask soak     the parts of what takes too long for that; each takes an hour at most
cargo xtask soak PART
cargo xtask bench    instructions and estimated cycles on emulated processors, and image sizes
                     with FRIXEL_BLESS=1, writes down what each kind of layer costs, which compiler and board use
cargo xtask budgets  the same, held against budgets.toml, and random scenes against the loader's estimate for them
cargo xtask portability
                     the crates of a page for WebAssembly; the command for Windows and macOS
cargo xtask studio   the studio as one HTML file, <frixel-scene> beside it, the widget of the Python module; the page's
                     path is the last line
cargo xtask studio --site FOLDER [ADDRESS]
                     the studio, <frixel-scene> and the gallery as files for any web server; with the site's address,
                     links to it show a picture
cargo xtask studio-test
                     types and lints of the studio's scripts, and the studio in a browser: needs node,
                     npm and Chromium
cargo xtask studio-shots
                     the pictures of docs/studio, of the page as it is; look at each before it is kept
cargo xtask python   the Python module in a fresh virtual environment: wheel, types, lints, tests, examples; its
                     widget in Chromium
cargo xtask dist FOLDER
                     what is handed on to those who have no checkout: command, images, wheel, page, licences, checksums
cargo xtask hardware docs/wiring.md, from hardware/carrier.toml
cargo xtask fuzz SECONDS
                     each fuzz target for this time, with libFuzzer; needs a C++ compiler
cargo xtask programs PACE FIRST COUNT
                     random scenes from seed FIRST on, under touch sources of a PACE that is usual or fast
";

/// What the commands that count instructions need.
const EMULATED: [Need; 5] = [M4F_TARGET, M3_TARGET, M0_PLUS_TARGET, M33_TARGET, Need::Emulator];

fn main() -> ExitCode {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let result = match arguments.as_slice() {
        ["test"] => check::test(Tier::First),
        ["test", "--all"] => check::test(Tier::All),
        ["soak"] => {
            print!("{}", soak::list());
            Ok(())
        }
        ["soak", part] => soak::run(part),
        ["budgets"] => require(&EMULATED).and_then(|()| check::check_budgets()),
        ["portability"] => require(&[WASM_TARGET, CLIPPY])
            .and_then(|()| require(&portability::NEEDS))
            .and_then(|()| portability::page_crates())
            .and_then(|()| portability::other_systems()),
        ["studio"] => require(&[WASM_TARGET]).and_then(|()| studio::build()).map(|path| println!("{}", path.display())),
        ["studio", "--site", folder] => require(&[WASM_TARGET]).and_then(|()| studio::build_site(folder, None)),
        ["studio", "--site", folder, address] => {
            require(&[WASM_TARGET]).and_then(|()| studio::build_site(folder, Some(address)))
        }
        ["studio-shots"] => require(&studio_tests::NEEDS).and_then(|()| studio_tests::take_shots()),
        ["studio-test"] => {
            let result = require(&studio_tests::NEEDS)
                .and_then(|()| studio_tests::check_scripts())
                .and_then(|()| studio_tests::run_page())
                .and_then(|()| studio_tests::run_beside_command());
            results::print();
            result
        }
        ["python"] => {
            let result = require(&python::NEEDS).and_then(|()| python::check());
            results::print();
            result
        }
        ["dist", folder] => dist::make(folder),
        ["hardware"] => hardware::write(),
        ["fuzz", seconds] => match seconds.parse() {
            Ok(seconds) => require(&[Need::CppCompiler]).and_then(|()| fuzz::run_for(Duration::from_secs(seconds))),
            Err(_) => Err(format!("expected a number of seconds, found `{seconds}`\n{USAGE}")),
        },
        ["programs", pace, first, count] => match (Pace::named(pace), first.parse(), count.parse()) {
            (Some(pace), Ok(first), Ok(count)) => {
                require(&[M4F_TARGET, Need::Emulator]).and_then(|()| programs::check(pace, first, count))
            }
            _ => Err(format!("no such random scenes: {}\n{USAGE}", arguments.join(" "))),
        },
        ["bench"] => require(&EMULATED).and_then(|()| bench::bench()).and_then(|figures| {
            print!("{}", figures.table());
            if env::var_os("FRIXEL_BLESS").is_some() { bench::costs::bless(&figures) } else { Ok(()) }
        }),
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
