//! Handles uploads, and allocates memory for them.

use frixel_layers::{HEADER_LEN, POINT_LEN, RECORD_LEN, SCENE_MAX_LEN, StoredBitmap as Bitmap};
use frixel_wire::fault::State;
use frixel_wire::message::{Accepted, FromBoard, Refusal};
use frixel_wire::scene::POINTS_MAX;

use crate::commands::Commands;
use crate::link::transmit_queue::TransmitQueue;
use crate::scene::live::Playing;
use crate::scene::upload::{ChunkReport, Destination, Upload};
use frixel_control::Order;

impl Commands<'_> {
    pub(crate) fn begin_scene(&mut self, len: u32, crc32: u32) -> Result<Accepted, Refusal> {
        let records = usize::from(self.board.limits.records_max);
        let max = (HEADER_LEN + records * RECORD_LEN + POINTS_MAX * POINT_LEN).min(SCENE_MAX_LEN) as u32;
        if len > max {
            return Err(Refusal::SceneTooLarge { len, max });
        }
        self.drop_upload();
        self.staging.begin();
        self.upload = Some(Upload::of_scene(len, crc32));
        Ok(Accepted::Done)
    }

    pub(crate) fn begin_bitmap(
        &mut self,
        width: u16,
        height: u16,
        crc32: u32,
        settled: bool,
    ) -> Result<Accepted, Refusal> {
        self.drop_upload();
        if self.spare.is_none() {
            // The ticker may still read the bitmaps of the previous scene.
            return Err(Refusal::Busy);
        }
        if !self.announced_bitmaps.contains(&crc32) {
            let full = Refusal::BitmapPoolFull { len: u32::from(width) * u32::from(height), free: 0 };
            self.announced_bitmaps.push(crc32).map_err(|_| full)?;
        }
        if self.directory.find(crc32).is_some() {
            return Ok(Accepted::AlreadyHeld);
        }
        let bitmap = match self.make_room(width, height, crc32, settled) {
            // The bitmaps of this scene do not fit: drop them, so that another scene can be uploaded.
            Err(full @ Refusal::BitmapPoolFull { .. }) => {
                self.announced_bitmaps.clear();
                return Err(full);
            }
            found => found?,
        };
        self.upload = Some(Upload::of_bitmap(bitmap));
        Ok(Accepted::Done)
    }

    /// Allocates a bitmap: first without removing any, then after removing those that no scene uses, and then, if
    /// nothing plays, after removing the committed scene and compacting the others.
    fn make_room(&mut self, width: u16, height: u16, crc32: u32, settled: bool) -> Result<Bitmap, Refusal> {
        let pool_len = self.board.limits.bitmap_pool_bytes;
        if let Ok(bitmap) = self.directory.allocate(width, height, crc32, pool_len) {
            return Ok(bitmap);
        }
        let (committed, announced) = (&self.committed_bitmaps, &self.announced_bitmaps);
        self.directory.retain(|bitmap| committed.contains(&bitmap.crc32) || announced.contains(&bitmap.crc32));
        let refused = match self.directory.allocate(width, height, crc32, pool_len) {
            Ok(bitmap) => return Ok(bitmap),
            Err(free) => Refusal::BitmapPoolFull { len: u32::from(width) * u32::from(height), free },
        };
        if self.state == State::Active {
            return Err(refused);
        }
        if !settled {
            // The ticker may not have stopped yet, and may still read what would be overwritten.
            return Err(Refusal::Busy);
        }
        if self.committed_crc32 != 0 {
            self.send_order(Order::Unload)?;
            self.committed_crc32 = 0;
            self.playing = Playing::default();
            self.committed_bitmaps.clear();
            let announced = &self.announced_bitmaps;
            self.directory.retain(|bitmap| announced.contains(&bitmap.crc32));
        }
        self.directory.compact(self.pool);
        self.directory.allocate(width, height, crc32, pool_len).map_err(|_| refused)
    }

    pub(crate) fn take_chunk(&mut self, number: u16, bytes: &[u8], queue: &mut TransmitQueue) {
        if let Some(upload) = &mut self.upload
            && let ChunkReport::Progress { next_chunk } = upload.take(number, bytes, &mut self.staging, self.pool)
        {
            self.report(&FromBoard::Progress { next_chunk, received_bytes: self.credit.received() }, queue);
        }
    }

    pub(crate) fn end_upload(&mut self) -> Result<Accepted, Refusal> {
        let Some(upload) = &self.upload else {
            return Err(Refusal::UploadIncomplete { next_chunk: 0 });
        };
        match upload.check() {
            Ok(()) => {
                if upload.destination == Destination::Scene {
                    let (len, crc32) = upload.len_and_crc32();
                    self.staging.finish(len, crc32);
                }
                self.upload = None;
                Ok(Accepted::Done)
            }
            Err(refusal @ Refusal::UploadIncomplete { .. }) => Err(refusal),
            Err(refusal) => {
                self.drop_upload();
                Err(refusal)
            }
        }
    }

    /// Drops an upload under way.
    pub(crate) fn drop_upload(&mut self) {
        if let Some(Upload { destination: Destination::Bitmap(unfinished), .. }) = self.upload.take()
            && cfg!(feature = "bitmap")
        {
            self.directory.retain(|bitmap| bitmap.crc32 != unfinished.crc32);
        }
    }
}
