//! Skips checks whose inputs have not changed since they passed.
//!
//! A stamp is a file in `target/stamps` that holds the fingerprint of a check's inputs: the paths and contents of every
//! file below the folders that it names, as git sees them (tracked, or new and not ignored), and the compiler's
//! version. A fresh clone has no stamps, so continuous integration runs everything.

use std::collections::hash_map::DefaultHasher;
use std::fs;
use std::hash::{Hash, Hasher};
use std::io::ErrorKind;
use std::path::Path;
use std::process::Command;

use crate::command::{root, text_of};
use crate::outcome::Outcome;

/// Runs `check`, unless it passed before with the same inputs. `name` is a file name; `inputs` are files and folders
/// of the repository. A check that skipped a part leaves no stamp, and runs again the next time.
pub(crate) fn unless_unchanged(
    name: &str,
    inputs: &[String],
    check: impl FnOnce() -> Result<Outcome, String>,
) -> Result<Outcome, String> {
    run_unless_stamped(&root().join("target/stamps"), name, &fingerprint(inputs)?, check)
}

fn run_unless_stamped(
    folder: &Path,
    name: &str,
    fingerprint: &str,
    check: impl FnOnce() -> Result<Outcome, String>,
) -> Result<Outcome, String> {
    fs::create_dir_all(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let stamp = folder.join(name);
    if fs::read_to_string(&stamp).is_ok_and(|passed| passed == fingerprint) {
        eprintln!("UNCHANGED since it passed: {name} (delete target/stamps to run it again)");
        return Ok(Outcome::Passed);
    }
    let outcome = check()?;
    if outcome == Outcome::Passed {
        fs::write(&stamp, fingerprint).map_err(|error| format!("{}: {error}", stamp.display()))?;
    }
    Ok(outcome)
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_a_check_that_ran_completely_leaves_a_stamp() {
        let folder = root().join(format!("target/stamps-of-test-{}", std::process::id()));
        let mut runs = 0;
        let mut check = |fingerprint: &str, outcome: Result<Outcome, String>| {
            run_unless_stamped(&folder, "check", fingerprint, || {
                runs += 1;
                outcome
            })
        };
        assert_eq!(check("a", Err("broken".to_owned())), Err("broken".to_owned()));
        assert_eq!(check("a", Ok(Outcome::Skipped)), Ok(Outcome::Skipped));
        assert_eq!(check("a", Ok(Outcome::Passed)), Ok(Outcome::Passed), "it runs again");
        assert_eq!(check("a", Err("not run".to_owned())), Ok(Outcome::Passed));
        assert_eq!(check("b", Ok(Outcome::Passed)), Ok(Outcome::Passed));
        assert_eq!(runs, 4);
        fs::remove_dir_all(&folder).unwrap();
    }
}
