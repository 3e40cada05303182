//! Finds the line of a byte in an input, and replaces every comment sign by `#`.

use std::collections::VecDeque;
use std::io::{self, Read};

use super::layout::COMMENTS;

/// An input that remembers where the lines end that it has read ahead, and has `#` where a comment begins.
pub(super) struct Lines<R> {
    input: R,
    bytes: u64,
    /// Places of line feeds that no row has reached.
    ahead: VecDeque<u64>,
    /// Number of the line feeds before those.
    before: u64,
    /// Whether the next byte begins a line.
    begins: bool,
}

impl<R> Lines<R> {
    pub(super) fn new(input: R) -> Self {
        Self { input, bytes: 0, ahead: VecDeque::new(), before: 0, begins: true }
    }

    /// The last line of a row that ends before byte `end`, its line feed included if the row has taken it. Rows are
    /// asked for in their order.
    pub(super) fn last_line(&mut self, end: u64) -> u64 {
        let mut last = None;
        while let Some(place) = self.ahead.pop_front_if(|place| *place < end) {
            self.before += 1;
            last = Some(place);
        }
        let has_taken_it = last.is_some_and(|place| place + 1 == end);
        1 + self.before - u64::from(has_taken_it)
    }
}

impl<R: Read> Read for Lines<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let count = self.input.read(buffer)?;
        for (place, byte) in (self.bytes..).zip(buffer.iter_mut().take(count)) {
            if self.begins && COMMENTS.contains(byte) {
                *byte = b'#';
            }
            self.begins = matches!(byte, b'\n' | b'\r');
            if *byte == b'\n' {
                self.ahead.push_back(place);
            }
        }
        self.bytes += count as u64;
        Ok(count)
    }
}
