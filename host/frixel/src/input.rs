//! What the command reads: regular files and standard input, each up to a stated size.
//!
//! A file that is a pipe or a device is not read, since it may have no end. Errors are [`io::Error`]s, for the
//! sentences of those who read.

use std::fs::{File, FileType, OpenOptions};
use std::io::{self, BufRead, Read, Seek, SeekFrom};
use std::path::Path;

use frixel_lab::input::InputError;
pub(crate) use frixel_lab::input::{Bounded, CSV_MAX_BYTES, PICTURE_MAX_BYTES};
pub(crate) use frixel_scene::TEXT_MAX_BYTES as TOML_MAX_BYTES;

/// Largest WAV file: 12 minutes of 44.1 kHz, 16 bits, stereo.
pub(crate) const WAV_MAX_BYTES: u64 = 128 << 20;
/// Longest line of a person on standard input, in bytes; what is beyond it is dropped.
pub(crate) const LINE_MAX_BYTES: usize = 4096;

/// Opens a regular file of at most `max_bytes` bytes. Reading beyond them is an error.
pub(crate) fn open(path: &Path, max_bytes: u64) -> io::Result<Bounded<File>> {
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
pub(crate) fn read(path: &Path, max_bytes: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    open(path, max_bytes)?.read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// Reads a regular file of at most `max_bytes` bytes of UTF-8 text.
pub(crate) fn read_text(path: &Path, max_bytes: u64) -> io::Result<String> {
    let mut text = String::new();
    open(path, max_bytes)?.read_to_string(&mut text)?;
    Ok(text)
}

/// Reads the first bytes of a regular file of any size, at most `max_bytes` of them.
pub(crate) fn read_head(path: &Path, max_bytes: u64) -> io::Result<Vec<u8>> {
    let mut head = Vec::new();
    open(path, u64::MAX)?.take(max_bytes).read_to_end(&mut head)?;
    Ok(head)
}

/// Reads the last bytes of a regular file of any size, at most `max_bytes` of them.
pub(crate) fn read_tail(path: &Path, max_bytes: u64) -> io::Result<Vec<u8>> {
    let mut file = open(path, u64::MAX)?.into_inner();
    let len = file.metadata()?.len();
    file.seek(SeekFrom::Start(len.saturating_sub(max_bytes)))?;
    let mut tail = Vec::new();
    file.take(max_bytes).read_to_end(&mut tail)?;
    Ok(tail)
}

/// What a file is that is not a regular one. Reading a folder is an error already.
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

/// The next line, without its end; `None` at the end of the input or when it breaks. Bytes beyond [`LINE_MAX_BYTES`]
/// are dropped, and bytes that are not UTF-8 replaced.
pub(crate) fn next_line(input: &mut impl BufRead) -> Option<String> {
    let mut line = Vec::new();
    let mut is_any = false;
    loop {
        let bytes = match input.fill_buf() {
            Ok(bytes) => bytes,
            Err(error) if error.kind() == io::ErrorKind::Interrupted => continue,
            Err(_) => return None,
        };
        if bytes.is_empty() {
            return is_any.then(|| text(&line));
        }
        is_any = true;
        let end = bytes.iter().position(|byte| *byte == b'\n');
        let part = bytes.get(..end.unwrap_or(bytes.len())).unwrap_or_default();
        let room = LINE_MAX_BYTES - line.len();
        line.extend(part.iter().take(room));
        let used = part.len() + usize::from(end.is_some());
        input.consume(used);
        if end.is_some() {
            return Some(text(&line));
        }
    }
}

fn text(line: &[u8]) -> String {
    String::from_utf8_lossy(line.strip_suffix(b"\r").unwrap_or(line)).into_owned()
}

#[cfg(test)]
mod tests {
    use std::fs;
    use std::io::{BufReader, repeat};

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

    #[test]
    fn a_line_without_end_is_not_kept() {
        let mut input = BufReader::new(repeat(b'x').take(50_000_000).chain(&b"\r\nnext\nlast"[..]));
        assert_eq!(next_line(&mut input).unwrap().len(), LINE_MAX_BYTES);
        assert_eq!(next_line(&mut input).as_deref(), Some("next"));
        assert_eq!(next_line(&mut input).as_deref(), Some("last"));
        assert_eq!(next_line(&mut input), None);
    }
}
