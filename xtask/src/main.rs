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
mod python;
mod soak;
mod studio;
mod studio_tests;
#[cfg(test)]
mod test_files;

use std::env;
use std::process::ExitCode;
use std::time::Duration;

use bench::programs::{self, PACES};
use fuzz::Extent;
use needs::require;

const USAGE: &str = "\
cargo xtask ci       every check beside `cargo test` that must pass before a change is merged, in steps; CI runs both
cargo xtask ci STEP  one step: format, lints, features, images, tests, docs, wasm, scripts, studio, emulators,
                     budgets, python, other-systems, fuzz
cargo xtask soak     the parts that take too long for that
cargo xtask soak PART
                     one part, which takes an hour at most
cargo xtask bench    instructions and estimated cycles on emulated processors, and image sizes; with FRIXEL_BLESS=1, also
                     writes the counts and the costs of layers that compiler and board use
cargo xtask numbers  the tables of docs/inside/numbers.md, from the counts that bench wrote
cargo xtask studio   the studio as one HTML file, <frixel-scene> beside it, and the widget of the Python module; prints
                     the page's path last
cargo xtask studio --site FOLDER [ADDRESS]
                     the studio, <frixel-scene> and the gallery as files for any web server; with the site's address,
                     links to it show a picture
cargo xtask studio --firefox
                     the tests of that site in Firefox
cargo xtask studio-shots
                     the pictures of docs/design/studio; look at each before you commit it
cargo xtask dist FOLDER
                     the files for people without a checkout: command, images, wheel, page, licences, checksums
cargo xtask hardware docs/board/wiring.md, from hardware/carrier.toml
cargo xtask packages
                     compiles every published crate from its package
cargo xtask fuzz SECONDS
                     each fuzz target for this time, with libFuzzer; needs a C++ compiler
cargo xtask programs PACE FIRST COUNT
                     COUNT random scenes from seed FIRST on, under a touch source whose PACE is usual or fast
";

fn main() -> ExitCode {
    let arguments: Vec<String> = env::args().skip(1).collect();
    let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let result = match arguments.as_slice() {
        ["ci"] => ci::run_all(),
        ["ci", step] => ci::run_step(step),
        ["soak"] => {
            println!("{}", soak::list());
            Ok(())
        }
        ["soak", part] => soak::run(part),
        ["studio"] => studio::build().map(|path| println!("{}", path.display())),
        ["studio", "--site", folder] => studio::build_site(folder, None),
        ["studio", "--site", folder, address] => studio::build_site(folder, Some(address)),
        ["studio", "--firefox"] => require(&["node", "npm", "firefox"]).and_then(|()| studio_tests::run_in_firefox()),
        ["studio-shots"] => studio_tests::take_shots(),
        ["dist", folder] => dist::make(folder),
        ["hardware"] => hardware::write(),
        ["numbers"] => numbers::write(),
        ["packages"] => packages::check(),
        ["fuzz", seconds] => match seconds.parse() {
            Ok(seconds) => fuzz::run_all(Extent::For(Duration::from_secs(seconds))),
            Err(_) => Err(format!("expected a number of seconds, found `{seconds}`\n{USAGE}")),
        },
        ["programs", pace, first, count] => match (first.parse(), count.parse()) {
            (Ok(first), Ok(count)) if PACES.contains(pace) => {
                require(&["qemu-system-arm"]).and_then(|()| programs::check(pace, first, count))
            }
            _ => Err(format!("no such random scenes: {}\n{USAGE}", arguments.join(" "))),
        },
        ["bench"] => require(&["qemu-system-arm"]).and_then(|()| bench::bench()).and_then(|figures| {
            print!("{}", bench::table(&figures));
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
