//! The size of a program on the line: the frames that the driver sends if none is lost.

use frixel_wire::frame::{FRAME_MAX_LEN, crc32};
use frixel_wire::message::{Command, Request};
use frixel_wire::payload::{CHUNK_LEN, WriteError, chunk_frame, request_frame};

use frixel_scene::Program;

/// Byte and frame counts of a program and of its upload.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct OnTheWire {
    /// Header, records and points.
    pub(super) scene_bytes: usize,
    /// Samples of all pictures.
    pub(super) picture_bytes: usize,
    /// Number of frames from the start of the first upload to the commit.
    pub(super) frames: usize,
    /// Bytes of these frames, including the zero byte at the end of each.
    pub(super) wire_bytes: usize,
}

impl OnTheWire {
    /// Encodes every frame of the upload, and counts frames and bytes.
    pub(super) fn of(program: &Program) -> Result<Self, WriteError> {
        let scene = program.scene_bytes();
        let mut line = Line::default();
        for bitmap in &program.bitmaps {
            let (width, height) = (bitmap.width, bitmap.height);
            line.upload(Command::UploadBitmap { width, height, crc32: bitmap.crc32 }, &bitmap.samples)?;
        }
        let scene_crc32 = crc32(&scene);
        line.upload(Command::UploadScene { len: scene.len() as u32, crc32: scene_crc32 }, &scene)?;
        line.request(Command::Commit { crc32: scene_crc32 })?;
        let picture_bytes = program.bitmaps.iter().map(|bitmap| bitmap.samples.len()).sum();
        Ok(Self { scene_bytes: scene.len(), picture_bytes, frames: line.frames, wire_bytes: line.bytes })
    }

    /// Bytes of scene and pictures, without framing and without the requests around an upload.
    pub(super) fn content_bytes(&self) -> usize {
        self.scene_bytes + self.picture_bytes
    }
}

/// A sink that counts frames and bytes.
#[derive(Default)]
struct Line {
    frames: usize,
    bytes: usize,
    sequence: u16,
}

impl Line {
    fn upload(&mut self, start: Command, bytes: &[u8]) -> Result<(), WriteError> {
        self.request(start)?;
        for (number, chunk) in bytes.chunks(CHUNK_LEN).enumerate() {
            let number = u16::try_from(number).unwrap_or(u16::MAX);
            self.sent(chunk_frame(number, chunk, &mut [0; FRAME_MAX_LEN])?);
        }
        self.request(Command::UploadEnd)
    }

    fn request(&mut self, command: Command) -> Result<(), WriteError> {
        self.sequence += 1;
        self.sent(request_frame(&Request { sequence: self.sequence, command }, &mut [0; FRAME_MAX_LEN])?);
        Ok(())
    }

    fn sent(&mut self, frame: &[u8]) {
        self.frames += 1;
        self.bytes += frame.len();
    }
}
