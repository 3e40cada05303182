//! The page's bytes: a given file, or the one that a checkout builds.

use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use super::StudioError;

/// The page, relative to a checkout.
const BUILT_PAGE: &str = "target/studio/frixel-studio.html";
/// A file that only a checkout of frixel has.
const SIGN_OF_A_CHECKOUT: &str = "host/studio/web/boot.js";

/// Reads the page from a file. Without one, reads that of the checkout around the current folder, which builds it first
/// if it has none.
pub fn page(file: Option<&Path>) -> Result<Vec<u8>, StudioError> {
    if let Some(file) = file {
        return read(file);
    }
    let checkout = checkout().ok_or(StudioError::NoPage)?;
    let built = checkout.join(BUILT_PAGE);
    if !built.is_file() {
        build(&checkout)?;
    }
    read(&built)
}

fn checkout() -> Option<PathBuf> {
    let here = env::current_dir().ok()?;
    here.ancestors().find(|folder| folder.join(SIGN_OF_A_CHECKOUT).is_file()).map(Path::to_owned)
}

fn build(checkout: &Path) -> Result<(), StudioError> {
    let failed = |reason: String| StudioError::Build { reason };
    let cargo = env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let mut command = Command::new(cargo);
    // Standard output has the page's path, which is known; the progress goes to standard error.
    command.current_dir(checkout).args(["xtask", "studio"]).stdout(std::process::Stdio::null());
    let status = command.status().map_err(|error| failed(format!("could not be started ({error})")))?;
    if status.success() { Ok(()) } else { Err(failed(format!("failed ({status})"))) }
}

fn read(path: &Path) -> Result<Vec<u8>, StudioError> {
    fs::read(path).map_err(|source| StudioError::Page { path: path.display().to_string(), source })
}
