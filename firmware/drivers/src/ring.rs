//! Reading the ring into which DMA writes serial bytes.

use core::ops::Range;

/// The read position in a ring of `LEN` bytes that DMA fills in circular mode.
///
/// DMA does not report how often it has wrapped, so bytes are lost unless fewer than `LEN` wait to be read. On a
/// frixel board the host's credit ensures that.
#[derive(Debug, Default)]
pub struct RingReader<const LEN: usize> {
    next: usize,
}

impl<const LEN: usize> RingReader<LEN> {
    /// A reader of a ring whose DMA starts at the beginning.
    pub const fn new() -> Self {
        Self { next: 0 }
    }

    /// Whether no byte waits to be read. `remaining` is the number of transfers before DMA wraps.
    pub fn is_empty(&self, remaining: usize) -> bool {
        Self::write_position(remaining) == self.next
    }

    /// Takes the next contiguous bytes, at most `max_len`, and returns their range in the ring. Empty when all are
    /// taken.
    pub fn take(&mut self, remaining: usize, max_len: usize) -> Range<usize> {
        let write = Self::write_position(remaining);
        let end = if write < self.next { LEN } else { write };
        let piece = self.next..end.min(self.next.saturating_add(max_len));
        self.next = piece.end % LEN;
        piece
    }

    fn write_position(remaining: usize) -> usize {
        // DMA shows a count of zero for a moment before it reloads it.
        LEN.saturating_sub(remaining) % LEN
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_count_of_zero_is_the_start() {
        const LEN: usize = 8;
        let mut reader = RingReader::<LEN>::new();
        assert_eq!(reader.take(3, LEN), 0..5);
        assert!(!reader.is_empty(0));
        assert_eq!(reader.take(0, LEN), 5..8);
        assert!(reader.is_empty(8));
        assert_eq!(reader.take(8, LEN), 0..0);
        assert_eq!(reader.take(7, LEN), 0..1);
    }

    proptest! {
        /// Every byte comes out once, in order, however writing and reading are interleaved.
        #[test]
        fn no_byte_is_lost_or_repeated(
            steps in proptest::collection::vec((0_usize..40, any::<bool>(), 1_usize..40), 1..400),
        ) {
            const LEN: usize = 32;
            let mut ring = [0_u32; LEN];
            let mut reader = RingReader::<LEN>::new();
            let (mut written, mut read) = (0, 0);
            for (count, drain, max_len) in steps {
                for _ in 0..count.min(LEN - 1 - (written - read)) {
                    ring[written % LEN] = written as u32;
                    written += 1;
                }
                loop {
                    let piece = reader.take(LEN - written % LEN, max_len);
                    let empty = piece.is_empty();
                    for byte in &ring[piece] {
                        prop_assert_eq!(*byte, read as u32);
                        read += 1;
                    }
                    if empty || !drain { break; }
                }
            }
            prop_assert!(read <= written);
        }
    }
}
