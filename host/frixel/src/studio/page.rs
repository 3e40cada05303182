//! The page's bytes: a given file, or the one that a checkout builds.

use std::env;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use super::StudioError;
use crate::input;

/// The page in the folder of build artefacts.
const BUILT_PAGE: &str = "studio/frixel-studio.html";
/// That folder in a checkout, unless `CARGO_TARGET_DIR` names another.
const TARGET: &str = "target";
/// A file that only a checkout of frixel has.
const SIGN_OF_A_CHECKOUT: &str = "host/studio/web/boot.js";

/// Reads the page from a file. Without one, reads that of the checkout around the current folder, which builds it first
/// if it has none.
pub(crate) fn page(file: Option<&Path>) -> Result<Vec<u8>, StudioError> {
    if let Some(file) = file {
        return read(file);
    }
    let checkout = checkout().ok_or(StudioError::NoPage)?;
    let target = env::var_os("CARGO_TARGET_DIR").map_or_else(|| checkout.join(TARGET), PathBuf::from);
    let built = target.join(BUILT_PAGE);
    if built.is_file() { read(&built) } else { read(&build(&checkout)?) }
}

fn checkout() -> Option<PathBuf> {
    let here = env::current_dir().ok()?;
    here.ancestors().find(|folder| folder.join(SIGN_OF_A_CHECKOUT).is_file()).map(Path::to_owned)
}

/// Builds the page in a checkout, and returns its path.
fn build(checkout: &Path) -> Result<PathBuf, StudioError> {
    let failed = |reason: String| StudioError::Build { reason };
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

fn read(path: &Path) -> Result<Vec<u8>, StudioError> {
    input::read(path, input::PAGE_MAX_BYTES)
        .map_err(|source| StudioError::Page { path: path.display().to_string(), source })
}
