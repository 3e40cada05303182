//! The uploaded scene becomes the one that plays.

use frixel_layers::{Scene, disabled_record};
use frixel_wire::message::{Accepted, Refusal};
use frixel_wire::scene::{RECORDS_MAX, SceneError};
use heapless::Vec;

use super::dialogue::Dialogue;
use super::live::Playing;
use super::upload::Upload;
use crate::Order;

/// CRC-32 names of bitmaps.
pub(super) type BitmapNames = Vec<u32, RECORDS_MAX>;

impl Dialogue<'_> {
    /// Commits the uploaded scene, which takes the time of many ticks.
    #[inline]
    pub(super) fn commit(&mut self, crc32: u32) -> Result<Accepted, Refusal> {
        if self.upload.is_some() {
            return self.end_upload_first();
        }
        let (bytes, found) = self.staging.scene().ok_or(Refusal::NoScene)?;
        if found != crc32 {
            return Err(Refusal::CrcMismatch { expected: crc32, found });
        }
        self.room_for_order()?;
        let scene = Scene::parse(bytes).map_err(not_a_scene)?;
        if scene.record_count() > usize::from(self.board.limits.records_max) {
            // A scene has no more records than a byte counts.
            return Err(Refusal::Scene(SceneError::TooManyRecords { found: scene.record_count() as u8 }));
        }
        let spare = self.spare.take().ok_or(Refusal::Busy)?;
        if let Err(refusal) = spare.load(&scene, &self.board, &self.directory) {
            self.spare = Some(spare);
            self.announced_bitmaps.clear();
            return Err(refusal);
        }
        self.committed_bitmaps = bitmaps_of(&scene);
        self.playing = Playing::new(&scene);
        #[cfg(feature = "stream")]
        self.drop_stream_without_layer();
        self.committed_crc32 = crc32;
        self.announced_bitmaps.clear();
        self.send_order(Order::Load(spare))?;
        Ok(Accepted::Done)
    }

    /// A commit while an upload is under way says how far that has come.
    #[inline]
    fn end_upload_first(&self) -> Result<Accepted, Refusal> {
        let check = self.upload.as_ref().map_or(Ok(()), Upload::check);
        Err(check.err().unwrap_or(Refusal::UploadIncomplete { next_chunk: 0 }))
    }
}

#[inline]
fn bitmaps_of(scene: &Scene) -> BitmapNames {
    if !cfg!(feature = "bitmap") {
        return BitmapNames::new();
    }
    scene.records().filter_map(|record| record.layer.bitmap_crc32()).take(RECORDS_MAX).collect()
}

/// Tells what this firmware was built without from what nobody knows.
#[inline]
fn not_a_scene(error: SceneError) -> Refusal {
    disabled_record(&error).map_or(Refusal::Scene(error), |layer| Refusal::LeftOut { layer })
}
