//! `frixel studio`: opens the studio in the browser.

use std::env;
use std::ffi::{OsStr, OsString};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::SystemTime;

use anyhow::{Context, Result, anyhow, bail};
use clap::Args;

use crate::input;

use super::error::unreadable;
use super::terminal::{note, print_line};

/// The page beside the command, in the folder that `cargo xtask dist` makes.
const PAGE_BESIDE: &str = "frixel-studio.html";
/// The page in the folder of build artefacts.
const BUILT_PAGE: &str = "studio/frixel-studio.html";
/// The folder of build artefacts in a checkout, unless `CARGO_TARGET_DIR` names another.
const TARGET: &str = "target";
/// A file that only a checkout of frixel has.
const SIGN_OF_A_CHECKOUT: &str = "host/studio/web/boot.js";
/// The error if there is neither a page nor a checkout that could build one.
const NO_PAGE: &str = "no page found: run `cargo xtask studio` in a checkout of frixel (some minutes), or give --page \
                       FILE.html";
/// Folders of a checkout that the page is made from.
const SOURCES: [&str; 11] = [
    "firmware",
    "hil-sim",
    "host/driver",
    "host/felt",
    "host/play",
    "host/scene",
    "host/studio/src",
    "host/studio/vendor",
    "host/studio/web",
    "model",
    "scenes",
];
/// Folders that builds write into; a newer file there does not make the page outdated.
const BUILD_FOLDERS: [&str; 2] = ["target", "node_modules"];

#[derive(Debug, Args)]
pub(super) struct StudioArgs {
    /// The page that `cargo xtask studio` builds. Default: the page beside this command, or the checkout's.
    #[arg(long, value_name = "FILE.html")]
    page: Option<PathBuf>,
    /// Print the page's path without opening a browser.
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

/// The absolute path of the page: the given one, else the one beside the command, else the one built in the checkout
/// around the current folder.
fn page(args: &StudioArgs) -> Result<PathBuf> {
    if args.port.is_some() {
        bail!("choose the port in the page, in Chromium or Firefox: leave out --port");
    }
    let page = if let Some(page) = &args.page {
        page.clone()
    } else if let Some(page) =
        env::current_exe().and_then(fs::canonicalize).ok().and_then(|program| page_beside(&program))
    {
        page
    } else {
        page_of_checkout(&env::current_dir().context(NO_PAGE)?, env::var_os("CARGO_TARGET_DIR"))?
    };
    let path = input::open(&page, u64::MAX).and_then(|_| fs::canonicalize(&page));
    path.map_err(unreadable(&page, "give --page the file that `cargo xtask studio` prints"))
}

/// The page in the folder of a program.
fn page_beside(program: &Path) -> Option<PathBuf> {
    Some(program.with_file_name(PAGE_BESIDE)).filter(|page| page.is_file())
}

/// The page of the checkout around `here`. Its build artefacts are in `target`, if given, in place of the usual folder.
fn page_of_checkout(here: &Path, target: Option<OsString>) -> Result<PathBuf> {
    let mut folders = here.ancestors();
    let checkout = folders.find(|folder| folder.join(SIGN_OF_A_CHECKOUT).is_file()).context(NO_PAGE)?;
    let page = checkout.join(target.unwrap_or_else(|| TARGET.into())).join(BUILT_PAGE);
    let built = fs::metadata(&page).and_then(|page| page.modified()).map_err(|_| {
        anyhow!(
            "{} does not exist: run `cargo xtask studio` in {} to build it; that needs the target \
             wasm32-unknown-unknown (`rustup target add wasm32-unknown-unknown`), and takes some minutes the first \
             time",
            page.display(),
            checkout.display()
        )
    })?;
    if SOURCES.iter().any(|folder| has_newer(&checkout.join(folder), built)) {
        note(format_args!("frixel: this page is older than its sources: run `cargo xtask studio` to rebuild it"));
    }
    Ok(page)
}

/// Whether a file anywhere below a folder was changed after a time.
fn has_newer(folder: &Path, time: SystemTime) -> bool {
    let mut entries = fs::read_dir(folder).into_iter().flatten().flatten();
    entries.any(|entry| match entry.metadata() {
        Ok(found) if found.is_dir() => {
            !BUILD_FOLDERS.iter().any(|name| entry.file_name() == *name) && has_newer(&entry.path(), time)
        }
        Ok(found) => found.modified().is_ok_and(|modified| modified > time),
        Err(_) => false,
    })
}

/// Opens a page in the first browser of `BROWSER` that starts, or else in the desktop's browser.
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

/// Starts a command that outlives this one.
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
    use std::time::Duration;

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
    fn a_page_that_lies_beside_the_command_is_found() {
        let folder = tempfile::tempdir().unwrap();
        let (program, page) = (folder.path().join("frixel"), folder.path().join(PAGE_BESIDE));
        assert_eq!(page_beside(&program), None);
        fs::write(&page, "").unwrap();
        assert_eq!(page_beside(&program), Some(page));
    }

    #[test]
    fn a_checkout_has_its_page_in_the_folder_of_build_artefacts_or_says_how_to_build_it() {
        let folder = tempfile::tempdir().unwrap();
        let checkout = folder.path();
        let within = checkout.join("docs");
        assert_eq!(page_of_checkout(checkout, None).unwrap_err().to_string(), NO_PAGE);
        let sign = checkout.join(SIGN_OF_A_CHECKOUT);
        for file in [&sign, &within.join("a.md")] {
            fs::create_dir_all(file.parent().unwrap()).unwrap();
            fs::write(file, "").unwrap();
        }
        let error = page_of_checkout(&within, None).unwrap_err().to_string();
        assert!(error.contains("`cargo xtask studio`") && error.contains("rustup target add"), "{error}");
        for (target, expected) in [(None, TARGET), (Some("made".into()), "made")] {
            let page = checkout.join(expected).join(BUILT_PAGE);
            fs::create_dir_all(page.parent().unwrap()).unwrap();
            fs::write(&page, "").unwrap();
            assert_eq!(page_of_checkout(&within, target).unwrap(), page);
        }
        let after = |seconds| SystemTime::UNIX_EPOCH + Duration::from_secs(seconds);
        fs::File::options().write(true).open(&sign).unwrap().set_modified(after(100)).unwrap();
        let sources = checkout.join("host");
        assert!(has_newer(&sources, after(99)) && !has_newer(&sources, after(100)));
    }
}
