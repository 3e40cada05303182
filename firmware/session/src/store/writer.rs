//! Writes one copy, one operation of the flash at a time.

use frixel_wire::frame::Crc32;

use super::copy::{HEADER_LEN, header};
use super::{Flash, Found, Operation, Slot, WORD_LEN};

/// Writes a copy over the older one of a slot.
#[derive(Debug)]
pub struct Writer {
    slot: Slot,
    copy: u32,
    sequence: u32,
    len: u32,
    next: Next,
    digest: Crc32,
}

/// The next operation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Next {
    Erase { page: u32 },
    Content { offset: u32 },
    Header { word: usize },
    Check,
}

/// Progress of a write.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Writing {
    /// The flash has not ended the last operation.
    Busy,
    /// There is more to do.
    UnderWay,
    /// The copy was written and verified.
    Done(Found),
    /// The flash has failed. The previous copy is still good.
    Failed,
}

impl Writer {
    /// Prepares to write `len` bytes over the older copy of `slot`; `found` is the newer one. `None` if they do not
    /// fit.
    pub fn new<F: Flash>(slot: Slot, found: Option<&Found>, len: u32) -> Option<Self> {
        let (copy, sequence) = found.map_or((0, 1), Found::next);
        let next = Next::Erase { page: 0 };
        (len <= slot.capacity::<F>()).then(|| Self { slot, copy, sequence, len, next, digest: Crc32::new() })
    }

    /// Begins the next operation, unless the last one is still under way. `content` returns the word of the content at
    /// an offset; the content must not change until all of it is written.
    pub fn step<F: Flash>(&mut self, flash: &mut F, content: impl Fn(u32) -> [u8; WORD_LEN]) -> Writing {
        match flash.operation() {
            Operation::Busy => return Writing::Busy,
            Operation::Failed => return Writing::Failed,
            Operation::Done => {}
        }
        let start = self.slot.offset::<F>(self.copy);
        match self.next {
            Next::Erase { page } => {
                flash.begin_erase(self.slot.page(self.copy) + page);
                let erased = page + 1 == self.pages::<F>();
                self.next = if erased { Next::Content { offset: 0 } } else { Next::Erase { page: page + 1 } };
            }
            Next::Content { offset } if offset < self.len => {
                let word = content(offset);
                let used = WORD_LEN.min((self.len - offset) as usize);
                self.digest.update(word.get(..used).unwrap_or_default());
                flash.begin_write(start + HEADER_LEN as u32 + offset, word);
                self.next = Next::Content { offset: offset + WORD_LEN as u32 };
            }
            Next::Content { .. } => self.next = Next::Header { word: 0 },
            Next::Header { word } => match header(self.sequence, self.len, self.digest.finish()).get(word) {
                Some(bytes) => {
                    flash.begin_write(start + (word * WORD_LEN) as u32, *bytes);
                    self.next = Next::Header { word: word + 1 };
                }
                None => self.next = Next::Check,
            },
            Next::Check => {
                return self.slot.check(flash, self.copy).map_or(Writing::Failed, Writing::Done);
            }
        }
        Writing::UnderWay
    }

    /// Pages that the copy takes, at least one.
    fn pages<F: Flash>(&self) -> u32 {
        (self.len + HEADER_LEN as u32).div_ceil(F::PAGE_LEN)
    }
}
