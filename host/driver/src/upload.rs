//! Uploads: chunks sent within the credit, and resent from the first lost one.

use std::ops::ControlFlow;
use std::time::Duration;

use frixel_wire::frame::{FRAME_MAX_LEN, crc32};
use frixel_wire::message::{Accepted, Command, Refusal};
use frixel_wire::payload::{CHUNK_LEN, chunk_frame};

use super::command::name_of;
use super::error::DeviceError;
use super::exchange::{Exchange, Waiting};
use super::link::Link;

/// Time without progress after which the end of the upload is requested, to learn the board's next chunk.
const STALL_AFTER: Duration = Duration::from_millis(150);
/// Timeout of an acknowledgement.
const ACKNOWLEDGE_TIMEOUT: Duration = Duration::from_secs(10);
/// Largest number of consecutive restarts of an upload from the same chunk.
const TRIES: u32 = 3;
/// Largest number of starts of an upload with an unknown outcome.
const STARTS: u32 = 3;

/// A compiled scene and its bitmaps.
#[derive(Clone, Debug)]
pub struct Upload<'a> {
    /// The scene's bytes, in the layout of `frixel-layers`.
    pub scene: &'a [u8],
    /// The bitmaps. Those that the board already holds are not sent.
    pub bitmaps: Vec<Bitmap<'a>>,
}

impl Upload<'_> {
    /// CRC-32 of the scene, by which [`super::Device::commit`] identifies it.
    pub fn scene_crc32(&self) -> u32 {
        crc32(self.scene)
    }

    /// Bytes of scene and bitmaps together.
    pub fn total_bytes(&self) -> usize {
        self.scene.len() + self.bitmaps.iter().map(|bitmap| bitmap.samples.len()).sum::<usize>()
    }

    /// Refuses bitmaps that do not have width times height samples.
    pub(super) fn check(&self) -> Result<(), DeviceError> {
        self.bitmaps.iter().try_for_each(Bitmap::check)
    }
}

/// A bitmap of a scene.
#[derive(Clone, Copy, Debug)]
pub struct Bitmap<'a> {
    /// CRC-32 of the samples, by which the scene refers to the bitmap.
    pub crc32: u32,
    /// Samples in a row.
    pub width: u16,
    /// Rows of samples.
    pub height: u16,
    /// One byte per sample, row by row from the top left.
    pub samples: &'a [u8],
}

/// Progress of an upload.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// Bytes of scene and bitmaps that the board has, including those that it held before.
    pub done_bytes: usize,
    /// Bytes of scene and bitmaps together.
    pub total_bytes: usize,
}

/// Ignores the progress of an upload, which goes on to its end.
pub fn ignore_progress(_: Progress) -> ControlFlow<()> {
    ControlFlow::Continue(())
}

/// Counts of uploads since the hello.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct UploadCounts {
    /// Bytes of scenes and bitmaps that have arrived.
    pub(super) payload_bytes: u64,
    /// Chunks that the board requested again.
    pub(super) chunks_lost: u64,
}

/// Uploads a scene and its bitmaps that the board does not hold. They do not play before a commit.
pub(super) fn send<L: Link>(
    exchange: &mut Exchange<L>,
    upload: &Upload,
    counts: &mut UploadCounts,
    progress: &mut dyn FnMut(Progress) -> ControlFlow<()>,
) -> Result<(), DeviceError> {
    let total_bytes = upload.total_bytes();
    let mut done_before = 0;
    let scene_start = Command::UploadScene { len: upload.scene.len() as u32, crc32: upload.scene_crc32() };
    let starts = upload.bitmaps.iter().map(|bitmap| (bitmap.start(), bitmap.samples));
    for (start, bytes) in starts.chain([(scene_start, upload.scene)]) {
        let mut report = |done_here| progress(Progress { done_bytes: done_before + done_here, total_bytes });
        send_one(exchange, start, bytes, counts, &mut report)?;
        if report(bytes.len()).is_break() {
            return Err(exchange.interrupted());
        }
        done_before += bytes.len();
    }
    Ok(())
}

/// Uploads one scene or bitmap, unless the board holds it already.
fn send_one<L: Link>(
    exchange: &mut Exchange<L>,
    start: Command,
    bytes: &[u8],
    counts: &mut UploadCounts,
    report: &mut dyn FnMut(usize) -> ControlFlow<()>,
) -> Result<(), DeviceError> {
    for _ in 0..STARTS {
        if exchange.request(start)? == Accepted::AlreadyHeld {
            return Ok(());
        }
        let mut transfer = Transfer::new(exchange, name_of(&start), bytes);
        let end = transfer.run(report)?;
        counts.chunks_lost += transfer.lost;
        if end == End::Arrived {
            counts.payload_bytes += bytes.len() as u64;
            return Ok(());
        }
    }
    Err(exchange.stalled(0, bytes.len()))
}

impl Bitmap<'_> {
    fn start(&self) -> Command {
        Command::UploadBitmap { width: self.width, height: self.height, crc32: self.crc32 }
    }

    fn check(&self) -> Result<(), DeviceError> {
        if self.samples.len() == usize::from(self.width) * usize::from(self.height) {
            return Ok(());
        }
        Err(DeviceError::BitmapSize {
            crc32: self.crc32,
            width: self.width,
            height: self.height,
            found: self.samples.len(),
        })
    }
}

/// Outcome of a transfer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum End {
    /// The board has all of it.
    Arrived,
    /// The answer to the end of the upload was lost, and the answer to a second request is the same whether the board
    /// has the complete upload or nothing.
    Unknown,
}

/// The transfer of one scene or bitmap.
struct Transfer<'a, L> {
    exchange: &'a mut Exchange<L>,
    doing: &'static str,
    bytes: &'a [u8],
    /// The chunk that the board expects next, as of its last report.
    expected: usize,
    /// The chunk to send next.
    next: usize,
    /// For each chunk, the position of its end when it was last sent.
    sent_to: Vec<u64>,
    /// The furthest chunk expected by the board so far.
    furthest: usize,
    /// Consecutive resends without further progress.
    tries: u32,
    lost: u64,
    /// Time of the last progress.
    advanced_at: Duration,
}

impl<'a, L: Link> Transfer<'a, L> {
    fn new(exchange: &'a mut Exchange<L>, doing: &'static str, bytes: &'a [u8]) -> Self {
        exchange.next_chunk = None;
        let advanced_at = exchange.link.now();
        Self {
            exchange,
            doing,
            bytes,
            expected: 0,
            next: 0,
            sent_to: Vec::new(),
            furthest: 0,
            tries: 0,
            lost: 0,
            advanced_at,
        }
    }

    fn run(&mut self, report: &mut dyn FnMut(usize) -> ControlFlow<()>) -> Result<End, DeviceError> {
        loop {
            self.send_chunks(report)?;
            match self.exchange.try_request(Command::UploadEnd)? {
                Ok(_) => return Ok(End::Arrived),
                Err(Refusal::UploadIncomplete { next_chunk: 0 }) if self.exchange.repeated => {
                    return Ok(End::Unknown);
                }
                Err(Refusal::UploadIncomplete { next_chunk }) => {
                    // Discard a report sent before the answer, since further chunks have arrived.
                    self.exchange.next_chunk = None;
                    self.send_again_from(next_chunk)?;
                }
                Err(refusal) => return Err(self.exchange.refused(&Command::UploadEnd, refusal)),
            }
        }
    }

    /// Sends chunks from `next` to the last one, and goes back when the board reports a loss. Returns early if there is
    /// no credit for [`STALL_AFTER`], since lost bytes also take up credit. The caller then requests the end of the
    /// upload, as after the last chunk. If that is too early, the board's refusal contains the next expected chunk. Any
    /// answer corrects the credit.
    fn send_chunks(&mut self, report: &mut dyn FnMut(usize) -> ControlFlow<()>) -> Result<(), DeviceError> {
        let mut sent_at = self.exchange.link.now();
        while self.next < self.chunk_count() && self.exchange.link.now().saturating_sub(sent_at) < STALL_AFTER {
            let wait = if self.send_next()? {
                sent_at = self.exchange.link.now();
                Duration::ZERO
            } else {
                STALL_AFTER
            };
            let watch_in = self.check_advance()?;
            self.exchange.receive(wait.min(watch_in), self.doing)?;
            self.handle_progress()?;
            self.report(report)?;
        }
        self.report(report)
    }

    /// Fails if the board has not acknowledged a byte of an upload for too long. Returns the time until the next check.
    fn check_advance(&mut self) -> Result<Duration, DeviceError> {
        let waited = self.exchange.link.now().saturating_sub(self.advanced_at);
        if waited >= ACKNOWLEDGE_TIMEOUT {
            return Err(DeviceError::UploadTooSlow {
                port: self.exchange.link.name().into(),
                arrived_bytes: self.arrived_bytes(),
                total_bytes: self.bytes.len(),
                waited,
            });
        }
        self.exchange.watch(&Waiting { command: self.doing, waited, waited_max: ACKNOWLEDGE_TIMEOUT })
    }

    /// Reports the progress, and ends the upload at the caller's request.
    fn report(&self, report: &mut dyn FnMut(usize) -> ControlFlow<()>) -> Result<(), DeviceError> {
        if report(self.arrived_bytes()).is_break() { Err(self.exchange.interrupted()) } else { Ok(()) }
    }

    fn chunk_count(&self) -> usize {
        self.bytes.len().div_ceil(CHUNK_LEN)
    }

    /// Bytes that the board has reported as received.
    fn arrived_bytes(&self) -> usize {
        self.bytes.len().min(self.expected * CHUNK_LEN)
    }

    /// Sends the next chunk if there is credit for it, and returns whether it did.
    fn send_next(&mut self) -> Result<bool, DeviceError> {
        let start = self.next * CHUNK_LEN;
        let end = self.bytes.len().min(start + CHUNK_LEN);
        let bytes = self.bytes.get(start..end).unwrap_or_default();
        let mut buffer = [0; FRAME_MAX_LEN];
        let frame = chunk_frame(u16::try_from(self.next).unwrap_or(u16::MAX), bytes, &mut buffer)?;
        let Some(sent_to) = self.exchange.send_bulk(frame, self.doing)? else {
            return Ok(false);
        };
        match self.sent_to.get_mut(self.next) {
            Some(before) => *before = sent_to,
            None => self.sent_to.push(sent_to),
        }
        self.next += 1;
        Ok(true)
    }

    /// Handles the board's last report. An expected chunk that has already left the line was lost.
    fn handle_progress(&mut self) -> Result<(), DeviceError> {
        let Some(expected) = self.exchange.next_chunk.take() else {
            return Ok(());
        };
        self.set_expected(expected);
        let off_the_line = |sent_to: &u64| *sent_to <= self.exchange.credit.settled();
        if self.expected < self.next && self.sent_to.get(self.expected).is_some_and(off_the_line) {
            self.send_again_from(expected)?;
        }
        Ok(())
    }

    fn set_expected(&mut self, chunk: u16) {
        let chunk = usize::from(chunk).min(self.chunk_count());
        if chunk > self.furthest {
            (self.furthest, self.tries) = (chunk, 0);
            self.advanced_at = self.exchange.link.now();
        }
        self.expected = chunk;
    }

    fn send_again_from(&mut self, chunk: u16) -> Result<(), DeviceError> {
        self.set_expected(chunk);
        self.tries += 1;
        if self.tries > TRIES && self.expected == 0 && self.furthest > 0 {
            let (port, total_bytes, times) = (self.exchange.link.name().into(), self.bytes.len(), self.tries);
            return Err(DeviceError::UploadForgotten { port, total_bytes, times });
        }
        if self.tries > TRIES {
            return Err(self.exchange.stalled(self.arrived_bytes(), self.bytes.len()));
        }
        if self.expected < self.next {
            self.next = self.expected;
            self.lost += 1;
        }
        Ok(())
    }
}
