//! Skips checks whose inputs have not changed since they passed.
//!
//! A stamp is a file in `target/stamps` that holds the fingerprint of a check's inputs: the paths and contents of every
//! file below the folders that it names, as git sees them (tracked, or new and not ignored), and the compiler's
//! version. A fresh clone has no stamps, so continuous integration runs everything.

use std::collections::hash_map::DefaultHasher;
use std::fs;
use std::hash::{Hash, Hasher};
use std::io::ErrorKind;
use std::process::Command;

use crate::bench;
use crate::command::{root, text_of};

/// Runs `check`, unless it passed before with the same inputs. `name` is a file name; `inputs` are files and folders
/// of the repository. Without the emulator, every check runs and leaves no stamp, because it may have skipped a part.
pub(crate) fn unless_unchanged(
    name: &str,
    inputs: &[String],
    check: impl FnOnce() -> Result<(), String>,
) -> Result<(), String> {
    if bench::emulator().is_err() {
        return check();
    }
    let folder = root().join("target/stamps");
    fs::create_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let stamp = folder.join(name);
    let found = fingerprint(inputs)?;
    if fs::read_to_string(&stamp).is_ok_and(|passed| passed == found) {
        eprintln!("UNCHANGED since it passed: {name} (delete target/stamps to run it again)");
        return Ok(());
    }
    check()?;
    fs::write(&stamp, found).map_err(|error| format!("{}: {error}", stamp.display()))
}

/// A fingerprint of the files below `inputs`.
fn fingerprint(inputs: &[String]) -> Result<String, String> {
    let mut files = Command::new("git");
    files.current_dir(root()).args(["ls-files", "--cached", "--others", "--exclude-standard", "-z", "--"]).args(inputs);
    let files = text_of(&mut files)?;
    let mut paths: Vec<&str> = files.split_terminator('\0').collect();
    paths.sort_unstable();
    paths.dedup();
    let mut hasher = DefaultHasher::new();
    text_of(Command::new("rustc").arg("--version"))?.hash(&mut hasher);
    for path in paths {
        path.hash(&mut hasher);
        match fs::read(root().join(path)) {
            Ok(bytes) => bytes.hash(&mut hasher),
            // Git also lists files that were deleted without a commit.
            Err(error) if error.kind() == ErrorKind::NotFound => {}
            Err(error) => return Err(format!("{path}: {error}")),
        }
    }
    Ok(format!("{:016x}", hasher.finish()))
}
