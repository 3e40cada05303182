//! A host in virtual time for the in-process rig, and scenes to play.
#![allow(
    dead_code,
    unused_imports,
    unreachable_pub,
    clippy::unwrap_used,
    reason = "a test uses its part, and may fail"
)]

use frixel_control::Status;
use frixel_hil_sim::{BoardMemory, LineNoise, Rig, RigConfig, RigTick, Stroke};
use frixel_layers::Header;
use frixel_testkit::Random;
pub use frixel_testkit::{constant, record, scene, scene_with_points};
use frixel_wire::frame::{FRAME_MAX_LEN, crc32};
use frixel_wire::message::{Command, Request};
use frixel_wire::payload::{self, CHUNK_LEN};
use frixel_wire::scene::bitmap_crc32;

/// Ticks between two pings.
const PING_TICKS: u64 = 2_000;

/// Most ticks that a commit takes.
const COMMIT_TICKS_MAX: u32 = 128;

/// Is called with every tick, and with the number of bytes that have arrived at the board.
pub type Watch = Box<dyn FnMut(&RigTick<Status>, u64)>;

/// A host that sends commands, and relies on the board to accept them.
pub struct Script {
    pub rig: Rig<'static>,
    /// Damage of what the host sends.
    pub noise: LineNoise,
    pub watch: Option<Watch>,
    sequence: u16,
    status: Option<Status>,
}

impl Script {
    /// A host of a rig whose memory lives as long as the program.
    pub fn new(config: &RigConfig, stroke: Stroke, seed: u64) -> Self {
        let rig = Rig::new(Box::leak(BoardMemory::new()), config, stroke, seed).unwrap();
        Self { rig, noise: LineNoise::new(seed), watch: None, sequence: 0, status: None }
    }

    fn transmit(&mut self, bytes: &[u8]) {
        let mut arrived = Vec::new();
        self.noise.pass(bytes, &mut arrived);
        self.rig.send(&arrived);
    }

    /// Sends a hello request.
    pub fn hello(&mut self) {
        let mut frame = [0; FRAME_MAX_LEN];
        self.transmit(payload::hello_request_frame(&mut frame).unwrap());
        self.drain();
    }

    /// Sends samples of a stream, and runs until the line is idle.
    pub fn samples(&mut self, first_index: u32, samples: &[u16]) {
        let mut frame = [0; FRAME_MAX_LEN];
        self.transmit(payload::samples_frame(first_index, samples, &mut frame).unwrap());
        self.drain();
    }

    /// The board's status at the last tick.
    pub fn status(&self) -> Status {
        self.status.unwrap()
    }

    /// Sends a command, and runs until the line is idle.
    pub fn command(&mut self, command: Command) {
        self.send(command);
        self.drain();
    }

    /// Sends a command.
    pub fn send(&mut self, command: Command) {
        self.sequence += 1;
        let mut frame = [0; FRAME_MAX_LEN];
        let request = Request { sequence: self.sequence, command };
        self.transmit(payload::request_frame(&request, &mut frame).unwrap());
    }

    pub fn upload_bitmap(&mut self, width: u16, height: u16, samples: &[u8]) -> u32 {
        let crc32 = bitmap_crc32(width, height, samples);
        self.command(Command::UploadBitmap { width, height, crc32 });
        self.chunks(samples);
        crc32
    }

    /// Uploads a scene, and returns the command that commits it.
    pub fn upload(&mut self, scene: &[u8]) -> Command {
        let crc32 = crc32(scene);
        self.command(Command::UploadScene { len: scene.len() as u32, crc32 });
        self.chunks(scene);
        Command::Commit { crc32 }
    }

    /// Uploads a scene and plays it under the finger's stroke.
    pub fn play(&mut self, scene: &[u8]) {
        let commit = self.upload(scene);
        self.command(commit);
        // As a host that waits for the answer to its commit: it takes a step a tick.
        for _ in 0..COMMIT_TICKS_MAX {
            self.step();
        }
        self.command(Command::Arm);
        self.command(Command::Play);
        self.rig.world_mut().start_stroke();
    }

    /// Runs for `ticks` ticks, with pings.
    pub fn run(&mut self, ticks: u64) {
        for tick in 0..ticks {
            if tick.is_multiple_of(PING_TICKS) {
                self.command(Command::Ping);
            }
            self.step();
        }
    }

    fn chunks(&mut self, bytes: &[u8]) {
        for (number, chunk) in bytes.chunks(CHUNK_LEN).enumerate() {
            let mut frame = [0; FRAME_MAX_LEN];
            self.transmit(payload::chunk_frame(number as u16, chunk, &mut frame).unwrap());
            // The line takes no more than the board's credit.
            self.drain();
        }
        self.command(Command::UploadEnd);
    }

    fn drain(&mut self) {
        while self.rig.line_to_board_mut().queued() > 0 {
            self.step();
        }
        self.step();
    }

    /// Runs for `ticks` ticks without pings.
    pub fn steps(&mut self, ticks: u64) {
        for _ in 0..ticks {
            self.step();
        }
    }

    pub fn step(&mut self) -> RigTick<Status> {
        let record = self.rig.step();
        self.status = Some(record.status);
        if let Some(watch) = &mut self.watch {
            watch(&record, self.rig.line_to_board_mut().delivered());
        }
        record
    }
}

/// The example finger on a lower screen.
pub const HEADER: Header = Header { screen_height_m: 0.08, ..frixel_testkit::HEADER };

/// Bytes that look random and are the same every time.
pub fn samples(count: usize, seed: u64) -> Vec<u8> {
    let mut random = Random::new(seed);
    (0..count).map(|_| random.byte()).collect()
}
