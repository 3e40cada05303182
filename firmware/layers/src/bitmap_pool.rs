//! Memory for the samples of bitmaps.

use core::sync::atomic::{AtomicU8, Ordering};

/// Bytes for bitmaps on the smallest board, including bitmaps being uploaded; 0 without the feature `bitmap`.
pub const BITMAP_POOL_LEN: usize = if cfg!(feature = "bitmap") { 64 * 1024 } else { 0 };

/// Samples of bitmaps, written by the session and read by the tick.
///
/// Every byte is an atomic, which costs nothing on a Cortex-M and needs no `unsafe`. The session writes only bytes that
/// no playing scene reads.
pub struct BitmapPool {
    bytes: [AtomicU8; BITMAP_POOL_LEN],
}

impl BitmapPool {
    /// An empty pool.
    #[allow(
        clippy::new_without_default,
        clippy::large_stack_arrays,
        reason = "64 KiB belong in a static or a box, not on the stack"
    )]
    pub const fn new() -> Self {
        Self { bytes: [const { AtomicU8::new(0) }; BITMAP_POOL_LEN] }
    }

    /// The sample at an offset. The offset wraps at the pool's length, a power of two, which replaces a bounds check;
    /// no bitmap extends beyond the end.
    #[inline]
    pub fn sample(&self, offset: usize) -> u8 {
        const { assert!(BITMAP_POOL_LEN == 0 || BITMAP_POOL_LEN.is_power_of_two()) };
        self.bytes.get(offset & BITMAP_POOL_LEN.wrapping_sub(1)).map_or(0, |byte| byte.load(Ordering::Relaxed))
    }

    /// Moves `len` samples from one offset to a lower one.
    pub fn move_down(&self, from: u32, to: u32, len: u32) {
        for index in 0..len as usize {
            if let Some(byte) = self.bytes.get(to as usize + index) {
                byte.store(self.sample(from as usize + index), Ordering::Relaxed);
            }
        }
    }

    /// Writes samples, beginning at an offset; samples beyond the end are ignored.
    pub fn write(&self, offset: usize, samples: &[u8]) {
        if let Some(bytes) = self.bytes.get(offset..) {
            for (byte, sample) in bytes.iter().zip(samples) {
                byte.store(*sample, Ordering::Relaxed);
            }
        }
    }
}

/// A bitmap's location in the pool.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StoredBitmap {
    /// CRC-32 of the samples: the bitmap's name.
    pub crc32: u32,
    /// Offset of the first sample in the pool.
    pub offset: u32,
    /// Samples in a row.
    pub width: u16,
    /// Rows.
    pub height: u16,
}

impl StoredBitmap {
    /// Bytes of the samples.
    #[allow(clippy::len_without_is_empty, reason = "a bitmap has samples")]
    pub fn len(&self) -> u32 {
        u32::from(self.width) * u32::from(self.height)
    }
}
