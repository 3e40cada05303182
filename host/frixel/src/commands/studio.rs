//! `frixel studio`: serves the studio on loopback, and opens it in the browser.

use std::env;
use std::io;
use std::path::PathBuf;

use clap::Args;
use frixel::studio::{Studio, page};

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

/// Opens an address in the program that the environment names in `BROWSER`, or in the browser of the desktop.
fn open_browser(url: &str) -> io::Result<()> {
    match env::var("BROWSER") {
        Ok(browser) if !browser.is_empty() => open::with_detached(url, browser),
        _ => open::that_detached(url),
    }
}
