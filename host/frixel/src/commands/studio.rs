//! `frixel studio`: opens the studio in the browser.

use std::env;
use std::ffi::OsStr;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::{Context, Result, anyhow, bail};
use clap::Args;

use crate::input;

use super::terminal::{note, print_line};

/// The page in the folder of build artefacts.
const BUILT_PAGE: &str = "studio/frixel-studio.html";
/// That folder in a checkout, unless `CARGO_TARGET_DIR` names another.
const TARGET: &str = "target";
/// A file that only a checkout of frixel has.
const SIGN_OF_A_CHECKOUT: &str = "host/studio/web/boot.js";

#[derive(Debug, Args)]
pub(super) struct StudioArgs {
    /// The page, as `cargo xtask studio` builds it. Without it, that of the checkout around the current folder.
    #[arg(long, value_name = "FILE.html")]
    page: Option<PathBuf>,
    /// Print the page's path, and do not open the browser.
    #[arg(long)]
    no_browser: bool,
    /// Refused: the page asks for the port.
    #[arg(long, hide = true)]
    port: Option<String>,
}

pub(super) fn run(args: &StudioArgs) -> Result<()> {
    let page = page(args)?.display().to_string();
    print_line(&page)?;
    if !args.no_browser
        && let Err(error) = open_browser(&page)
    {
        note(format_args!("frixel: no browser could be opened ({error}): open the file above in one"));
    }
    Ok(())
}

/// The absolute path of the page that was given, or of the one that the checkout around the current folder has or
/// builds.
fn page(args: &StudioArgs) -> Result<PathBuf> {
    if args.port.is_some() {
        bail!("choose the port in the page, in Chromium or Firefox: leave out --port");
    }
    let page = match &args.page {
        Some(page) => page.clone(),
        None => page_of_checkout()?,
    };
    let path = input::open(&page, u64::MAX).and_then(|_| fs::canonicalize(&page));
    let page = page.display();
    path.map_err(|error| {
        anyhow!("{page} cannot be read ({error}): give --page the file that `cargo xtask studio` prints")
    })
}

fn page_of_checkout() -> Result<PathBuf> {
    let here = env::current_dir().unwrap_or_default();
    let mut folders = here.ancestors();
    let checkout = folders.find(|folder| folder.join(SIGN_OF_A_CHECKOUT).is_file()).context(
        "no page is given, and this folder is in no checkout of frixel that could build it: give --page FILE.html",
    )?;
    let target = env::var_os("CARGO_TARGET_DIR").map_or_else(|| checkout.join(TARGET), PathBuf::from);
    let built = target.join(BUILT_PAGE);
    if built.is_file() { Ok(built) } else { build(checkout) }
}

/// Builds the page in a checkout, and returns its path.
fn build(checkout: &Path) -> Result<PathBuf> {
    let failed = |reason: String| anyhow!("the page could not be built: `cargo xtask studio` {reason}");
    let cargo = env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut command = Command::new(cargo);
    command.current_dir(checkout).args(["xtask", "studio"]).stderr(Stdio::inherit());
    let output = command.output().map_err(|error| failed(format!("could not be started ({error})")))?;
    if !output.status.success() {
        return Err(failed(format!("failed ({})", output.status)));
    }
    // The path is the last line of standard output; the progress goes to standard error.
    let printed = String::from_utf8_lossy(&output.stdout);
    let path = printed.lines().last().ok_or_else(|| failed("printed no path".to_owned()))?;
    Ok(PathBuf::from(path))
}

/// Opens a page in the first browser of `BROWSER` that starts, or else in that of the desktop.
fn open_browser(page: &str) -> io::Result<()> {
    let list = env::var_os("BROWSER").unwrap_or_default();
    if browsers(&list, page).iter().any(|words| start(words).is_ok()) {
        return Ok(());
    }
    open::that_detached(page)
}

/// The commands that `BROWSER` lists, separated as in `PATH`, with the page in place of `%s`, or else as the last word.
fn browsers(list: &OsStr, page: &str) -> Vec<Vec<String>> {
    let command = |entry: PathBuf| {
        let words = entry.to_string_lossy().into_owned();
        // The path of a program may have spaces.
        if entry.is_file() {
            return vec![words, page.to_owned()];
        }
        let has_place = words.contains("%s");
        let words = words.split_whitespace().map(|word| word.replace("%s", page));
        words.chain((!has_place).then(|| page.to_owned())).collect()
    };
    env::split_paths(list).filter(|entry| !entry.as_os_str().is_empty()).map(command).collect()
}

/// Starts a command that goes on without this one.
fn start(words: &[String]) -> io::Result<()> {
    let (program, arguments) = words.split_first().ok_or(io::ErrorKind::NotFound)?;
    let mut command = Command::new(program);
    command.args(arguments).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    #[cfg(unix)]
    std::os::unix::process::CommandExt::process_group(&mut command, 0);
    command.spawn().map(drop)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_variable_lists_commands_with_a_place_for_the_page() {
        let folder = tempfile::tempdir().unwrap();
        let spaced = folder.path().join("a browser").display().to_string();
        fs::write(&spaced, "").unwrap();
        let list = format!("{spaced}:firefox --new %s in-front::chromium");
        assert_eq!(
            browsers(OsStr::new(&list), "/p.html"),
            [
                vec![spaced.as_str(), "/p.html"],
                vec!["firefox", "--new", "/p.html", "in-front"],
                vec!["chromium", "/p.html"]
            ]
        );
    }

    #[test]
    fn a_port_and_a_missing_page_are_refused_with_what_to_do() {
        let args = StudioArgs { page: None, no_browser: true, port: None };
        let with_port = StudioArgs { port: Some("/dev/ttyACM0".to_owned()), ..args };
        let error = page(&with_port).unwrap_err().to_string();
        assert!(error.contains("choose the port in the page, in Chromium or Firefox"), "{error}");
        let nowhere = StudioArgs { page: Some("nowhere.html".into()), no_browser: true, port: None };
        let error = page(&nowhere).unwrap_err().to_string();
        assert!(error.contains("nowhere.html cannot be read (") && error.contains("`cargo xtask studio`"), "{error}");
    }
}
