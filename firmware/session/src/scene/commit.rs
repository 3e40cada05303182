//! Commit: passes the uploaded scene to the ticker.
//!
//! A commit takes the time of hundreds of ticks. [`Commands::step_commit`] advances it by one step of at most a
//! millisecond, so that touches, signs of life and stops are served in between. Requests whose outcome depends on the
//! commit wait until it has ended. A hello drops both: the client that would have been answered is gone.

use frixel_layers::{Scene, disabled_record};
use frixel_wire::fault::State;
use frixel_wire::message::{Accepted, Refusal};
use frixel_wire::scene::{RECORDS_MAX, SceneError};
use heapless::Vec;

use crate::commands::Commands;
use crate::link::transmit_queue::TransmitQueue;
use crate::scene::live::Playing;
use crate::scene::loading::Loading;
use crate::scene::upload::Upload;
use frixel_control::{Order, Status};

/// Records that a step of a commit checks.
const RECORDS_PER_STEP: usize = 16;

/// CRC-32 names of bitmaps.
pub(crate) type BitmapNames = Vec<u32, RECORDS_MAX>;

/// A commit under way.
pub(crate) struct Commit {
    /// Sequence number of the request.
    sequence: u16,
    crc32: u32,
    step: Step,
}

/// The next step of a commit.
enum Step {
    /// Checks that a complete scene was uploaded, except its records.
    Check,
    /// Checks its records from this one on.
    CheckRecords(usize),
    /// Computes its coefficients.
    Load(Loading),
    /// Hands them to the ticker.
    HandOver,
}

impl Commit {
    /// A commit that was requested.
    pub(crate) fn new(sequence: u16, crc32: u32) -> Self {
        Self { sequence, crc32, step: Step::Check }
    }
}

impl Commands<'_> {
    /// Does the next step of the commit and answers after the last; without a commit, carries out the first of the
    /// requests that waited for it.
    pub(crate) fn step_commit(&mut self, status: &Status, queue: &mut TransmitQueue) {
        let Some(mut commit) = self.commit.take() else {
            if let Some(request) = self.waiting.pop_front() {
                self.carry_out(request, status, queue);
            }
            return;
        };
        match self.step(&mut commit) {
            Ok(false) => self.commit = Some(commit),
            Ok(true) => self.answer(commit.sequence, Ok(Accepted::Done), queue),
            Err(refusal) => self.answer(commit.sequence, Err(refusal), queue),
        }
    }

    /// Drops the commit under way and the requests that wait for it, unanswered. The committed scene stays.
    pub(crate) fn drop_commit(&mut self) {
        self.commit = None;
        self.waiting.clear();
    }

    /// Commits the uploaded scene at once.
    #[cfg(feature = "store")]
    pub(crate) fn commit_at_once(&mut self, crc32: u32) -> Result<(), Refusal> {
        let mut commit = Commit::new(0, crc32);
        while !self.step(&mut commit)? {}
        Ok(())
    }

    /// Does one step. Returns whether it was the last.
    #[inline(never)]
    fn step(&mut self, commit: &mut Commit) -> Result<bool, Refusal> {
        let crc32 = commit.crc32;
        match &mut commit.step {
            Step::Check => {
                self.check_upload(crc32)?;
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
                if self.load_step(loading)? {
                    commit.step = Step::HandOver;
                }
            }
            Step::HandOver => return self.hand_scene_over(crc32).map(|()| true),
        }
        Ok(false)
    }

    fn check_upload(&self, crc32: u32) -> Result<(), Refusal> {
        if let Some(upload) = &self.upload {
            return Err(end_upload_first(upload));
        }
        let (_, found) = self.staging.scene().ok_or(Refusal::NoScene)?;
        if found != crc32 {
            return Err(Refusal::CrcMismatch { expected: crc32, found });
        }
        self.room_for_order()?;
        let scene = self.uploaded_scene()?;
        if scene.record_count() > usize::from(self.board.limits.records_max) {
            // A scene has no more records than a byte counts.
            return Err(Refusal::Scene(SceneError::TooManyRecords { found: scene.record_count() as u8 }));
        }
        if self.spare.is_none() { Err(Refusal::Busy) } else { Ok(()) }
    }

    fn uploaded_scene(&self) -> Result<Scene<'_>, Refusal> {
        let (bytes, _) = self.staging.scene().ok_or(Refusal::NoScene)?;
        Scene::open(bytes).map_err(not_a_scene)
    }

    fn load_step(&mut self, loading: &mut Loading) -> Result<bool, Refusal> {
        let (bytes, _) = self.staging.scene().ok_or(Refusal::NoScene)?;
        let scene = Scene::open(bytes).map_err(not_a_scene)?;
        let spare = self.spare.as_mut().ok_or(Refusal::Busy)?;
        let stepped = loading.step(spare, &scene, &self.board, &self.directory);
        if stepped.is_err() {
            self.announced_bitmaps.clear();
        }
        stepped
    }

    fn hand_scene_over(&mut self, crc32: u32) -> Result<(), Refusal> {
        self.room_for_order()?;
        let scene = self.uploaded_scene()?;
        if scene.header().autonomous {
            self.check_autonomous(self.state == State::Active)?;
        }
        let active = self.spare.as_deref().ok_or(Refusal::Busy)?;
        let (bitmaps, playing) = (bitmaps_of(&scene), Playing::new(&scene, &active.layers));
        let spare = self.spare.take().ok_or(Refusal::Busy)?;
        self.committed_bitmaps = bitmaps;
        self.playing = playing;
        #[cfg(feature = "stream")]
        self.drop_stream_without_layer();
        self.committed_crc32 = crc32;
        self.announced_bitmaps.clear();
        self.send_order(Order::Load(spare))
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
