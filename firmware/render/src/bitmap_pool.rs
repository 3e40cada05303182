//! Memory for bitmaps, and the list of what is where in it.

use core::sync::atomic::{AtomicU8, Ordering};

use frixel_wire::scene::RECORDS_MAX;
use heapless::Vec;

/// Bytes for bitmaps on the smallest board, those being uploaded included; none without the feature `bitmap`.
pub const BITMAP_POOL_LEN: usize = if cfg!(feature = "bitmap") { 64 * 1024 } else { 0 };

/// Most bitmaps that the pool holds at a time: those of a scene that plays, and those of the next.
const ENTRIES_MAX: usize = if cfg!(feature = "bitmap") { 2 * RECORDS_MAX } else { 0 };

/// Samples of bitmaps, shared between the session, which writes, and the tick, which reads.
///
/// Every byte is an atomic of its own, which costs nothing on a Cortex-M and keeps the sharing free of `unsafe`.
/// The session writes only to bytes that no playing scene reads.
pub struct BitmapPool {
    bytes: [AtomicU8; BITMAP_POOL_LEN],
}

impl BitmapPool {
    /// An empty pool.
    #[allow(
        clippy::new_without_default,
        clippy::large_stack_arrays,
        reason = "64 KiB belong in a static or a box, not into a value made in passing"
    )]
    pub const fn new() -> Self {
        Self { bytes: [const { AtomicU8::new(0) }; BITMAP_POOL_LEN] }
    }

    /// The sample at an offset. No bitmap reaches beyond the end, where the pool begins again: a power of two needs no
    /// other bound.
    #[inline]
    pub(crate) fn sample(&self, offset: usize) -> u8 {
        const { assert!(BITMAP_POOL_LEN == 0 || BITMAP_POOL_LEN.is_power_of_two()) };
        self.bytes.get(offset & BITMAP_POOL_LEN.wrapping_sub(1)).map_or(0, |byte| byte.load(Ordering::Relaxed))
    }

    /// Moves samples to a lower offset.
    fn move_down(&self, from: u32, to: u32, len: u32) {
        for index in 0..len as usize {
            if let Some(byte) = self.bytes.get(to as usize + index) {
                byte.store(self.sample(from as usize + index), Ordering::Relaxed);
            }
        }
    }

    /// Writes samples from an offset on; what goes beyond the end is left out.
    pub(crate) fn write(&self, offset: usize, samples: &[u8]) {
        if let Some(bytes) = self.bytes.get(offset..) {
            for (byte, sample) in bytes.iter().zip(samples) {
                byte.store(*sample, Ordering::Relaxed);
            }
        }
    }
}

/// Where a bitmap lies in the pool.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Bitmap {
    pub(crate) crc32: u32,
    pub(crate) offset: u32,
    pub(crate) width: u16,
    pub(crate) height: u16,
}

impl Bitmap {
    pub(crate) fn len(&self) -> u32 {
        u32::from(self.width) * u32::from(self.height)
    }
}

/// What lies where in the pool, in order of offset.
#[derive(Debug, Default)]
pub(crate) struct Directory {
    entries: Vec<Bitmap, ENTRIES_MAX>,
}

impl Directory {
    pub(crate) fn find(&self, crc32: u32) -> Option<Bitmap> {
        self.entries.iter().find(|bitmap| bitmap.crc32 == crc32).copied()
    }

    /// Lets go of every bitmap that `keep` does not want.
    pub(crate) fn retain(&mut self, keep: impl Fn(&Bitmap) -> bool) {
        self.entries.retain(keep);
    }

    /// Moves all bitmaps together, so that what is free is one gap. Nobody may be reading them.
    pub(crate) fn compact(&mut self, pool: &BitmapPool) {
        let mut next = 0;
        for bitmap in &mut self.entries {
            pool.move_down(bitmap.offset, next, bitmap.len());
            bitmap.offset = next;
            next += bitmap.len();
        }
    }

    /// Finds room for a bitmap in the first gap that takes it. Without one, returns the largest gap in bytes.
    pub(crate) fn allocate(&mut self, width: u16, height: u16, crc32: u32, pool_len: u32) -> Result<Bitmap, u32> {
        let len = u32::from(width) * u32::from(height);
        let mut gap_start = 0;
        let mut largest = 0;
        for index in 0..=self.entries.len() {
            let next = self.entries.get(index);
            let gap = next.map_or(pool_len, |bitmap| bitmap.offset).saturating_sub(gap_start);
            largest = largest.max(gap);
            if gap >= len {
                let bitmap = Bitmap { crc32, offset: gap_start, width, height };
                return self.entries.insert(index, bitmap).map(|()| bitmap).map_err(|_| 0);
            }
            gap_start = next.map_or(pool_len, |bitmap| bitmap.offset + bitmap.len());
        }
        Err(largest)
    }
}

#[cfg(all(test, feature = "bitmap"))]
mod tests {
    use super::*;

    #[test]
    fn gaps_are_filled_and_nothing_overlaps() {
        let mut directory = Directory::default();
        let first = directory.allocate(10, 10, 1, 300).unwrap();
        let second = directory.allocate(10, 10, 2, 300).unwrap();
        let third = directory.allocate(10, 10, 3, 300).unwrap();
        assert_eq!((first.offset, second.offset, third.offset), (0, 100, 200));
        assert_eq!(directory.allocate(1, 1, 4, 300), Err(0));
        directory.retain(|bitmap| bitmap.crc32 != 2);
        assert_eq!(directory.allocate(101, 1, 5, 300), Err(100));
        assert_eq!(directory.allocate(10, 9, 6, 300).unwrap().offset, 100);
        assert_eq!(directory.allocate(10, 1, 7, 300).unwrap().offset, 190);
        assert_eq!(directory.find(6).map(|bitmap| bitmap.len()), Some(90));
    }
}
