//! A slot of two copies of the limits: finds the newer good one, and writes the next.

use frixel_wire::frame::crc32;

use super::{Flash, LIMITS_LEN, Operation, WORD_LEN, WritableFlash};

/// First bytes of a copy, which change with the layout.
const MAGIC: [u8; 4] = *b"fxl1";
/// Bytes of a copy: magic, sequence number, limits, CRC-32 of all preceding bytes, and four bytes of padding.
pub const COPY_LEN: usize = 2 * WORD_LEN + LIMITS_LEN;
/// Bytes that the CRC-32 covers.
const COVERED_LEN: usize = WORD_LEN + LIMITS_LEN;

/// Two pages of the flash, with a copy of the limits in each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Slot {
    /// Page of the first copy.
    pub first_page: u32,
}

/// A good copy.
struct Copy {
    page: u32,
    sequence: u32,
    limits: [u8; LIMITS_LEN],
}

impl Slot {
    /// The limits in the newer of the good copies; `None` without one.
    pub fn find<F: Flash>(&self, flash: &F) -> Option<[u8; LIMITS_LEN]> {
        self.newest(flash).map(|copy| copy.limits)
    }

    /// Whether nothing was ever stored here.
    pub(super) fn is_erased<F: Flash>(&self, flash: &F) -> bool {
        [self.first_page, self.first_page + 1].into_iter().all(|page| {
            let mut bytes = [0; COPY_LEN];
            flash.read(page * F::PAGE_LEN, &mut bytes) && bytes.iter().all(|byte| *byte == 0xff)
        })
    }

    fn newest<F: Flash>(&self, flash: &F) -> Option<Copy> {
        let copies = [self.first_page, self.first_page + 1].map(|page| read_copy(flash, page));
        match copies {
            [Some(first), Some(second)] => {
                let second_is_newer = (second.sequence.wrapping_sub(first.sequence) as i32) > 0;
                Some(if second_is_newer { second } else { first })
            }
            [first, second] => first.or(second),
        }
    }
}

/// The copy in a page, if it is good.
fn read_copy<F: Flash>(flash: &F, page: u32) -> Option<Copy> {
    let mut bytes = [0; COPY_LEN];
    if !flash.read(page * F::PAGE_LEN, &mut bytes) {
        return None;
    }
    let sequence = u32::from_le_bytes(*bytes.get(MAGIC.len()..)?.first_chunk()?);
    let limits = *bytes.get(WORD_LEN..)?.first_chunk()?;
    (bytes == copy_bytes(sequence, &limits)).then_some(Copy { page, sequence, limits })
}

/// The bytes of a copy.
fn copy_bytes(sequence: u32, limits: &[u8; LIMITS_LEN]) -> [u8; COPY_LEN] {
    let mut bytes = [0xff; COPY_LEN];
    let covered = MAGIC.into_iter().chain(sequence.to_le_bytes()).chain(*limits);
    bytes.iter_mut().zip(covered).for_each(|(to, from)| *to = from);
    let (covered, rest) = bytes.split_at_mut(COVERED_LEN);
    rest.iter_mut().zip(crc32(covered).to_le_bytes()).for_each(|(to, from)| *to = from);
    bytes
}

/// The bytes of the first copy that a board stores, at the beginning of its slot.
pub fn first_copy(limits: &[u8; LIMITS_LEN]) -> [u8; COPY_LEN] {
    copy_bytes(1, limits)
}

/// Writes limits over the older copy of a slot.
#[derive(Debug)]
pub struct Writer {
    page: u32,
    bytes: [u8; COPY_LEN],
    next: Next,
}

/// The next operation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Next {
    Erase,
    Word(usize),
}

/// Progress of a write.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Writing {
    /// There is more to do.
    UnderWay,
    /// The copy was written and verified.
    Done,
    /// The flash has failed. The previous copy is still good.
    Failed,
}

impl Writer {
    /// Prepares to write limits over the older copy of `slot`.
    pub fn new<F: Flash>(slot: Slot, flash: &F, limits: &[u8; LIMITS_LEN]) -> Self {
        let (page, sequence) = match slot.newest(flash) {
            Some(Copy { page, sequence, .. }) => (2 * slot.first_page + 1 - page, sequence.wrapping_add(1)),
            None => (slot.first_page, 1),
        };
        Self { page, bytes: copy_bytes(sequence, limits), next: Next::Erase }
    }

    /// Begins the next operation, unless the last one is still under way.
    pub fn step<F: WritableFlash>(&mut self, flash: &mut F) -> Writing {
        match flash.operation() {
            Operation::Busy => return Writing::UnderWay,
            Operation::Failed => return Writing::Failed,
            Operation::Done => {}
        }
        match self.next {
            Next::Erase => {
                flash.begin_erase(self.page);
                self.next = Next::Word(0);
            }
            Next::Word(number) => {
                let Some(word) = self.bytes.as_chunks().0.get(number) else {
                    let mut written = [0; COPY_LEN];
                    let is_read = flash.read(self.page * F::PAGE_LEN, &mut written);
                    return if is_read && written == self.bytes { Writing::Done } else { Writing::Failed };
                };
                flash.begin_write(self.page * F::PAGE_LEN + (number * WORD_LEN) as u32, *word);
                self.next = Next::Word(number + 1);
            }
        }
        Writing::UnderWay
    }
}
