//! Detects when a file was saved.

use std::fs::{self, Metadata};
use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

/// Time between two checks of a file. A change must be the same in two consecutive checks, so that a file is not read
/// while it is being written.
pub(crate) const CHECK_PERIOD: Duration = Duration::from_millis(100);

/// Number of checks after which a missing file counts as gone: half a second, longer than an editor takes to replace
/// it.
const CHECKS_GONE: u32 = 5;

/// Detects when a file was saved, in place or by an editor that replaces it with another file.
#[derive(Clone)]
pub(super) struct SavedFile {
    path: PathBuf,
    /// State of the file before it was read.
    read: Option<Fingerprint>,
    /// State of the file at the last check.
    checked: Option<Fingerprint>,
    /// Number of consecutive checks at which the file was missing.
    missed: u32,
}

/// Metadata that changes when a file is saved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Fingerprint {
    modified: Option<SystemTime>,
    len: u64,
    file: u64,
}

impl Fingerprint {
    fn of(path: &Path) -> Option<Self> {
        let metadata = fs::metadata(path).ok()?;
        Some(Self { modified: metadata.modified().ok(), len: metadata.len(), file: file_number(&metadata) })
    }
}

#[cfg(unix)]
fn file_number(metadata: &Metadata) -> u64 {
    std::os::unix::fs::MetadataExt::ino(metadata)
}

#[cfg(not(unix))]
fn file_number(_metadata: &Metadata) -> u64 {
    0
}

impl SavedFile {
    /// Watches a file for changes from now on. Call this before the file is read.
    pub(super) fn new(path: &Path) -> Self {
        let now = Fingerprint::of(path);
        Self { path: path.to_owned(), read: now, checked: now, missed: 0 }
    }

    /// The path of the file.
    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// Whether the file has vanished, reported once.
    pub(super) fn has_vanished(&mut self) -> bool {
        let has_vanished = self.missed == CHECKS_GONE;
        self.missed += u32::from(has_vanished);
        has_vanished
    }

    /// Checks the file now. Call this once every [`CHECK_PERIOD`]: a change counts once two calls in a row find it.
    /// Returns whether the file has changed since it was read; false while it does not exist.
    pub(super) fn is_saved(&mut self) -> bool {
        let now = Fingerprint::of(&self.path);
        self.missed = if now.is_some() { 0 } else { self.missed.saturating_add(1) };
        let is_settled = now == std::mem::replace(&mut self.checked, now);
        is_settled && now.is_some() && now != self.read
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Results of the two checks that confirm a change, and of one more.
    fn checks(file: &mut SavedFile) -> [bool; 3] {
        [file.is_saved(), file.is_saved(), file.is_saved()]
    }

    #[test]
    fn a_file_is_saved_in_place_or_by_another_in_its_place() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("scene.toml");
        fs::write(&path, "one").unwrap();
        let mut file = SavedFile::new(&path);
        assert_eq!(checks(&mut file), [false; 3]);
        fs::write(&path, "another").unwrap();
        assert_eq!(checks(&mut file), [false, true, true], "until it is read again");
        let mut file = SavedFile::new(&path);
        let other = folder.path().join(".scene.toml.swp");
        fs::write(&other, "another").unwrap();
        fs::rename(&other, &path).unwrap();
        assert_eq!(checks(&mut file), [false, true, true]);
        let mut file = SavedFile::new(&path);
        fs::remove_file(&path).unwrap();
        assert_eq!(checks(&mut file), [false; 3], "a file that was removed was not saved");
        assert!(!file.has_vanished(), "an editor may be replacing it");
        assert_eq!(checks(&mut file), [false; 3]);
        file.missed = CHECKS_GONE;
        assert_eq!([file.has_vanished(), file.has_vanished()], [true, false]);
        fs::write(&path, "again").unwrap();
        assert_eq!(checks(&mut file), [false, true, true]);
    }

    #[test]
    fn a_file_that_still_grows_is_not_read() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("scene.toml");
        fs::write(&path, "").unwrap();
        let mut file = SavedFile::new(&path);
        for len in 1..10 {
            fs::write(&path, "x".repeat(len)).unwrap();
            assert!(!file.is_saved());
        }
        assert!(file.is_saved());
    }
}
