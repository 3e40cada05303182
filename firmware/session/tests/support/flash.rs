//! Simulated flash whose power can fail at any byte of an operation.

use frixel_session::store::{Flash, Operation, WORD_LEN, WritableFlash};
use frixel_testkit::Random;

pub const PAGE_LEN: usize = 512;

/// The flash of a board.
#[derive(Clone)]
pub struct SimulatedFlash {
    pub bytes: Vec<u8>,
    /// Words that cannot be read, because they were half written when the power went, or half erased.
    torn: Vec<bool>,
    /// Bytes of operations until the power fails; `None` if it does not.
    pub power_left: Option<usize>,
    /// Bytes of operations that were done.
    pub done: usize,
    /// Calls of `operation` for which an operation is busy.
    busy: u32,
    /// Whether operations fail.
    pub is_worn: bool,
    failed: bool,
    /// Whether torn words can be read.
    torn_words_read: bool,
    noise: Random,
}

impl SimulatedFlash {
    pub fn new(pages: usize, torn_words_read: bool) -> Self {
        Self {
            bytes: vec![0xff; pages * PAGE_LEN],
            torn: vec![false; pages * PAGE_LEN / WORD_LEN],
            power_left: None,
            done: 0,
            busy: 0,
            is_worn: false,
            failed: false,
            torn_words_read,
            noise: Random::new(1),
        }
    }

    pub fn has_power(&self) -> bool {
        self.power_left != Some(0)
    }

    /// The same flash once the power has come back.
    pub fn after_power_on(&self) -> Self {
        Self { power_left: None, done: 0, busy: 0, ..self.clone() }
    }

    /// Performs one byte of an operation; returns `false` if power failed first.
    fn perform_byte(&mut self) -> bool {
        if !self.has_power() {
            return false;
        }
        self.power_left = self.power_left.map(|left| left - 1);
        self.done += 1;
        true
    }
}

impl Flash for SimulatedFlash {
    const PAGE_LEN: u32 = PAGE_LEN as u32;

    fn read(&self, offset: u32, bytes: &mut [u8]) -> bool {
        assert!(self.busy == 0 || !self.has_power(), "the bank is read while it is written");
        let offset = offset as usize;
        bytes.copy_from_slice(&self.bytes[offset..offset + bytes.len()]);
        let torn = self.torn[offset / WORD_LEN..(offset + bytes.len()).div_ceil(WORD_LEN)].iter().any(|torn| *torn);
        self.torn_words_read || !torn
    }
}

impl WritableFlash for SimulatedFlash {
    fn begin_erase(&mut self, page: u32) {
        assert_eq!(self.busy, 0, "one operation at a time");
        (self.busy, self.failed) = (3, self.is_worn);
        let start = page as usize * PAGE_LEN;
        for at in start..start + PAGE_LEN {
            if !self.perform_byte() {
                if at == start {
                    return;
                }
                // The content is undefined between the previous one and erased.
                for at in start..start + PAGE_LEN {
                    self.bytes[at] |= self.noise.byte();
                    self.torn[at / WORD_LEN] = true;
                }
                return;
            }
            self.bytes[at] = 0xff;
            self.torn[at / WORD_LEN] = false;
        }
    }

    fn begin_write(&mut self, offset: u32, word: [u8; WORD_LEN]) {
        assert_eq!(self.busy, 0, "one operation at a time");
        (self.busy, self.failed) = (2, self.is_worn);
        let start = offset as usize;
        assert_eq!(start % WORD_LEN, 0);
        assert!(self.bytes[start..start + WORD_LEN].iter().all(|byte| *byte == 0xff), "{start} is not erased");
        for (at, byte) in (start..).zip(word) {
            if !self.perform_byte() {
                if at > start {
                    self.bytes[at] &= self.noise.byte();
                    self.torn[at / WORD_LEN] = true;
                }
                return;
            }
            self.bytes[at] = byte;
        }
    }

    fn operation(&mut self) -> Operation {
        if self.busy > 0 {
            self.busy -= 1;
            return Operation::Busy;
        }
        if core::mem::take(&mut self.failed) { Operation::Failed } else { Operation::Done }
    }
}
