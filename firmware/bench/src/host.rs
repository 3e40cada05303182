//! A host on the same processor that uploads a scene to the board and plays it.

use core::array;

use frixel_control::{Drive, Order, Sense, Ticker};
use frixel_session::{Session, Touch};
use frixel_wire::frame::{FRAME_MAX_LEN, crc32};
use frixel_wire::message::{Command, Request};
use frixel_wire::payload::{self, CHUNK_LEN};
use frixel_wire::scene::bitmap_crc32;

/// Sample rate of the stream, in Hz.
pub const STREAM_HZ: u32 = 40_000 / STREAM_TICKS_PER_SAMPLE;
/// Ticks per sample of the stream.
pub const STREAM_TICKS_PER_SAMPLE: u32 = 2;
/// Samples in a frame of the stream.
pub const STREAM_FRAME: usize = 64;

/// Most steps that a commit takes.
const COMMIT_STEPS_MAX: u32 = 200;

/// A session, and the ticker that receives its orders.
pub struct Host<'a> {
    pub session: Session<'a>,
    pub ticker: Ticker<'a>,
    /// The order that the next tick takes.
    order: Option<Order<'a>>,
    sequence: u16,
}

impl<'a> Host<'a> {
    /// A host for a board that has just started.
    pub fn new(session: Session<'a>, ticker: Ticker<'a>) -> Self {
        Self { session, ticker, order: None, sequence: 0 }
    }

    /// Does the main loop's work before a tick: passes a report of the touch source to the session, and takes the
    /// session's next order.
    pub fn before_tick(&mut self, touch: Option<Touch>) {
        if let Some(touch) = touch {
            self.session.touch(touch, self.ticker.status().telemetry.tick.wrapping_add(1));
        }
        self.order = self.session.next_order();
    }

    /// Applies the waiting order, and runs the tick.
    pub fn tick(&mut self, sense: &Sense) -> Drive {
        if let Some(order) = self.order.take() {
            // `command` hands scenes over itself, so the result is not needed here.
            let _ = self.ticker.apply(order);
        }
        self.ticker.tick(sense)
    }

    /// Sends a ping, and leaves the resulting order for the next tick.
    pub fn ping(&mut self) {
        self.send_without_orders(Command::Ping);
    }

    /// Sends a command, and applies the orders that result from it.
    pub fn command(&mut self, command: Command) {
        self.send_without_orders(command);
        self.hand_over();
    }

    fn send_without_orders(&mut self, command: Command) {
        self.receive(command);
        self.poll();
    }

    /// Passes the bytes of a command to the session.
    fn receive(&mut self, command: Command) {
        self.sequence += 1;
        let request = Request { sequence: self.sequence, command };
        let mut frame = [0; FRAME_MAX_LEN];
        let Ok(frame) = payload::request_frame(&request, &mut frame) else { panic!("a command does not fit a frame") };
        self.receive_bytes(frame);
    }

    /// Sends a picture, and returns its name.
    pub fn bitmap(&mut self, width: u16, height: u16, samples: &[u8]) -> u32 {
        let crc32 = bitmap_crc32(width, height, samples);
        self.command(Command::UploadBitmap { width, height, crc32 });
        self.chunks(samples);
        crc32
    }

    /// Sends a scene.
    pub fn upload(&mut self, scene: &[u8]) {
        self.command(Command::UploadScene { len: scene.len() as u32, crc32: crc32(scene) });
        self.chunks(scene);
    }

    /// Requests the commit of a scene, and passes every one of its steps to `step`, which calls [`Host::poll`].
    pub fn commit(&mut self, scene: &[u8], mut step: impl FnMut(&mut Self)) {
        self.receive(Command::Commit { crc32: crc32(scene) });
        for _ in 0..COMMIT_STEPS_MAX {
            step(self);
            self.hand_over();
        }
    }

    /// Does the main loop's work besides touches and orders: a step of a commit that is under way.
    pub fn poll(&mut self) {
        self.session.poll(&self.ticker.status());
    }

    /// Sends a scene and plays it.
    pub fn play(&mut self, scene: &[u8]) {
        self.upload(scene);
        self.commit(scene, Self::poll);
        self.command(Command::Arm);
        self.command(Command::Play);
    }

    /// Sends frame number `frame` of a stream. A board whose scene has no stream drops it.
    pub fn stream(&mut self, frame: u32) {
        let samples: [u16; STREAM_FRAME] = array::from_fn(|index| if index % 2 == 0 { 0x4000 } else { 0xc000 });
        let mut bytes = [0; FRAME_MAX_LEN];
        let Ok(bytes) = payload::samples_frame(frame * STREAM_FRAME as u32, &samples, &mut bytes) else {
            panic!("samples do not fit a frame")
        };
        self.receive_bytes(bytes);
        self.poll();
    }

    fn chunks(&mut self, bytes: &[u8]) {
        for (number, chunk) in (0..).zip(bytes.chunks(CHUNK_LEN)) {
            let mut frame = [0; FRAME_MAX_LEN];
            let Ok(frame) = payload::chunk_frame(number, chunk, &mut frame) else {
                panic!("a chunk does not fit a frame")
            };
            self.receive_bytes(frame);
        }
        self.command(Command::UploadEnd);
    }

    fn receive_bytes(&mut self, bytes: &[u8]) {
        self.session.receive(bytes, &self.ticker.status());
        // Discards the answers: an error shows in the state.
        self.session.transmit(&mut [0; 2048]);
    }

    fn hand_over(&mut self) {
        while self.session.hand_order_to(&mut self.ticker) {}
    }
}
