//! Converts the committed scene to bytes that are stored over power-off, and back.
//!
//! In words of 8 bytes, little-endian: length of the scene (4 bytes) and number of bitmaps (4); for each bitmap its
//! CRC-32 (4), width (2) and height (2); the scene; the samples of each bitmap, filled up to whole words with zeros.

use frixel_control::Board;
use frixel_layers::{BitmapPool, SCENE_MAX_LEN, StoredBitmap as Bitmap};
use frixel_wire::frame::crc32;
use frixel_wire::message::Refusal;
use frixel_wire::scene::{RECORDS_MAX, bitmap_digest};
use heapless::Vec;

use super::{BitmapNames, Scenes};
use crate::states::Orders;
use crate::store::WORD_LEN;

/// After this many starts in a row that ended in a fault, the stored scene is not loaded: it may be what makes every
/// start fail, and a board that restarts for ever takes no other scene. Two faults may be a disturbance.
const FAULT_STARTS_MAX: u8 = 3;

/// The committed scene with its bitmaps.
pub struct StoredScene<'s> {
    scene: &'s [u8],
    crc32: u32,
    bitmaps: Vec<Bitmap, RECORDS_MAX>,
    pool: &'s BitmapPool,
}

impl StoredScene<'_> {
    /// CRC-32 of the scene: its name.
    pub fn crc32(&self) -> u32 {
        self.crc32
    }

    /// Number of bytes to store.
    pub fn len_to_keep(&self) -> u32 {
        let samples: u32 = self.bitmaps.iter().map(|bitmap| whole_words(bitmap.len())).sum();
        samples_offset(self.bitmaps.len() as u32, self.scene.len() as u32) + samples
    }

    /// The word at an offset, which must be a multiple of [`WORD_LEN`]; zeros beyond the end.
    pub fn word(&self, offset: u32) -> [u8; WORD_LEN] {
        let (count, scene_len) = (self.bitmaps.len() as u32, self.scene.len() as u32);
        let mut word = [0; WORD_LEN];
        if offset == 0 {
            return pair(scene_len, count);
        }
        if !offset.is_multiple_of(WORD_LEN as u32) {
            return word;
        }
        if let Some(bitmap) = self.bitmaps.get((offset as usize / WORD_LEN).wrapping_sub(1)) {
            return pair(bitmap.crc32, u32::from(bitmap.height) << 16 | u32::from(bitmap.width));
        }
        if let Some(offset) = offset.checked_sub(samples_offset(count, scene_len)) {
            self.read_samples(offset, &mut word);
        } else {
            let rest = self.scene.get((offset - scene_offset(count)) as usize..).unwrap_or_default();
            for (to, from) in word.iter_mut().zip(rest) {
                *to = *from;
            }
        }
        word
    }

    /// Samples of all bitmaps, one after the other.
    fn read_samples(&self, mut offset: u32, word: &mut [u8; WORD_LEN]) {
        for bitmap in &self.bitmaps {
            if offset < whole_words(bitmap.len()) {
                for (to, at) in word.iter_mut().zip(offset..bitmap.len()) {
                    *to = self.pool.sample((bitmap.offset + at) as usize);
                }
                return;
            }
            offset -= whole_words(bitmap.len());
        }
    }
}

impl<'a> Scenes<'a> {
    /// The committed scene; `None` without one, or once the upload of another has begun.
    pub(crate) fn to_store(&self) -> Option<StoredScene<'_>> {
        let mut bitmaps = Vec::new();
        for (index, crc32) in self.committed.bitmaps.iter().enumerate() {
            if !self.committed.bitmaps.iter().take(index).any(|before| before == crc32) {
                bitmaps.push(self.directory.find(*crc32)?).ok()?;
            }
        }
        Some(StoredScene { scene: self.bytes()?, crc32: self.committed.crc32, bitmaps, pool: self.pool })
    }

    /// Whether this start must leave the stored scene alone, because the last starts ended in faults. If so, the hello
    /// says it until a scene is committed.
    pub(crate) fn skips_stored_scene(&mut self, board: &Board) -> bool {
        self.stored_scene_skipped = board.reset_fault_starts >= FAULT_STARTS_MAX;
        self.stored_scene_skipped
    }

    /// The board could not store the scene of this CRC-32; the hello says it until another scene is committed.
    pub(crate) fn could_not_store(&mut self, crc32: u32) {
        self.not_stored_crc32 = crc32;
    }

    /// Commits a scene from the bytes of a [`StoredScene`]. If this fails, its bytes and bitmaps are dropped.
    pub(crate) fn restore(
        &mut self,
        read: impl Fn(u32, &mut [u8]) -> bool,
        board: &Board,
        may_play_alone: bool,
        orders: &mut Orders<'a>,
    ) -> Option<()> {
        let mut names = BitmapNames::new();
        let restored = self
            .restore_parts(&read, &mut names, board.limits.bitmap_pool_bytes)
            .and_then(|crc32| self.commit_at_once(crc32, board, may_play_alone, orders).ok());
        if restored.is_none() {
            self.staging.begin();
            self.directory.retain(|bitmap| !names.contains(&bitmap.crc32));
        }
        restored
    }

    /// Puts scene and bitmaps where uploads would put them, and returns the CRC-32 of the scene.
    fn restore_parts(
        &mut self,
        read: &impl Fn(u32, &mut [u8]) -> bool,
        names: &mut BitmapNames,
        pool_len: u32,
    ) -> Option<u32> {
        let (scene_len, count) = read_pair(read, 0)?;
        if scene_len as usize > SCENE_MAX_LEN || count as usize > RECORDS_MAX {
            return None;
        }
        let mut offset = samples_offset(count, scene_len);
        for index in 0..count {
            let (name, size) = read_pair(read, (index + 1) * WORD_LEN as u32)?;
            let (width, height) = (size as u16, (size >> 16) as u16);
            let bitmap = self.directory.allocate(width, height, name, pool_len).ok()?;
            names.push(name).ok()?;
            self.restore_samples(read, offset, &bitmap)?;
            offset = offset.checked_add(whole_words(bitmap.len()))?;
        }
        self.restore_scene(read, scene_offset(count), scene_len)
    }

    /// Commits the uploaded scene at once.
    fn commit_at_once(
        &mut self,
        crc32: u32,
        board: &Board,
        may_play_alone: bool,
        orders: &mut Orders<'a>,
    ) -> Result<(), Refusal> {
        self.begin_commit(crc32);
        loop {
            if let Some(outcome) = self.step_commit(board, may_play_alone, orders) {
                return outcome;
            }
        }
    }

    fn restore_samples(&mut self, read: &impl Fn(u32, &mut [u8]) -> bool, from: u32, bitmap: &Bitmap) -> Option<()> {
        let mut digest = bitmap_digest(bitmap.width, bitmap.height);
        for at in (0..bitmap.len()).step_by(WORD_LEN) {
            let mut word = [0; WORD_LEN];
            read(from.checked_add(at)?, &mut word).then_some(())?;
            let used = word.get(..WORD_LEN.min((bitmap.len() - at) as usize))?;
            self.pool.write((bitmap.offset + at) as usize, used);
            digest.update(used);
        }
        (digest.finish() == bitmap.crc32).then_some(())
    }

    /// Puts the scene where an upload would put it, and returns its CRC-32.
    fn restore_scene(&mut self, read: &impl Fn(u32, &mut [u8]) -> bool, from: u32, len: u32) -> Option<u32> {
        self.staging.begin();
        for at in (0..len).step_by(WORD_LEN) {
            let mut word = [0; WORD_LEN];
            read(from.checked_add(at)?, &mut word).then_some(())?;
            self.staging.write(at as usize, word.get(..WORD_LEN.min((len - at) as usize))?);
        }
        self.staging.finish(len, 0);
        let crc32 = crc32(self.staging.scene()?.0);
        self.staging.finish(len, crc32);
        Some(crc32)
    }
}

/// Offset of the scene, after the lengths and the list of bitmaps.
fn scene_offset(bitmaps: u32) -> u32 {
    (1 + bitmaps) * WORD_LEN as u32
}

/// Offset of the samples, after the scene.
fn samples_offset(bitmaps: u32, scene_len: u32) -> u32 {
    scene_offset(bitmaps) + whole_words(scene_len)
}

fn whole_words(len: u32) -> u32 {
    len.next_multiple_of(WORD_LEN as u32)
}

/// A word of two numbers, little-endian.
fn pair(low: u32, high: u32) -> [u8; WORD_LEN] {
    (u64::from(high) << 32 | u64::from(low)).to_le_bytes()
}

fn read_pair(read: &impl Fn(u32, &mut [u8]) -> bool, offset: u32) -> Option<(u32, u32)> {
    let mut word = [0; WORD_LEN];
    read(offset, &mut word).then(|| {
        let word = u64::from_le_bytes(word);
        (word as u32, (word >> 32) as u32)
    })
}
