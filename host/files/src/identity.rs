//! Whether two names lead to one file.

use std::path::Path;

/// Whether two paths lead to one file, also by symbolic and, on Unix, hard links. False if either leads to none.
pub(crate) fn is_same_file(one: &Path, other: &Path) -> bool {
    at(one).is_some_and(|one| at(other) == Some(one))
}

/// Device and number of the file at a path.
#[cfg(unix)]
fn at(path: &Path) -> Option<(u64, u64)> {
    path.metadata().ok().as_ref().map(number)
}

/// The path of a file without links.
#[cfg(not(unix))]
fn at(path: &Path) -> Option<std::path::PathBuf> {
    path.canonicalize().ok()
}

/// Whether an open file, or a standard stream, is the one that a path leads to.
#[cfg(unix)]
pub(crate) fn is_open_at(file: impl std::os::fd::AsFd, path: &Path) -> bool {
    let file = file.as_fd().try_clone_to_owned().map(std::fs::File::from);
    file.and_then(|file| file.metadata()).is_ok_and(|metadata| at(path) == Some(number(&metadata)))
}

/// Open files have no names here.
#[cfg(not(unix))]
pub(crate) fn is_open_at<F>(_: F, _: &Path) -> bool {
    false
}

#[cfg(unix)]
fn number(metadata: &std::fs::Metadata) -> (u64, u64) {
    use std::os::unix::fs::MetadataExt;
    (metadata.dev(), metadata.ino())
}
