//! Serial bytes that DMA puts into a ring, as fast as they come, and the session takes out.

use core::ops::Range;

/// Where the next byte is read in a ring of `LEN` bytes that DMA writes round and round.
///
/// Nothing tells how often DMA went round. So no byte is lost as long as fewer than `LEN` wait to be read: on a frixel
/// board the host's credit sees to that.
#[derive(Debug, Default)]
pub struct RingReader<const LEN: usize> {
    next: usize,
}

impl<const LEN: usize> RingReader<LEN> {
    /// DMA begins at the start of the ring.
    pub const fn new() -> Self {
        Self { next: 0 }
    }

    /// The next bytes that lie in one piece, when DMA has `remaining` transfers to go before it begins anew; empty when
    /// all were taken.
    pub fn take(&mut self, remaining: usize) -> Range<usize> {
        // A count of zero is seen for a moment before DMA loads it again.
        let write = LEN.saturating_sub(remaining) % LEN;
        let end = if write < self.next { LEN } else { write };
        let piece = self.next..end;
        self.next = end % LEN;
        piece
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn a_count_of_zero_is_the_start() {
        let mut reader = RingReader::<8>::new();
        assert_eq!(reader.take(3), 0..5);
        assert_eq!(reader.take(0), 5..8);
        assert_eq!(reader.take(8), 0..0);
        assert_eq!(reader.take(7), 0..1);
    }

    proptest! {
        /// Every byte comes out once, in order, however writing and reading are interleaved.
        #[test]
        fn no_byte_is_lost_or_repeated(steps in proptest::collection::vec((0_usize..40, any::<bool>()), 1..400)) {
            const LEN: usize = 32;
            let mut ring = [0_u32; LEN];
            let mut reader = RingReader::<LEN>::new();
            let (mut written, mut read) = (0, 0);
            for (count, drain) in steps {
                for _ in 0..count.min(LEN - 1 - (written - read)) {
                    ring[written % LEN] = written as u32;
                    written += 1;
                }
                loop {
                    let piece = reader.take(LEN - written % LEN);
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
