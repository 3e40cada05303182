//! The board's end of the serial line: turns bytes into frames and back.

#[cfg(feature = "stream")]
use frixel_control::StreamBuffer;
use frixel_control::{Active, Board, Order, Status, TickMeter, Ticker};
use frixel_layers::{BitmapPool, Header};
use frixel_wire::fault::State;
use frixel_wire::frame::Decoder;
use frixel_wire::message::Refusal;
use frixel_wire::payload::Payload;

use crate::commands::Commands;
use crate::{NextScene, Touch};

/// The board's end of the serial line.
pub struct Session<'a> {
    decoder: Decoder,
    commands: Commands<'a>,
}

impl<'a> Session<'a> {
    /// A session that stores bitmaps in `pool` and builds the next scene in `next`.
    pub fn new(board: Board, pool: &'a BitmapPool, next: &'a mut NextScene) -> Self {
        Self { decoder: Decoder::new(), commands: Commands::new(board, pool, next) }
    }

    /// Stores the samples of streams in `buffer` from now on. The ticker plays them from there.
    #[cfg(feature = "stream")]
    pub fn attach_stream(&mut self, buffer: &'a StreamBuffer) {
        self.commands.scenes.stream.attach(buffer);
    }

    /// Reports the tick times in `meter` from now on. The board's tick records them there.
    pub fn attach_tick_meter(&mut self, meter: &'a TickMeter) {
        self.commands.tick_meter = Some(meter);
    }

    /// Takes bytes from the serial line. Fetch answers with [`Session::transmit`] and orders with
    /// [`Session::next_order`]. [`Session::poll`] executes a commit step by step: pings, touches and stops that arrive
    /// meanwhile are served at once, and requests that depend on the commit's outcome wait in a queue.
    ///
    /// Frames beyond the host's credit are discarded without effect; they do not restart the host timeout either. Only
    /// a hello request needs no credit.
    pub fn receive(&mut self, mut bytes: &[u8], status: &Status) {
        while !bytes.is_empty() {
            // Up to the end of a valid or invalid frame, which is a zero byte.
            let piece_len = bytes.iter().position(|byte| *byte == 0).map_or(bytes.len(), |zero| zero + 1);
            let (mut piece, rest) = bytes.split_at(piece_len);
            bytes = rest;
            let is_beyond_credit = self.commands.link.count(piece);
            let Some(frame) = self.decoder.next_frame(&mut piece) else { continue };
            let payload = Payload::parse_from_host(frame);
            if is_beyond_credit && !matches!(payload, Ok(Payload::HelloRequest { .. })) {
                self.commands.link.count_discarded();
            } else {
                self.commands.take(payload, status);
            }
        }
    }

    /// Advances a commit by one step of about a millisecond at most, or executes a request that waited for it; also
    /// sends telemetry and unsolicited changes of state. Call this after every tick or, if there is no time for that,
    /// at least once per telemetry period, and pass on touch reports, orders and bytes between two calls.
    pub fn poll(&mut self, status: &Status) {
        self.commands.poll(status);
    }

    /// Takes a report of the board's touch source that arrived at `tick`.
    pub fn touch(&mut self, touch: Touch, tick: u32) {
        self.commands.motion.report(touch, tick);
    }

    /// The next order for the ticker, which takes one before each tick.
    pub fn next_order(&mut self) -> Option<Order<'a>> {
        self.commands.next_order()
    }

    /// Takes back the coefficients returned by [`Ticker::apply`].
    pub fn take_back(&mut self, spare: &'a mut Active) {
        self.commands.scenes.take_back(spare);
    }

    /// Passes the next order to a ticker on the same thread, and takes back the returned coefficients. Returns whether
    /// there was an order. A board whose tick is an interrupt uses a queue between [`Session::next_order`] and
    /// [`Ticker::apply`].
    pub fn hand_order_to(&mut self, ticker: &mut Ticker<'a>) -> bool {
        let Some(order) = self.next_order() else { return false };
        if let Some(spare) = ticker.apply(order) {
            self.take_back(spare);
        }
        true
    }

    /// Moves bytes for the serial line into `bytes`, and returns their number.
    pub fn transmit(&mut self, bytes: &mut [u8]) -> usize {
        self.commands.link.transmit(bytes)
    }

    /// The supervisor's state after the ticker has applied all orders.
    pub fn state(&self) -> State {
        self.commands.states.state()
    }

    /// Header of the committed scene; `None` without a scene.
    pub fn scene_header(&self) -> Option<&Header> {
        self.commands.scenes.header()
    }

    /// Commits one of the board's own scenes at once: without bitmaps, for bring-up or self-test. A host uploads and
    /// commits a scene by messages.
    pub fn commit_own(&mut self, scene: &[u8]) -> Result<(), Refusal> {
        self.commands.commit_own(scene)
    }

    /// Number of frames received intact and within the host's credit, and number of frames discarded as corrupt or
    /// beyond the credit.
    pub fn frame_counts(&self) -> (u32, u32) {
        let discarded = self.commands.link.frames_discarded();
        (self.decoder.frames().wrapping_sub(discarded), self.decoder.rejected().wrapping_add(discarded))
    }
}
