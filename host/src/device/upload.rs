//! Bulk uploads: chunks under credit, sent again from where one was lost.

use std::time::Duration;

use frixel_wire::frame::{FRAME_MAX_LEN, crc32};
use frixel_wire::message::{Accepted, Command, Refusal};
use frixel_wire::payload::{CHUNK_LEN, chunk_frame};

use super::command::name_of;
use super::error::DeviceError;
use super::exchange::Exchange;
use super::link::Link;

/// An upload that has not got on for this long is looked after.
const STALL_AFTER: Duration = Duration::from_millis(200);
/// How often in a row an upload is sent again from the same chunk.
const TRIES: u32 = 4;

/// What is to play: a compiled scene, and the bitmaps that it names.
#[derive(Clone, Debug)]
pub struct Upload<'a> {
    /// The scene's bytes, as `frixel_wire::scene` lays them out.
    pub scene: &'a [u8],
    /// The bitmaps. Those that the board holds already are not sent.
    pub bitmaps: Vec<Bitmap<'a>>,
}

impl Upload<'_> {
    /// CRC-32 of the scene, which [`super::Device::commit`] names it by.
    pub fn scene_crc32(&self) -> u32 {
        crc32(self.scene)
    }

    /// Bytes of scene and bitmaps together.
    pub fn total_bytes(&self) -> usize {
        self.scene.len() + self.bitmaps.iter().map(|bitmap| bitmap.samples.len()).sum::<usize>()
    }
}

/// A bitmap of a scene.
#[derive(Clone, Copy, Debug)]
pub struct Bitmap<'a> {
    /// CRC-32 of the samples: the bitmap's name in the scene.
    pub crc32: u32,
    /// Samples in a row.
    pub width: u16,
    /// Rows.
    pub height: u16,
    /// One byte a sample, row after row from the top left.
    pub samples: &'a [u8],
}

/// How far an upload has come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// Bytes of scene and bitmaps that the board has, those that it held before included.
    pub done_bytes: usize,
    /// Bytes of scene and bitmaps together.
    pub total_bytes: usize,
}

/// Counts of uploads since the hello.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct UploadCounts {
    /// Bytes of scenes and bitmaps that were sent and have arrived whole.
    pub(super) payload_bytes: u64,
    /// Chunks that had to be sent more than once.
    pub(super) chunks_resent: u64,
}

/// Uploads all that the board does not hold yet. Nothing plays before it is committed.
pub(super) fn send<L: Link>(
    exchange: &mut Exchange<L>,
    upload: &Upload,
    counts: &mut UploadCounts,
    progress: &mut dyn FnMut(Progress),
) -> Result<(), DeviceError> {
    let total_bytes = upload.total_bytes();
    let mut done_before = 0;
    let scene_start = Command::UploadScene {
        len: upload.scene.len() as u32,
        crc32: upload.scene_crc32(),
    };
    let starts = upload.bitmaps.iter().map(|bitmap| (bitmap.start(), bitmap.samples));
    for (start, bytes) in starts.chain([(scene_start, upload.scene)]) {
        let mut report = |done_here| {
            progress(Progress {
                done_bytes: done_before + done_here,
                total_bytes,
            });
        };
        if exchange.request(start)? == Accepted::Done {
            Transfer::new(exchange, name_of(&start), bytes).run(counts, &mut report)?;
        }
        report(bytes.len());
        done_before += bytes.len();
    }
    Ok(())
}

impl Bitmap<'_> {
    fn start(&self) -> Command {
        Command::UploadBitmap {
            width: self.width,
            height: self.height,
            crc32: self.crc32,
        }
    }

    /// Refuses a bitmap that has not one sample for each of its places.
    pub(super) fn check(&self) -> Result<(), DeviceError> {
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

/// One scene or bitmap on its way.
struct Transfer<'a, L> {
    exchange: &'a mut Exchange<L>,
    doing: &'static str,
    bytes: &'a [u8],
    /// The chunk that the board wants next, as far as is known.
    wanted: usize,
    /// The chunk to send next.
    next: usize,
    /// For each chunk, the position on the line at which its last sending ended.
    sent_to: Vec<u64>,
    /// Times in a row that chunks were sent again without the board wanting a later one.
    tries: u32,
    resent: u64,
}

impl<'a, L: Link> Transfer<'a, L> {
    fn new(exchange: &'a mut Exchange<L>, doing: &'static str, bytes: &'a [u8]) -> Self {
        exchange.take_next_chunk();
        Self {
            exchange,
            doing,
            bytes,
            wanted: 0,
            next: 0,
            sent_to: Vec::new(),
            tries: 0,
            resent: 0,
        }
    }

    fn run(mut self, counts: &mut UploadCounts, report: &mut dyn FnMut(usize)) -> Result<(), DeviceError> {
        loop {
            self.send_chunks(report)?;
            match self.exchange.ask(Command::UploadEnd)? {
                Ok(_) => break,
                Err(Refusal::UploadIncomplete { next_chunk }) => self.send_again_from(next_chunk)?,
                Err(refusal) => return Err(self.exchange.refused(&Command::UploadEnd, refusal)),
            }
        }
        counts.payload_bytes += self.bytes.len() as u64;
        counts.chunks_resent += self.resent;
        Ok(())
    }

    /// Sends from `next` to the end, and goes back when the board says that it has to.
    fn send_chunks(&mut self, report: &mut dyn FnMut(usize)) -> Result<(), DeviceError> {
        let mut moved_at = self.exchange.now();
        while self.next < self.chunk_count() {
            let wait = if self.send_next()? { Duration::ZERO } else { STALL_AFTER };
            let settled_before = self.exchange.settled();
            self.exchange.receive(wait, self.doing)?;
            self.take_progress(report)?;
            if wait == Duration::ZERO || self.exchange.settled() > settled_before {
                moved_at = self.exchange.now();
            } else if self.exchange.now() - moved_at >= STALL_AFTER {
                self.look_after()?;
                moved_at = self.exchange.now();
            }
        }
        Ok(())
    }

    fn chunk_count(&self) -> usize {
        self.bytes.len().div_ceil(CHUNK_LEN)
    }

    /// Sends the next chunk, if there is credit for it.
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
            Some(before) => {
                *before = sent_to;
                self.resent += 1;
            }
            None => self.sent_to.push(sent_to),
        }
        self.next += 1;
        Ok(true)
    }

    /// Takes what the board said last. It lacks a chunk that it wants although all of it is off the line.
    fn take_progress(&mut self, report: &mut dyn FnMut(usize)) -> Result<(), DeviceError> {
        let Some(wanted) = self.exchange.take_next_chunk() else {
            return Ok(());
        };
        self.board_wants(wanted);
        report(self.bytes.len().min(self.wanted * CHUNK_LEN));
        let off_the_line = |sent_to: &u64| *sent_to <= self.exchange.settled();
        if self.wanted < self.next && self.sent_to.get(self.wanted).is_some_and(off_the_line) {
            self.send_again_from(wanted)?;
        }
        Ok(())
    }

    fn board_wants(&mut self, chunk: u16) {
        let chunk = usize::from(chunk).min(self.chunk_count());
        if chunk > self.wanted {
            self.tries = 0;
        }
        self.wanted = chunk;
    }

    fn send_again_from(&mut self, chunk: u16) -> Result<(), DeviceError> {
        self.board_wants(chunk);
        self.tries += 1;
        if self.tries > TRIES {
            return Err(DeviceError::UploadStalled {
                port: self.exchange.link().name().into(),
                arrived_bytes: self.bytes.len().min(self.wanted * CHUNK_LEN),
                total_bytes: self.bytes.len(),
            });
        }
        self.next = self.next.min(self.wanted);
        Ok(())
    }

    /// Nothing comes any more, so credit or the board's words may be lost. The end of an upload that is not complete does no harm, and its
    /// refusal says where the board stands; by then nothing else is on the line.
    fn look_after(&mut self) -> Result<(), DeviceError> {
        match self.exchange.ask(Command::UploadEnd)? {
            Err(Refusal::UploadIncomplete { next_chunk }) => self.send_again_from(next_chunk),
            Ok(_) => Ok(()),
            Err(refusal) => Err(self.exchange.refused(&Command::UploadEnd, refusal)),
        }
    }
}
