//! `frixel studio`: serves the studio on loopback, and opens it in the browser.

use std::env;
use std::ffi::OsStr;
use std::io;
use std::path::PathBuf;
use std::process::{Command, Stdio};

use crate::studio::{Studio, page};
use clap::Args;

use super::error::CommandError;
use super::interrupt::Interrupt;
use super::terminal::{note, print_line};

#[derive(Debug, Args)]
pub(super) struct StudioArgs {
    /// Serial port of a board for the page, for example that of a `frixel sim`. Browsers with Web Serial need none:
    /// there the page asks for the port.
    #[arg(long, value_name = "PATH")]
    port: Option<String>,
    /// Port to listen on, of this machine only (127.0.0.1); 0 for any.
    #[arg(long, value_name = "N", default_value_t = 0)]
    listen: u16,
    /// The page, as `cargo xtask studio` builds it. Without it, that of the checkout around the current folder.
    #[arg(long, value_name = "FILE.html")]
    page: Option<PathBuf>,
    /// Do not open the browser.
    #[arg(long)]
    no_browser: bool,
}

pub(super) fn run(args: &StudioArgs) -> Result<(), CommandError> {
    let studio = Studio::open(args.listen, page(args.page.as_deref())?, args.port.clone())?;
    let interrupt = Interrupt::watch()?;
    let url = studio.url();
    print_line(&url)?;
    if !args.no_browser
        && let Err(error) = open_browser(&url)
    {
        note(format_args!("frixel: no browser could be opened ({error}): open the address above"));
    }
    Ok(studio.run(&|| interrupt.is_requested())?)
}

/// Opens an address in the first browser of `BROWSER` that starts, or else in that of the desktop.
fn open_browser(url: &str) -> io::Result<()> {
    let list = env::var_os("BROWSER").unwrap_or_default();
    if browsers(&list, url).iter().any(|words| start(words).is_ok()) {
        return Ok(());
    }
    open::that_detached(url)
}

/// The commands that `BROWSER` lists, separated as in `PATH`, with the address in place of `%s`, or else as the last
/// word.
fn browsers(list: &OsStr, url: &str) -> Vec<Vec<String>> {
    let command = |entry: PathBuf| {
        let words = entry.to_string_lossy().into_owned();
        // The path of a program may have spaces.
        if entry.is_file() {
            return vec![words, url.to_owned()];
        }
        let has_place = words.contains("%s");
        let words = words.split_whitespace().map(|word| word.replace("%s", url));
        words.chain((!has_place).then(|| url.to_owned())).collect()
    };
    env::split_paths(list).filter(|entry| !entry.as_os_str().is_empty()).map(command).collect()
}

/// Starts a command that goes on without this one.
fn start(words: &[String]) -> io::Result<()> {
    let (program, arguments) = words.split_first().ok_or(io::ErrorKind::NotFound)?;
    let mut command = Command::new(program);
    command.args(arguments).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    // Ctrl-C ends the studio, and not the browser.
    #[cfg(unix)]
    std::os::unix::process::CommandExt::process_group(&mut command, 0);
    command.spawn().map(drop)
}
