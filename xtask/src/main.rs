//! The commands for developers, run through the cargo alias `cargo xtask`.

mod bench;
mod budgets;
mod ci;
mod command;
mod dist;
mod fuzz;
mod hardware;
mod licences;
mod machine_paths;
mod needs;
mod numbers;
mod packages;
mod pico_rig;
mod portability;
mod python;
mod soak;
mod studio;
mod studio_tests;
#[cfg(test)]
mod test_files;

use std::env;
use std::process::ExitCode;
use std::time::Duration;

use bench::programs::{self, Pace};
use ci::{EMULATED, M4F_TARGET, WASM_TARGET};
use fuzz::Extent;
use needs::{Need, require};

const USAGE: &str = "\
cargo xtask ci       every check beside `cargo test` that must pass before a change is merged, in steps; CI runs both
cargo xtask ci STEP  one step: format, lints, features, images, tests, docs, wasm, scripts, studio, emulators,
                     budgets, python, other-systems, fuzz
cargo xtask soak     the parts that take too long for that; each takes an hour at most
cargo xtask soak PART
cargo xtask bench    instructions and estimated cycles on emulated processors, and image sizes
                     with FRIXEL_BLESS=1, writes down what each kind of layer costs, which compiler and board use
cargo xtask numbers  the tables of docs/inside/numbers.md, of what bench wrote down
cargo xtask studio   the studio as one HTML file, <frixel-scene> beside it, the widget of the Python module; the page's
                     path is the last line
cargo xtask studio --site FOLDER [ADDRESS]
                     the studio, <frixel-scene> and the gallery as files for any web server; with the site's address,
                     links to it show a picture
cargo xtask studio-shots
                     the pictures of docs/design/studio, of the page as it is; look at each before it is kept
cargo xtask dist FOLDER
                     what is handed on to those who have no checkout: command, images, wheel, page, licences, checksums
cargo xtask hardware docs/board/wiring.md, from hardware/carrier.toml
cargo xtask fuzz SECONDS
                     each fuzz target for this time, with libFuzzer; needs a C++ compiler
cargo xtask programs PACE FIRST COUNT
                     random scenes from seed FIRST on, under touch sources of a PACE that is usual or fast
";

fn main() -> ExitCode {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let result = match arguments.as_slice() {
        ["ci"] => ci::run_all(),
        ["ci", step] => ci::run_step(step),
        ["soak"] => {
            print!("{}", soak::list());
            Ok(())
        }
        ["soak", part] => soak::run(part),
        ["studio"] => require(&[WASM_TARGET]).and_then(|()| studio::build()).map(|path| println!("{}", path.display())),
        ["studio", "--site", folder] => require(&[WASM_TARGET]).and_then(|()| studio::build_site(folder, None)),
        ["studio", "--site", folder, address] => {
            require(&[WASM_TARGET]).and_then(|()| studio::build_site(folder, Some(address)))
        }
        ["studio-shots"] => require(&studio_tests::NEEDS).and_then(|()| studio_tests::take_shots()),
        ["dist", folder] => dist::make(folder),
        ["hardware"] => hardware::write(),
        ["numbers"] => numbers::write(),
        ["fuzz", seconds] => match seconds.parse() {
            Ok(seconds) => {
                let extent = Extent::For(Duration::from_secs(seconds));
                require(&[Need::CppCompiler]).and_then(|()| fuzz::run_all(extent))
            }
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
            if env::var_os("FRIXEL_BLESS").is_some() {
                bench::costs::bless(&figures).and_then(|()| numbers::write())
            } else {
                Ok(())
            }
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
