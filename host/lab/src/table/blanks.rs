//! Reduces any number of blanks between columns to one.

use std::io::{self, Read};

use super::layout::BLANK;

/// An input whose lines neither begin nor end with blanks, and have one between columns.
pub(super) struct Blanks<R> {
    input: R,
    is_active: bool,
    /// Whether a blank stands between the last column and the next one.
    is_between: bool,
    /// Whether the line has had a column.
    has_begun: bool,
}

impl<R> Blanks<R> {
    /// An input that is left as it is unless `is_active`.
    pub(super) fn new(input: R, is_active: bool) -> Self {
        Self { input, is_active, is_between: false, has_begun: false }
    }
}

impl<R: Read> Read for Blanks<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        if !self.is_active {
            return self.input.read(buffer);
        }
        // A byte that is read becomes a column's byte and the blank before it at most.
        let mut chunk = vec![0; buffer.len() / 2];
        loop {
            let count = self.input.read(&mut chunk)?;
            let mut written = 0;
            let mut put = |byte| {
                if let Some(place) = buffer.get_mut(written) {
                    *place = byte;
                    written += 1;
                }
            };
            for byte in chunk.iter().copied().take(count) {
                match byte {
                    b'\n' | b'\r' => (self.is_between, self.has_begun) = (false, false),
                    b' ' | b'\t' => {
                        self.is_between = self.has_begun;
                        continue;
                    }
                    _ => {
                        if self.is_between {
                            put(BLANK);
                        }
                        (self.is_between, self.has_begun) = (false, true);
                    }
                }
                put(byte);
            }
            if written > 0 || count == 0 {
                return Ok(written);
            }
        }
    }
}
