//! Commit: passes the uploaded scene to the ticker.
//!
//! A commit takes the time of hundreds of ticks. [`Scenes::step_commit`] advances it by a step of at most a millisecond
//! (on an RP2040, 8 ms), so that touches, signs of life and stops are served in between. Requests whose outcome depends
//! on the commit wait until it has ended. A hello drops it, since its client is gone.

use frixel_control::{Board, Order};
use frixel_layers::{ActiveLayers, Scene, disabled_record};
use frixel_wire::frame::crc32;
use frixel_wire::message::Refusal;
use frixel_wire::scene::{RECORDS_MAX, SceneError};

use super::loading::Loading;
use super::upload::Upload;
use super::{BitmapNames, Committed, Scenes};
use crate::states::Orders;

/// Records checked per step of a commit.
const RECORDS_PER_STEP: usize = 16;

/// A commit in progress.
pub(super) struct Commit {
    crc32: u32,
    step: Step,
}

/// The next step of a commit.
enum Step {
    /// Checks that a complete scene was uploaded, without its records.
    Check,
    /// Checks its records from this one on.
    CheckRecords(usize),
    /// Computes its coefficients.
    Load(Loading),
    /// Passes them to the ticker.
    HandOver,
}

impl<'a> Scenes<'a> {
    /// Begins a commit of the uploaded scene with this CRC-32.
    pub(crate) fn begin_commit(&mut self, crc32: u32) {
        self.commit = Some(Commit { crc32, step: Step::Check });
    }

    /// Whether a commit is in progress.
    pub(crate) fn is_committing(&self) -> bool {
        self.commit.is_some()
    }

    /// Commits one of the board's own scenes at once: without bitmaps, for bring-up or self-test.
    pub(crate) fn commit_own(&mut self, scene: &[u8], board: &Board, orders: &mut Orders<'a>) -> Result<(), Refusal> {
        self.drop_unfinished();
        let crc32 = crc32(scene);
        self.staging.begin();
        self.staging.write(0, scene);
        self.staging.finish(scene.len() as u32, crc32);
        self.begin_commit(crc32);
        loop {
            if let Some(outcome) = self.step_commit(board, orders) {
                return outcome;
            }
        }
    }

    /// Does the next step of the current commit. Returns its outcome after the last step.
    pub(crate) fn step_commit(&mut self, board: &Board, orders: &mut Orders<'a>) -> Option<Result<(), Refusal>> {
        let mut commit = self.commit.take()?;
        match self.step(&mut commit, board, orders) {
            Ok(false) => {
                self.commit = Some(commit);
                None
            }
            Ok(true) => Some(Ok(())),
            Err(refusal) => Some(Err(refusal)),
        }
    }

    /// Does one step. Returns whether it was the last.
    #[inline(never)]
    fn step(&mut self, commit: &mut Commit, board: &Board, orders: &mut Orders<'a>) -> Result<bool, Refusal> {
        let crc32 = commit.crc32;
        match &mut commit.step {
            Step::Check => {
                self.check_upload(crc32, board, orders)?;
                commit.step = Step::CheckRecords(0);
            }
            Step::CheckRecords(first) => {
                let scene = self.uploaded_scene()?;
                let end = *first + RECORDS_PER_STEP;
                scene.check_records(*first..end).map_err(not_a_scene)?;
                commit.step =
                    if end < scene.record_count() { Step::CheckRecords(end) } else { Step::Load(Loading::Drive) };
            }
            Step::Load(loading) => {
                if self.load_step(loading, board)? {
                    commit.step = Step::HandOver;
                }
            }
            Step::HandOver => return self.hand_over(crc32, orders).map(|()| true),
        }
        Ok(false)
    }

    fn check_upload(&self, crc32: u32, board: &Board, orders: &Orders) -> Result<(), Refusal> {
        if let Some(upload) = &self.upload {
            return Err(end_upload_first(upload));
        }
        let (_, found) = self.staging.scene().ok_or(Refusal::NoScene)?;
        if found != crc32 {
            return Err(Refusal::CrcMismatch { expected: crc32, found });
        }
        orders.check_room()?;
        let scene = self.uploaded_scene()?;
        if scene.record_count() > usize::from(board.limits.records_max) {
            // A scene has no more records than a byte counts.
            return Err(Refusal::Scene(SceneError::TooManyRecords { found: scene.record_count() as u8 }));
        }
        if self.spare.is_none() { Err(Refusal::Busy) } else { Ok(()) }
    }

    fn uploaded_scene(&self) -> Result<Scene<'_>, Refusal> {
        let (bytes, _) = self.staging.scene().ok_or(Refusal::NoScene)?;
        Scene::open(bytes).map_err(not_a_scene)
    }

    fn load_step(&mut self, loading: &mut Loading, board: &Board) -> Result<bool, Refusal> {
        let (bytes, _) = self.staging.scene().ok_or(Refusal::NoScene)?;
        let scene = Scene::open(bytes).map_err(not_a_scene)?;
        let spare = self.spare.as_mut().ok_or(Refusal::Busy)?;
        let stepped = loading.step(spare, &scene, board, &self.directory);
        if stepped.is_err() {
            self.announced_bitmaps.clear();
        }
        stepped
    }

    fn hand_over(&mut self, crc32: u32, orders: &mut Orders<'a>) -> Result<(), Refusal> {
        orders.check_room()?;
        let scene = self.uploaded_scene()?;
        let active = self.spare.as_deref().ok_or(Refusal::Busy)?;
        let committed = Committed::new(crc32, &scene, &active.layers);
        let spare = self.spare.take().ok_or(Refusal::Busy)?;
        self.committed = committed;
        if !self.committed.has_stream {
            // No order needed: the ticker ends the stream when it takes the scene.
            let _ = self.stream.end();
        }
        self.announced_bitmaps.clear();
        orders.send(Order::Load(spare))
    }
}

impl Committed {
    fn new(crc32: u32, scene: &Scene, active: &ActiveLayers) -> Self {
        Self {
            crc32,
            bitmaps: bitmaps_of(scene),
            header: Some(*scene.header()),
            // This fits: a scene has at most `RECORDS_MAX` records.
            layers: scene.record_count() as u8,
            has_stream: active.has_stream(),
        }
    }
}

/// The refusal of a commit during an upload; it contains the progress of the upload.
fn end_upload_first(upload: &Upload) -> Refusal {
    upload.check().err().unwrap_or(Refusal::UploadIncomplete { next_chunk: 0 })
}

fn bitmaps_of(scene: &Scene) -> BitmapNames {
    if !cfg!(feature = "bitmap") {
        return BitmapNames::new();
    }
    scene.records().filter_map(|record| record.layer.bitmap_crc32()).take(RECORDS_MAX).collect()
}

/// Distinguishes a record whose feature is disabled in this firmware from an invalid scene.
fn not_a_scene(error: SceneError) -> Refusal {
    disabled_record(&error).map_or(Refusal::Scene(error), |layer| Refusal::FeatureDisabled { layer })
}
