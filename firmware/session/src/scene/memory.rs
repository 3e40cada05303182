//! Handles uploads, and allocates memory for them.

use frixel_control::{Board, Order};
use frixel_layers::{HEADER_LEN, LAW_POINTS_MAX, POINT_LEN, RECORD_LEN, SCENE_MAX_LEN, StoredBitmap as Bitmap};
use frixel_wire::message::{Accepted, Refusal};
use frixel_wire::scene::POINTS_MAX;

use super::upload::{ChunkReport, Destination, Upload};
use super::{Committed, Scenes};
use crate::states::Orders;

/// Whether the committed scene may be removed from the ticker.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Removal {
    /// Nothing plays.
    Allowed,
    /// The scene plays.
    Plays,
    /// Nothing should play, but the ticker may not have stopped yet.
    Unsettled,
}

impl<'a> Scenes<'a> {
    pub(crate) fn begin_scene(&mut self, len: u32, crc32: u32, board: &Board) -> Result<Accepted, Refusal> {
        let records = usize::from(board.limits.records_max);
        let max =
            (HEADER_LEN + records * RECORD_LEN + (POINTS_MAX + LAW_POINTS_MAX) * POINT_LEN).min(SCENE_MAX_LEN) as u32;
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
        board: &Board,
        removal: Removal,
        orders: &mut Orders<'a>,
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
        let pool_len = board.limits.bitmap_pool_bytes;
        let bitmap = match self.make_room(width, height, crc32, pool_len, removal, orders) {
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

    /// Allocates a bitmap: first without removing any, then after removing unused ones, and finally, if nothing plays,
    /// after removing the committed scene and compacting the others.
    fn make_room(
        &mut self,
        width: u16,
        height: u16,
        crc32: u32,
        pool_len: u32,
        removal: Removal,
        orders: &mut Orders<'a>,
    ) -> Result<Bitmap, Refusal> {
        if let Ok(bitmap) = self.directory.allocate(width, height, crc32, pool_len) {
            return Ok(bitmap);
        }
        let (committed, announced) = (&self.committed.bitmaps, &self.announced_bitmaps);
        self.directory.retain(|bitmap| committed.contains(&bitmap.crc32) || announced.contains(&bitmap.crc32));
        let refused = match self.directory.allocate(width, height, crc32, pool_len) {
            Ok(bitmap) => return Ok(bitmap),
            Err(free) => Refusal::BitmapPoolFull { len: u32::from(width) * u32::from(height), free },
        };
        match removal {
            Removal::Allowed => {}
            Removal::Plays => return Err(refused),
            // The ticker may still read the memory.
            Removal::Unsettled => return Err(Refusal::Busy),
        }
        if self.committed.crc32 != 0 {
            orders.send(Order::Unload)?;
            self.committed = Committed::default();
            let announced = &self.announced_bitmaps;
            self.directory.retain(|bitmap| announced.contains(&bitmap.crc32));
        }
        self.directory.compact(self.pool);
        self.directory.allocate(width, height, crc32, pool_len).map_err(|_| refused)
    }

    /// Takes a chunk of the current upload. Returns the next expected chunk if it is to be reported.
    pub(crate) fn take_chunk(&mut self, number: u16, bytes: &[u8]) -> Option<u16> {
        let upload = self.upload.as_mut()?;
        match upload.take(number, bytes, self.staging, self.pool) {
            ChunkReport::Progress { next_chunk } => Some(next_chunk),
            ChunkReport::Nothing => None,
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
    pub(super) fn drop_upload(&mut self) {
        if let Some(Upload { destination: Destination::Bitmap(unfinished), .. }) = self.upload.take()
            && cfg!(feature = "bitmap")
        {
            self.directory.retain(|bitmap| bitmap.crc32 != unfinished.crc32);
        }
    }
}
