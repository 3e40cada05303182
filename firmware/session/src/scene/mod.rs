//! The scenes: the uploaded one, the one prepared by a commit, and the ticker's.
//!
//! Takes the bytes of scenes, bitmaps and streams, and changes during a play; returns a scene's coefficients and its
//! changes as orders, through the [`Orders`](crate::states::Orders) passed to it. It is independent of lines, fingers
//! and states: whether the playing scene may be removed is passed to it.
//!
//! `upload` collects bytes, `memory` allocates for them and ends uploads, `commit` passes on a scene (`loading`
//! computes its coefficients in steps), `live` changes layers, and `stream` holds the samples of a stream.

mod bitmap_directory;
mod commit;
mod live;
mod loading;
mod memory;
#[cfg_attr(not(feature = "stream"), path = "no_stream.rs")]
mod stream;
mod upload;

use frixel_control::Active;
use frixel_layers::{BitmapPool, Header, Leader};
use frixel_wire::scene::RECORDS_MAX;
use heapless::Vec;

use bitmap_directory::Directory;
use commit::Commit;
pub use loading::{TableRows, active_bytes_filled, table_rows, voltage_max_v_rms};
pub(crate) use memory::Removal;
pub(crate) use stream::PROGRESS_PERIOD_S;
use stream::Stream;
use upload::{Staging, Upload};

/// CRC-32 names of bitmaps.
type BitmapNames = Vec<u32, RECORDS_MAX>;

/// Memory for the next scene: its bytes while they are uploaded, and its coefficients, which trade places with the
/// ticker's at each load. All bits are zero at first, so that a static of it takes no flash.
pub struct NextScene {
    staging: Staging,
    coefficients: Active,
}

impl NextScene {
    /// Memory without a scene.
    #[allow(clippy::new_without_default, reason = "it belongs in a static, not on the stack")]
    pub const fn new() -> Self {
        Self { staging: Staging::new(), coefficients: Active::new() }
    }
}

/// The uploaded, the next and the committed scene.
pub(crate) struct Scenes<'a> {
    pool: &'a BitmapPool,
    directory: Directory,
    upload: Option<Upload>,
    staging: &'a mut Staging,
    /// Bitmaps announced since the last commit: those of the next scene.
    announced_bitmaps: BitmapNames,
    /// Buffer for the coefficients of the next scene; `None` until the ticker has returned the previous scene's.
    spare: Option<&'a mut Active>,
    /// The commit under way.
    commit: Option<Commit>,
    committed: Committed,
    pub(crate) stream: Stream<'a>,
}

/// The ticker's scene: facts that are still needed after its bytes were overwritten.
#[derive(Default)]
struct Committed {
    /// CRC-32 of its bytes; zero without a scene.
    crc32: u32,
    bitmaps: BitmapNames,
    header: Option<Header>,
    layers: u8,
    has_stream: bool,
}

impl<'a> Scenes<'a> {
    pub(crate) fn new(pool: &'a BitmapPool, NextScene { staging, coefficients }: &'a mut NextScene) -> Self {
        // The session that had this memory before may have left a scene.
        staging.begin();
        Self {
            pool,
            directory: Directory::default(),
            upload: None,
            staging,
            announced_bitmaps: Vec::new(),
            spare: Some(coefficients),
            commit: None,
            committed: Committed::default(),
            stream: Stream::new(),
        }
    }

    /// Takes back coefficients that the ticker no longer uses.
    pub(crate) fn take_back(&mut self, spare: &'a mut Active) {
        self.spare = Some(spare);
    }

    /// CRC-32 of the committed scene; zero without a scene.
    pub(crate) fn crc32(&self) -> u32 {
        self.committed.crc32
    }

    /// Header of the committed scene.
    pub(crate) fn header(&self) -> Option<&Header> {
        self.committed.header.as_ref()
    }

    /// Whether the finger's place is predicted; `true` without a scene.
    pub(crate) fn predicts(&self) -> bool {
        self.header().is_none_or(|header| header.prediction)
    }

    /// The rule for selecting one of several fingers; without a scene, the first finger.
    pub(crate) fn leader(&self) -> Leader {
        self.header().map_or(Leader::First, |header| header.leader)
    }

    /// Drops unfinished work of the previous client: an upload, a commit and announced bitmaps. The committed scene
    /// stays.
    pub(crate) fn drop_unfinished(&mut self) {
        self.drop_upload();
        self.commit = None;
        self.announced_bitmaps.clear();
    }
}
