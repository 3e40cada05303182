//! A slot of two copies, and the search for the newer good one.

use frixel_wire::frame::{Crc32, crc32};

use super::{Flash, WORD_LEN};

/// First bytes of a header. Every change of the layout changes them.
const MAGIC: u32 = u32::from_le_bytes(*b"fxs1");
/// Bytes of a header: magic, sequence number, length and CRC-32 of the content, CRC-32 of the header up to here, and
/// four bytes that fill the last word.
pub(super) const HEADER_LEN: usize = 3 * WORD_LEN;
/// Bytes that are read at once.
const READ_LEN: usize = 64;

/// Pages of the flash that hold two copies of the same kind of content, one after the other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Slot {
    /// First page of the first copy.
    pub first_page: u32,
    /// Pages of each copy.
    pub pages: u32,
}

/// A good copy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Found {
    /// Which of the two it is: 0 or 1.
    copy: u32,
    sequence: u32,
    /// Bytes of its content.
    pub len: u32,
    /// CRC-32 of its content.
    pub crc32: u32,
}

impl Found {
    /// The number and the sequence number of the next copy, if this one is the newest.
    pub(super) fn next(&self) -> (u32, u32) {
        (1 - self.copy, self.sequence.wrapping_add(1))
    }
}

impl Slot {
    /// Largest length of the content, in bytes.
    pub const fn capacity<F: Flash>(&self) -> u32 {
        (self.pages * F::PAGE_LEN).saturating_sub(HEADER_LEN as u32)
    }

    /// Finds the newer of the good copies.
    pub fn find<F: Flash>(&self, flash: &F) -> Option<Found> {
        let (first, second) = (self.check(flash, 0), self.check(flash, 1));
        match (first, second) {
            (Some(first), Some(second)) => {
                let second_is_newer = (second.sequence.wrapping_sub(first.sequence) as i32) > 0;
                Some(if second_is_newer { second } else { first })
            }
            (first, second) => first.or(second),
        }
    }

    /// Reads content of a good copy. Returns `false` beyond its end.
    #[must_use]
    pub fn read<F: Flash>(&self, flash: &F, found: &Found, offset: u32, bytes: &mut [u8]) -> bool {
        let inside = offset.checked_add(bytes.len() as u32).is_some_and(|end| end <= found.len);
        inside && flash.read(self.offset::<F>(found.copy) + HEADER_LEN as u32 + offset, bytes)
    }

    /// First byte of a copy.
    pub(super) fn offset<F: Flash>(&self, copy: u32) -> u32 {
        self.page(copy) * F::PAGE_LEN
    }

    /// First page of a copy.
    pub(super) fn page(&self, copy: u32) -> u32 {
        self.first_page + copy * self.pages
    }

    /// Returns the copy if it is good.
    pub(super) fn check<F: Flash>(&self, flash: &F, copy: u32) -> Option<Found> {
        let mut header = [0; HEADER_LEN];
        if !flash.read(self.offset::<F>(copy), &mut header) {
            return None;
        }
        let found = read_header(&header, copy).filter(|found| found.len <= self.capacity::<F>())?;
        let mut digest = Crc32::new();
        let mut bytes = [0; READ_LEN];
        let mut offset = 0;
        while offset < found.len {
            let piece = bytes.get_mut(..READ_LEN.min((found.len - offset) as usize))?;
            if !self.read(flash, &found, offset, piece) {
                return None;
            }
            digest.update(piece);
            offset += piece.len() as u32;
        }
        (digest.finish() == found.crc32).then_some(found)
    }
}

/// The words of a header.
pub(super) fn header(sequence: u32, len: u32, crc32_of_content: u32) -> [[u8; WORD_LEN]; HEADER_LEN / WORD_LEN] {
    let first = word(MAGIC, sequence);
    let second = word(len, crc32_of_content);
    let mut digest = Crc32::new();
    digest.update(&first).update(&second);
    [first, second, word(digest.finish(), u32::MAX)]
}

fn read_header(header: &[u8; HEADER_LEN], copy: u32) -> Option<Found> {
    let (words, []) = header.as_chunks::<4>() else { return None };
    let [magic, sequence, len, content, check, _] = *words else { return None };
    let (covered, _) = header.split_at(2 * WORD_LEN);
    let good = magic == MAGIC.to_le_bytes() && u32::from_le_bytes(check) == crc32(covered);
    good.then(|| Found {
        copy,
        sequence: u32::from_le_bytes(sequence),
        len: u32::from_le_bytes(len),
        crc32: u32::from_le_bytes(content),
    })
}

/// A word of two numbers, little-endian.
pub(super) fn word(low: u32, high: u32) -> [u8; WORD_LEN] {
    (u64::from(high) << 32 | u64::from(low)).to_le_bytes()
}
