//! The directory of the bitmap pool.

use frixel_layers::{BitmapPool, StoredBitmap};
use frixel_wire::scene::RECORDS_MAX;
use heapless::Vec;

/// Largest number of bitmaps in the pool: those of the playing scene, and those of the next.
const ENTRIES_MAX: usize = if cfg!(feature = "bitmap") { 2 * RECORDS_MAX } else { 0 };

/// The bitmaps in the pool, in order of their offsets.
#[derive(Debug, Default)]
pub(crate) struct Directory {
    entries: Vec<StoredBitmap, ENTRIES_MAX>,
}

impl Directory {
    pub(crate) fn find(&self, crc32: u32) -> Option<StoredBitmap> {
        self.entries.iter().find(|bitmap| bitmap.crc32 == crc32).copied()
    }

    /// Removes every bitmap for which `keep` returns `false`.
    pub(crate) fn retain(&mut self, keep: impl Fn(&StoredBitmap) -> bool) {
        self.entries.retain(keep);
    }

    /// Compacts all bitmaps, so that the free memory is one gap. The ticker must not be reading any of them.
    pub(crate) fn compact(&mut self, pool: &BitmapPool) {
        let mut next = 0;
        for bitmap in &mut self.entries {
            pool.move_down(bitmap.offset, next, bitmap.len());
            bitmap.offset = next;
            next += bitmap.len();
        }
    }

    /// Allocates a bitmap in the first gap that is large enough, or returns the size of the largest gap in bytes.
    pub(crate) fn allocate(&mut self, width: u16, height: u16, crc32: u32, pool_len: u32) -> Result<StoredBitmap, u32> {
        let len = u32::from(width) * u32::from(height);
        let mut gap_start = 0;
        let mut largest = 0;
        for index in 0..=self.entries.len() {
            let next = self.entries.get(index);
            let gap = next.map_or(pool_len, |bitmap| bitmap.offset).saturating_sub(gap_start);
            largest = largest.max(gap);
            if gap >= len {
                let bitmap = StoredBitmap { crc32, offset: gap_start, width, height };
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
