//! A host on the same processor: puts a scene on the board and plays it.

use core::array;

use frixel_render::{Session, Ticker};
use frixel_wire::frame::{FRAME_MAX_LEN, crc32};
use frixel_wire::message::{Command, Request};
use frixel_wire::payload::{self, CHUNK_LEN};
use frixel_wire::scene::bitmap_crc32;

/// Samples a second of the stream.
pub const STREAM_HZ: u32 = 40_000 / STREAM_TICKS_PER_SAMPLE;
/// Ticks for a sample of the stream.
pub const STREAM_TICKS_PER_SAMPLE: u32 = 2;
/// Samples that are sent at a time.
pub const STREAM_FRAME: usize = 64;

/// A session and the ticker that it gives orders to.
pub struct Host<'a> {
    pub session: Session<'a>,
    pub ticker: Ticker<'a>,
    sequence: u16,
}

impl<'a> Host<'a> {
    /// A host for a board that has just started.
    pub fn new(session: Session<'a>, ticker: Ticker<'a>) -> Self {
        Self { session, ticker, sequence: 0 }
    }

    /// Sends a command.
    pub fn command(&mut self, command: Command) {
        self.sequence += 1;
        let request = Request { sequence: self.sequence, command };
        let mut frame = [0; FRAME_MAX_LEN];
        let Ok(frame) = payload::request_frame(&request, &mut frame) else { panic!("a command does not fit a frame") };
        self.send(frame);
    }

    /// Sends a picture, and returns its name.
    pub fn bitmap(&mut self, width: u16, height: u16, samples: &[u8]) -> u32 {
        let crc32 = bitmap_crc32(width, height, samples);
        self.command(Command::UploadBitmap { width, height, crc32 });
        self.chunks(samples);
        crc32
    }

    /// Sends a scene and plays it.
    pub fn play(&mut self, scene: &[u8]) {
        let crc32 = crc32(scene);
        self.command(Command::UploadScene { len: scene.len() as u32, crc32 });
        self.chunks(scene);
        self.command(Command::Commit { crc32 });
        self.command(Command::Arm);
        self.command(Command::Play);
    }

    /// Sends frame number `frame` of a stream. A board whose scene has none drops it.
    pub fn stream(&mut self, frame: u32) {
        let samples: [u16; STREAM_FRAME] = array::from_fn(|index| if index % 2 == 0 { 0x4000 } else { 0xc000 });
        let mut bytes = [0; FRAME_MAX_LEN];
        let Ok(bytes) = payload::samples_frame(frame * STREAM_FRAME as u32, &samples, &mut bytes) else {
            panic!("samples do not fit a frame")
        };
        self.send(bytes);
    }

    fn chunks(&mut self, bytes: &[u8]) {
        for (number, chunk) in (0..).zip(bytes.chunks(CHUNK_LEN)) {
            let mut frame = [0; FRAME_MAX_LEN];
            let Ok(frame) = payload::chunk_frame(number, chunk, &mut frame) else {
                panic!("a chunk does not fit a frame")
            };
            self.send(frame);
        }
        self.command(Command::UploadEnd);
    }

    fn send(&mut self, bytes: &[u8]) {
        let status = self.ticker.status();
        self.session.receive(bytes, &status);
        self.session.poll(&status);
        while let Some(order) = self.session.next_order() {
            if let Some(spare) = self.ticker.apply(order) {
                self.session.take_back(spare);
            }
        }
        // Nobody reads the answers: what went wrong shows in the state.
        self.session.transmit(&mut [0; 2048]);
    }
}
