//! Where the last line of an input ends.

use std::io::{self, Read};

/// An input that remembers its last byte, and how many came before it.
pub(super) struct LineEnds<R> {
    input: R,
    bytes: u64,
    last: u8,
}

impl<R> LineEnds<R> {
    pub(super) fn new(input: R) -> Self {
        Self { input, bytes: 0, last: 0 }
    }

    /// Whether a row that ends before this byte ends with a line feed. All do but one at the end of the input.
    pub(super) fn is_ended_at(&self, byte: u64) -> bool {
        byte < self.bytes || self.last == b'\n'
    }
}

impl<R: Read> Read for LineEnds<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.input.read(buffer)?;
        self.bytes += count as u64;
        if let Some(last) = count.checked_sub(1).and_then(|last| buffer.get(last)) {
            self.last = *last;
        }
        Ok(count)
    }
}
