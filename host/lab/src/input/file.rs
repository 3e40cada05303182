//! Opens files for the command and for Python: regular files of at most a stated size.
//!
//! A file that is a pipe or a device is not read, since it may have no end. Errors are [`io::Error`]s, for the
//! sentences of those who read.

use std::fs::{File, FileType, OpenOptions};
use std::io::{self, Read};
use std::path::Path;

use frixel_scene::FileKind;

use super::{Bounded, InputError, PICTURE_MAX_BYTES, TOML_MAX_BYTES};
use crate::table::HEAD_BYTES;

/// Opens a regular file of at most `max_bytes` bytes. Reading beyond them is an error.
pub fn open(path: &Path, max_bytes: u64) -> io::Result<Bounded<File>> {
    let mut options = OpenOptions::new();
    options.read(true);
    #[cfg(unix)]
    {
        use std::os::unix::fs::OpenOptionsExt;
        // Opening a pipe without a writer would otherwise block. Regular files ignore this flag; logs of the system,
        // which look like regular files, obey it.
        options.custom_flags(rustix::fs::OFlags::NONBLOCK.bits().cast_signed());
    }
    let file = options.open(path)?;
    let metadata = file.metadata()?;
    if let Some(what) = irregular(metadata.file_type()) {
        return Err(InputError::NotAFile { what }.into());
    }
    Ok(Bounded::of_file(file, metadata.len(), max_bytes)?)
}

/// Reads a regular file of at most `max_bytes` bytes.
pub fn read(path: &Path, max_bytes: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    open(path, max_bytes)?.read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// Reads a file of TOML text. Of a larger file of another format, such as a photograph, returns the first bytes, by
/// which its reader names the kind.
pub fn read_toml(path: &Path) -> io::Result<Vec<u8>> {
    let whole = read(path, TOML_MAX_BYTES);
    if whole.is_err() {
        let mut head = Vec::new();
        open(path, u64::MAX)?.take(HEAD_BYTES).read_to_end(&mut head)?;
        if FileKind::of(&head).is_some_and(|kind| !kind.is_toml()) {
            return Ok(head);
        }
    }
    whole
}

/// Reads a file that a scene names: text that is a part of it, or a picture.
pub fn read_named(path: &Path) -> io::Result<Vec<u8>> {
    let is_toml = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("toml"));
    if is_toml { read_toml(path) } else { read(path, PICTURE_MAX_BYTES) }
}

/// The kind of a file that is not a regular one, in words. Reading a folder fails by itself.
fn irregular(kind: FileType) -> Option<&'static str> {
    if kind.is_file() || kind.is_dir() {
        return None;
    }
    #[cfg(unix)]
    {
        use std::os::unix::fs::FileTypeExt;
        if kind.is_fifo() {
            return Some("pipe");
        }
        if kind.is_socket() {
            return Some("socket");
        }
    }
    Some("device")
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::super::CSV_MAX_BYTES;
    use super::*;

    #[test]
    fn a_file_above_its_limit_is_refused_with_both_numbers_before_it_is_read() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("sparse");
        File::create(&path).unwrap().set_len(8 << 30).unwrap();
        let error = read(&path, CSV_MAX_BYTES).unwrap_err().to_string();
        assert_eq!(error, "it has 8589934592 bytes, and at most 536870912 are read");
        fs::write(&path, b"four").unwrap();
        assert_eq!(read(&path, 4).unwrap(), b"four");
        assert!(read(&path, 3).is_err());
    }

    #[test]
    fn a_file_that_a_scene_names_is_a_text_or_a_picture() {
        let folder = tempfile::tempdir().unwrap();
        for (name, limit) in [("part.TOML", TOML_MAX_BYTES), ("brick.png", PICTURE_MAX_BYTES)] {
            let path = folder.path().join(name);
            File::create(&path).unwrap().set_len(limit + 1).unwrap();
            let error = read_named(&path).unwrap_err().to_string();
            assert_eq!(error, format!("it has {} bytes, and at most {limit} are read", limit + 1));
        }
        let path = folder.path().join("large.toml");
        fs::write(&path, format!("version = 1\n#{}\n", "#".repeat(TOML_MAX_BYTES as usize))).unwrap();
        assert!(read_toml(&path).unwrap_err().to_string().ends_with(&format!("at most {TOML_MAX_BYTES} are read")));
    }

    #[cfg(unix)]
    #[test]
    fn a_pipe_and_a_device_are_not_read() {
        let folder = tempfile::tempdir().unwrap();
        let pipe = folder.path().join("pipe");
        let mode = rustix::fs::Mode::RUSR | rustix::fs::Mode::WUSR;
        rustix::fs::mknodat(rustix::fs::CWD, &pipe, rustix::fs::FileType::Fifo, mode, 0).unwrap();
        let error = read(&pipe, 1).unwrap_err().to_string();
        assert_eq!(error, "it is a pipe, and a regular file is expected");
        let error = read(Path::new("/dev/zero"), 1).unwrap_err().to_string();
        assert_eq!(error, "it is a device, and a regular file is expected");
    }
}
