//! Size limits of the files that the command, the page and Python read.

#[cfg(not(target_arch = "wasm32"))]
mod file;
#[cfg(not(target_arch = "wasm32"))]
mod scene_files;

use std::io::{self, BufRead, BufReader, Read};
use std::path::Path;

use thiserror::Error;
use unicode_normalization::UnicodeNormalization;

#[cfg(not(target_arch = "wasm32"))]
pub use file::{open, read, read_named, read_toml};
pub use frixel_scene::TEXT_MAX_BYTES as TOML_MAX_BYTES;
use frixel_scene::TILDE_ADVICE;
#[cfg(not(target_arch = "wasm32"))]
pub use scene_files::{KeptFiles, SceneFolder};

/// Largest picture: a PNG of noise of 4,000 by 4,000 pixels.
pub const PICTURE_MAX_BYTES: u64 = 64 << 20;
/// Largest table or recording: an hour of felt.csv, 3.6 million rows, is 250 MB.
pub const CSV_MAX_BYTES: u64 = 512 << 20;
/// Most rows of a table or a recording: four minutes at 40 kHz.
pub const ROWS_MAX: u64 = 10_000_000;

/// Most columns of a table, and most bytes of a cell of its header.
const COLUMNS_MAX: u64 = 4096;
const HEADER_CELL_MAX_BYTES: u64 = 1024;

/// Whether two names of files are the same text. An accented letter is one character or two, and file systems and text
/// editors choose differently.
///
/// ```
/// assert!(frixel_lab::input::is_same_name("gr\u{fc}n.png", "gru\u{308}n.png"));
/// assert!(!frixel_lab::input::is_same_name("gr\u{fc}n.png", "grun.png"));
/// ```
pub fn is_same_name(one: &str, other: &str) -> bool {
    one.nfc().eq(other.nfc())
}

/// Advice for a path that cannot be used: `advice`, unless the path starts with a tilde.
pub fn check_path<'a>(path: &Path, advice: &'a str) -> &'a str {
    if path.starts_with("~") { TILDE_ADVICE } else { advice }
}

/// Refuses a table with too many columns, or with a header that has a cell of too many bytes.
pub(crate) fn check_header<'c>(cells: impl Iterator<Item = &'c [u8]>) -> Result<(), InputError> {
    let sizes = cells.map(|cell| cell.len() as u64);
    let (columns, longest) = sizes.fold((0, 0), |(columns, longest), size| (columns + 1, size.max(longest)));
    at_most("columns", columns, COLUMNS_MAX)?;
    at_most("bytes in a cell of its header", longest, HEADER_CELL_MAX_BYTES)
}

/// Refuses a number above a limit.
pub(crate) fn at_most(what: &'static str, found: u64, max: u64) -> Result<(), InputError> {
    if found > max { Err(InputError::TooMany { what, found, max }) } else { Ok(()) }
}

/// Why an input is not read.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum InputError {
    /// The file has too many bytes.
    #[error("it has {found} bytes, and at most {max} are read")]
    TooLarge {
        /// Size of the file, bytes.
        found: u64,
        /// Most bytes that are read.
        max: u64,
    },
    /// More bytes arrived than the stated size of the file, or than the limit of standard input.
    #[error("it is longer than {max} bytes, the most that are read")]
    TooLong {
        /// Most bytes that are read.
        max: u64,
    },
    /// A count, such as the number of rows, exceeds its limit.
    #[error("it has {found} {what}, and at most {max} are read")]
    TooMany {
        /// The counted items, in words.
        what: &'static str,
        /// Number of these in the input, or one more than the limit.
        found: u64,
        /// Most that are read.
        max: u64,
    },
    /// It is not a regular file.
    #[error("it is a {what}, and a regular file is expected")]
    NotAFile {
        /// Kind of the file, in words.
        what: &'static str,
    },
    /// The operating system has nothing to read at this time.
    #[error("it has no end, and a regular file is expected")]
    Endless,
}

impl From<InputError> for io::Error {
    fn from(error: InputError) -> Self {
        Self::other(error)
    }
}

/// Calls `each` with every line that has an end, and returns the number of their bytes. A killed process may have left
/// part of a line behind them.
pub fn whole_lines(input: impl Read, mut each: impl FnMut(&[u8])) -> io::Result<u64> {
    let (mut input, mut line, mut bytes) = (BufReader::new(input), Vec::new(), 0);
    while input.read_until(b'\n', &mut line)? > 0 {
        let Some(text) = line.strip_suffix(b"\n") else { break };
        each(text);
        bytes += line.len() as u64;
        line.clear();
    }
    Ok(bytes)
}

/// A reader that fails after a number of bytes.
#[derive(Debug)]
pub struct Bounded<R> {
    input: R,
    left: u64,
    max: u64,
}

impl<R: Read> Bounded<R> {
    /// Creates a reader of at most `max_bytes` bytes.
    pub fn new(input: R, max_bytes: u64) -> Self {
        Self { input, left: max_bytes, max: max_bytes }
    }

    /// The reader without its limit.
    pub fn into_inner(self) -> R {
        self.input
    }

    /// Creates a reader of a file with a stated size of `found_bytes` bytes.
    pub fn of_file(input: R, found_bytes: u64, max_bytes: u64) -> Result<Self, InputError> {
        if found_bytes > max_bytes {
            return Err(InputError::TooLarge { found: found_bytes, max: max_bytes });
        }
        Ok(Self::new(input, max_bytes))
    }
}

impl<R: Read> Read for Bounded<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let too_long = || InputError::TooLong { max: self.max }.into();
        let outcome = if self.left == 0 && !buffer.is_empty() {
            // Only a reader that has more is too long.
            match self.input.read(&mut [0]) {
                Ok(0) => Ok(0),
                Ok(_) => Err(too_long()),
                Err(error) => Err(error),
            }
        } else {
            let len = buffer.len().min(usize::try_from(self.left).unwrap_or(usize::MAX));
            self.input.read(buffer.get_mut(..len).unwrap_or_default())
        };
        match outcome {
            Ok(count) => {
                self.left -= count as u64;
                Ok(count)
            }
            Err(error) if error.kind() == io::ErrorKind::WouldBlock => Err(InputError::Endless.into()),
            Err(error) => Err(error),
        }
    }
}

#[cfg(test)]
mod tests {
    use std::io::repeat;

    use super::*;

    #[test]
    fn a_header_has_the_columns_and_the_bytes_that_are_read() {
        assert!(check_header(std::iter::repeat_n(&b"x"[..], 4096)).is_ok());
        let error = check_header(std::iter::repeat_n(&b"x"[..], 100_000)).unwrap_err().to_string();
        assert_eq!(error, "it has 100000 columns, and at most 4096 are read");
        let error = check_header(std::iter::once(&vec![b'x'; 40_000_000][..])).unwrap_err().to_string();
        assert_eq!(error, "it has 40000000 bytes in a cell of its header, and at most 1024 are read");
    }

    #[test]
    fn an_input_without_end_ends_at_its_limit() {
        let mut bytes = Vec::new();
        let error = Bounded::new(repeat(7), 10_000).read_to_end(&mut bytes).unwrap_err();
        assert_eq!(error.to_string(), "it is longer than 10000 bytes, the most that are read");
        assert_eq!(bytes.len(), 10_000);
        let mut bytes = Vec::new();
        Bounded::new(repeat(7).take(10_000), 10_000).read_to_end(&mut bytes).unwrap();
    }
}
