//! Whether two names lead to one file.

use std::fs::{self, File};
use std::io::{stdin, stdout};
use std::path::Path;

/// Whether two paths lead to one file, also by symbolic and hard links. False if either leads to none.
#[cfg(unix)]
pub(super) fn is_same_file(one: &Path, other: &Path) -> bool {
    fs::metadata(one).is_ok_and(|one| fs::metadata(other).is_ok_and(|other| number(&one) == number(&other)))
}

/// Whether two paths lead to one file, also by symbolic links. False if either leads to none.
#[cfg(not(unix))]
pub(super) fn is_same_file(one: &Path, other: &Path) -> bool {
    one.canonicalize().is_ok_and(|one| other.canonicalize().is_ok_and(|other| one == other))
}

/// Whether an open file is the one that a path leads to.
#[cfg(unix)]
pub(super) fn is_file_at(file: &File, path: &Path) -> bool {
    file.metadata().is_ok_and(|file| fs::metadata(path).is_ok_and(|other| number(&file) == number(&other)))
}

#[cfg(not(unix))]
pub(super) fn is_file_at(_: &File, path: &Path) -> bool {
    path.exists()
}

pub(super) fn is_standard_input(path: &Path) -> bool {
    is_stream(stdin(), path)
}

pub(super) fn is_standard_output(path: &Path) -> bool {
    is_stream(stdout(), path)
}

#[cfg(unix)]
fn is_stream(stream: impl std::os::fd::AsFd, path: &Path) -> bool {
    stream.as_fd().try_clone_to_owned().is_ok_and(|stream| is_file_at(&File::from(stream), path))
}

/// Names of standard streams exist on Unix only.
#[cfg(not(unix))]
fn is_stream<S>(_: S, _: &Path) -> bool {
    false
}

/// Device and file number.
#[cfg(unix)]
fn number(metadata: &fs::Metadata) -> (u64, u64) {
    use std::os::unix::fs::MetadataExt;
    (metadata.dev(), metadata.ino())
}
