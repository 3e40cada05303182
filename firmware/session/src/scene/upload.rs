//! Uploads: chunks are collected, and used only after the whole upload was checked.

use frixel_wire::frame::Crc32;
use frixel_wire::message::Refusal;
use frixel_wire::payload::CHUNK_LEN;
use frixel_wire::scene::bitmap_digest;

use frixel_layers::{BitmapPool, SCENE_MAX_LEN, StoredBitmap};

/// Chunks per progress report of an upload: less than 1 KiB, a quarter of the smallest window.
const PROGRESS_CHUNKS: u16 = 5;

/// Destination of an upload's bytes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Destination {
    Scene,
    Bitmap(StoredBitmap),
}

/// An upload in progress.
pub(crate) struct Upload {
    pub(crate) destination: Destination,
    len: u32,
    crc32: u32,
    received: u32,
    digest: Crc32,
    next_chunk: u16,
    gap_reported: bool,
}

/// The report to the host after a chunk.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ChunkReport {
    Nothing,
    Progress { next_chunk: u16 },
}

impl Upload {
    pub(crate) fn of_scene(len: u32, crc32: u32) -> Self {
        Self::new(Destination::Scene, len, crc32, Crc32::new())
    }

    /// An upload of a bitmap. Its CRC-32 also covers the bitmap's width and height.
    pub(crate) fn of_bitmap(bitmap: StoredBitmap) -> Self {
        let digest = bitmap_digest(bitmap.width, bitmap.height);
        Self::new(Destination::Bitmap(bitmap), bitmap.len(), bitmap.crc32, digest)
    }

    fn new(destination: Destination, len: u32, crc32: u32, digest: Crc32) -> Self {
        Self { destination, len, crc32, received: 0, digest, next_chunk: 0, gap_reported: false }
    }

    /// Takes a chunk. A chunk received before is ignored. A chunk ahead of the expected one is dropped, and the
    /// expected chunk is reported once.
    pub(crate) fn take(&mut self, number: u16, bytes: &[u8], staging: &mut Staging, pool: &BitmapPool) -> ChunkReport {
        let expected_len = (self.len - self.received).min(CHUNK_LEN as u32);
        if number != self.next_chunk || bytes.len() as u32 != expected_len || expected_len == 0 {
            let early = number > self.next_chunk && !self.gap_reported;
            self.gap_reported |= early;
            return if early { ChunkReport::Progress { next_chunk: self.next_chunk } } else { ChunkReport::Nothing };
        }
        match self.destination {
            Destination::Scene => staging.write(self.received as usize, bytes),
            Destination::Bitmap(bitmap) => pool.write((bitmap.offset + self.received) as usize, bytes),
        }
        self.digest.update(bytes);
        self.received += expected_len;
        self.next_chunk += 1;
        self.gap_reported = false;
        if self.received == self.len || self.next_chunk.is_multiple_of(PROGRESS_CHUNKS) {
            ChunkReport::Progress { next_chunk: self.next_chunk }
        } else {
            ChunkReport::Nothing
        }
    }

    /// Checks that all bytes have arrived, and that their CRC-32 is the announced one.
    pub(crate) fn check(&self) -> Result<(), Refusal> {
        if self.received < self.len {
            return Err(Refusal::UploadIncomplete { next_chunk: self.next_chunk });
        }
        let found = self.digest.finish();
        if found == self.crc32 { Ok(()) } else { Err(Refusal::CrcMismatch { expected: self.crc32, found }) }
    }

    pub(crate) fn len_and_crc32(&self) -> (u32, u32) {
        (self.len, self.crc32)
    }
}

/// The bytes of a scene that has been or is being uploaded.
pub(crate) struct Staging {
    bytes: [u8; SCENE_MAX_LEN],
    /// Length and CRC-32 of a complete scene.
    whole: Option<(u32, u32)>,
}

impl Staging {
    pub(crate) const fn new() -> Self {
        Self { bytes: [0; SCENE_MAX_LEN], whole: None }
    }

    /// Discards the scene, because the upload of another begins.
    pub(crate) fn begin(&mut self) {
        self.whole = None;
    }

    /// Records that the scene is complete.
    pub(crate) fn finish(&mut self, len: u32, crc32: u32) {
        self.whole = Some((len, crc32));
    }

    pub(crate) fn write(&mut self, offset: usize, bytes: &[u8]) {
        if let Some(target) = self.bytes.get_mut(offset..offset + bytes.len()) {
            target.copy_from_slice(bytes);
        }
    }

    /// The complete scene with its CRC-32.
    pub(crate) fn scene(&self) -> Option<(&[u8], u32)> {
        let (len, crc32) = self.whole?;
        Some((self.bytes.get(..len as usize)?, crc32))
    }
}
