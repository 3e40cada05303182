//! A scene file that is followed while it plays.

use std::fs::{self, Metadata};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant, SystemTime};

/// Time between two looks at the file. A change has to last from one look to the next: a file that is being written is not
/// read half.
const LOOK_EVERY: Duration = Duration::from_millis(100);

/// Tells when a file was saved, in place or by an editor that puts another in its place.
pub(super) struct Watch {
    path: PathBuf,
    looked: Instant,
    /// What the file was when it was last read.
    known: Option<Print>,
    /// What it was at the last look.
    seen: Option<Print>,
}

/// What changes when a file is saved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Print {
    modified: Option<SystemTime>,
    len: u64,
    file: u64,
}

impl Print {
    fn of(path: &Path) -> Option<Self> {
        let metadata = fs::metadata(path).ok()?;
        Some(Self { modified: metadata.modified().ok(), len: metadata.len(), file: number_of(&metadata) })
    }
}

#[cfg(unix)]
fn number_of(metadata: &Metadata) -> u64 {
    std::os::unix::fs::MetadataExt::ino(metadata)
}

#[cfg(not(unix))]
fn number_of(_metadata: &Metadata) -> u64 {
    0
}

impl Watch {
    /// Follows a file from what it is now. To be made before the file is read for the first time.
    pub(super) fn new(path: &Path) -> Self {
        let now = Print::of(path);
        Self { path: path.to_owned(), looked: Instant::now(), known: now, seen: now }
    }

    /// Whether the file is another one than when this last said so. Between two looks, and while there is no file, it is not.
    pub(super) fn is_saved(&mut self) -> bool {
        if self.looked.elapsed() < LOOK_EVERY {
            return false;
        }
        self.looked = Instant::now();
        self.look()
    }

    fn look(&mut self) -> bool {
        let now = Print::of(&self.path);
        let rests = now == std::mem::replace(&mut self.seen, now);
        let saved = rests && now.is_some() && now != self.known;
        if saved {
            self.known = now;
        }
        saved
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The two looks that a change has to last for, and one more.
    fn looks(watch: &mut Watch) -> [bool; 3] {
        [watch.look(), watch.look(), watch.look()]
    }

    #[test]
    fn a_file_is_saved_in_place_or_by_another_in_its_place() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("scene.toml");
        fs::write(&path, "one").unwrap();
        let mut watch = Watch::new(&path);
        assert_eq!(looks(&mut watch), [false; 3]);
        fs::write(&path, "another").unwrap();
        assert_eq!(looks(&mut watch), [false, true, false]);
        let other = folder.path().join(".scene.toml.swp");
        fs::write(&other, "another").unwrap();
        fs::rename(&other, &path).unwrap();
        assert_eq!(looks(&mut watch), [false, true, false]);
        fs::remove_file(&path).unwrap();
        assert_eq!(looks(&mut watch), [false; 3], "gone is not saved");
        fs::write(&path, "again").unwrap();
        assert_eq!(looks(&mut watch), [false, true, false]);
    }

    #[test]
    fn a_file_that_still_grows_is_not_read() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("scene.toml");
        fs::write(&path, "").unwrap();
        let mut watch = Watch::new(&path);
        for len in 1..10 {
            fs::write(&path, "x".repeat(len)).unwrap();
            assert!(!watch.look());
        }
        assert!(watch.look());
    }
}
