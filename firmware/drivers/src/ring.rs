//! The ring into which DMA or an interrupt writes serial bytes.

use core::ops::Range;
use core::sync::atomic::{AtomicU8, AtomicUsize, Ordering};

/// The read position in a ring of `LEN` bytes that DMA fills in circular mode.
///
/// DMA does not report how often it has wrapped, so bytes are lost unless fewer than `LEN` are unread. On a frixel
/// board, the host's credit ensures that.
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

    /// Takes the next contiguous bytes, at most `max_len`, and returns their range in the ring. Empty if all are taken.
    pub fn take(&mut self, remaining: usize, max_len: usize) -> Range<usize> {
        let write = Self::write_position(remaining);
        let end = if write < self.next { LEN } else { write };
        let piece = self.next..end.min(self.next.saturating_add(max_len));
        self.next = piece.end % LEN;
        piece
    }

    /// Copies the next bytes of `ring` to the start of `bytes`, and returns their number. Waits for the first one,
    /// calling `remaining` repeatedly.
    pub fn read(&mut self, ring: &[AtomicU8; LEN], mut remaining: impl FnMut() -> usize, bytes: &mut [u8]) -> usize {
        if bytes.is_empty() {
            return 0;
        }
        loop {
            let piece = self.take(remaining(), bytes.len());
            let places = ring.get(piece).unwrap_or_default();
            if places.is_empty() {
                continue;
            }
            for (to, from) in bytes.iter_mut().zip(places) {
                *to = from.load(Ordering::Relaxed);
            }
            return places.len();
        }
    }

    fn write_position(remaining: usize) -> usize {
        // DMA shows a count of zero for a moment before it reloads it.
        LEN.saturating_sub(remaining) % LEN
    }
}

/// A ring filled byte by byte by an interrupt, where there is no DMA.
pub struct InterruptRing<const LEN: usize> {
    /// The bytes.
    pub bytes: [AtomicU8; LEN],
    /// Place of the next byte, written only by the interrupt. It starts at zero, so that a static is initially all
    /// zeros, which takes no flash.
    next: AtomicUsize,
}

impl<const LEN: usize> InterruptRing<LEN> {
    /// An empty ring.
    #[allow(clippy::new_without_default, reason = "it belongs in a static")]
    pub const fn new() -> Self {
        Self { bytes: [const { AtomicU8::new(0) }; LEN], next: AtomicUsize::new(0) }
    }

    /// Stores a byte. Only the interrupt calls this.
    #[inline]
    pub fn push(&self, byte: u8) {
        let next = self.next.load(Ordering::Relaxed);
        if let Some(place) = self.bytes.get(next) {
            place.store(byte, Ordering::Relaxed);
        }
        self.next.store(if next + 1 < LEN { next + 1 } else { 0 }, Ordering::Release);
    }

    /// Bytes until the ring wraps around, as DMA would count them.
    #[inline]
    pub fn remaining(&self) -> usize {
        LEN - self.next.load(Ordering::Acquire)
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

    #[test]
    fn a_read_waits_for_the_first_byte() {
        let ring = InterruptRing::<8>::new();
        let mut asked = 0;
        let remaining = || {
            asked += 1;
            if asked == 3 {
                ring.push(7);
            }
            ring.remaining()
        };
        let mut bytes = [0; 8];
        assert_eq!(RingReader::new().read(&ring.bytes, remaining, &mut bytes), 1);
        assert_eq!((bytes[0], asked), (7, 3));
        assert_eq!(RingReader::new().read(&ring.bytes, || ring.remaining(), &mut []), 0);
    }

    proptest! {
        /// Every byte comes out once, in order, however writing and reading are interleaved.
        #[test]
        fn no_byte_is_lost_or_repeated(
            steps in proptest::collection::vec((0_usize..40, any::<bool>(), 1_usize..40), 1..400),
        ) {
            const LEN: usize = 32;
            let ring = InterruptRing::<LEN>::new();
            let mut reader = RingReader::new();
            let (mut written, mut read) = (0_usize, 0_usize);
            for (count, drain, max_len) in steps {
                for _ in 0..count.min(LEN - 1 - (written - read)) {
                    ring.push(written as u8);
                    written += 1;
                }
                while !reader.is_empty(ring.remaining()) {
                    let mut bytes = [0; LEN];
                    let max_len = max_len.min(LEN);
                    let len = reader.read(&ring.bytes, || ring.remaining(), &mut bytes[..max_len]);
                    for byte in &bytes[..len] {
                        prop_assert_eq!(*byte, read as u8);
                        read += 1;
                    }
                    if !drain { break; }
                }
            }
            prop_assert!(read <= written);
        }
    }
}
