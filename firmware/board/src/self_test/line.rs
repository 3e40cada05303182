//! The test of the serial line: both sides send numbered blocks at the full line rate, and count missing ones.

use frixel_wire::frame::{Decoder, FRAME_MAX_LEN, encode};

/// Bytes of a block: its number, followed by bytes derived from it.
const BLOCK_LEN: usize = 128;

/// One side of the test, used by board and host.
#[derive(Debug)]
pub struct LineTest {
    decoder: Decoder,
    /// The block being sent, and the range of its unsent bytes.
    frame: [u8; FRAME_MAX_LEN],
    sent: usize,
    len: usize,
    next_out: u32,
    next_in: u32,
    missing: u32,
}

impl LineTest {
    /// A side that has neither sent nor received.
    pub const fn new() -> Self {
        Self {
            decoder: Decoder::new(),
            // An empty frame, which ends earlier data on the line.
            frame: [0; FRAME_MAX_LEN],
            sent: 0,
            len: 1,
            next_out: 0,
            next_in: 0,
            missing: 0,
        }
    }

    /// Takes received bytes.
    pub fn take(&mut self, mut bytes: &[u8]) {
        while let Some(block) = self.decoder.next_frame(&mut bytes) {
            let Some(number) = block.first_chunk().map(|number| u32::from_le_bytes(*number)) else { continue };
            // A block from before the test, such as text of the same length, has other content.
            if block == contents(number) {
                self.missing = self.missing.wrapping_add(number.wrapping_sub(self.next_in));
                self.next_in = number.wrapping_add(1);
            }
        }
    }

    /// The bytes to send next.
    pub fn pending(&mut self) -> &[u8] {
        if self.sent == self.len {
            self.len = encode(&contents(self.next_out), &mut self.frame).map_or(0, <[u8]>::len);
            self.sent = 0;
            self.next_out = self.next_out.wrapping_add(1);
        }
        self.frame.get(self.sent..self.len).unwrap_or_default()
    }

    /// Records that `len` of the [`Self::pending`] bytes were sent.
    pub fn advance(&mut self, len: usize) {
        self.sent = self.len.min(self.sent + len);
    }

    /// Number of intact blocks received.
    pub fn received(&self) -> u32 {
        self.next_in.wrapping_sub(self.missing)
    }

    /// Number of missing blocks, up to the last one received.
    pub fn missing(&self) -> u32 {
        self.missing
    }

    /// Number of invalid pieces between two ends of frames.
    pub fn damaged(&self) -> u32 {
        self.decoder.rejected()
    }

    /// Number of blocks begun.
    pub fn sent(&self) -> u32 {
        self.next_out
    }
}

impl Default for LineTest {
    fn default() -> Self {
        Self::new()
    }
}

fn contents(number: u32) -> [u8; BLOCK_LEN] {
    let mut bytes = [0; BLOCK_LEN];
    let mut state = number;
    for (index, word) in bytes.as_chunks_mut::<4>().0.iter_mut().enumerate() {
        *word = state.to_le_bytes();
        // Constants of a linear congruential generator by Knuth (MMIX), low halves.
        state = state.wrapping_mul(0x4c95_7f2d).wrapping_add(0xf767_814f ^ index as u32);
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Sends blocks until `len` bytes are there.
    fn bytes(len: usize) -> Vec<u8> {
        let (mut side, mut sent) = (LineTest::new(), Vec::new());
        while sent.len() < len {
            let pending = side.pending().to_vec();
            side.advance(pending.len());
            sent.extend(pending);
        }
        sent
    }

    #[test]
    fn text_before_the_first_block_costs_one_damaged_piece() {
        let mut side = LineTest::new();
        side.take(b"Then type: line or skip\r\n");
        side.take(&bytes(1000));
        assert_eq!((side.missing(), side.damaged()), (0, 1));
        assert!(side.received() >= 7);
    }

    proptest! {
        /// A lost, doubled or changed byte damages at most two adjacent blocks. The byte at 0 only ends earlier data,
        /// so its loss costs nothing.
        #[test]
        fn a_disturbed_byte_is_counted(at in 1_usize..1500, kind in 0..3) {
            let mut sent = bytes(4000);
            match kind {
                0 => { sent.remove(at); }
                1 => sent.insert(at, sent[at]),
                _ => sent[at] ^= 0x10,
            }
            let mut side = LineTest::new();
            side.take(&sent);
            let doubled_end = kind == 1 && sent[at] == 0;
            prop_assert_eq!(side.damaged() > 0, !doubled_end);
            prop_assert_eq!(side.missing() > 0, !doubled_end);
            prop_assert!(side.missing() <= 2, "{:?}", side);
        }
    }
}
