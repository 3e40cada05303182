//! The board's end of the serial line: turns bytes into frames and back.

#[cfg(feature = "stream")]
use frixel_control::StreamBuffer;
use frixel_control::{Active, Board, Order, Status, TickMeter, Ticker};
use frixel_layers::{BitmapPool, Header};
use frixel_wire::fault::State;
use frixel_wire::frame::Decoder;
#[cfg(feature = "store")]
use frixel_wire::hello::ResetCause;
use frixel_wire::payload::Payload;

use crate::Touch;
use crate::commands::Commands;
#[cfg(feature = "store")]
use crate::scene::StoredScene;

/// The board's end of the serial line.
pub struct Session<'a> {
    decoder: Decoder,
    commands: Commands<'a>,
}

impl<'a> Session<'a> {
    /// A session that stores bitmaps in `pool` and builds the next scene in `spare`.
    pub fn new(board: Board, pool: &'a BitmapPool, spare: &'a mut Active) -> Self {
        Self { decoder: Decoder::new(), commands: Commands::new(board, pool, spare) }
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
    /// [`Session::next_order`]. [`Session::poll`] carries out a commit step by step: pings, touches and stops that
    /// arrive meanwhile are served at once, and requests that depend on the commit's outcome wait for it in a queue.
    ///
    /// Frames beyond the host's credit are discarded and have no effect; they do not restart the host timeout either.
    /// Only a hello request needs no credit.
    pub fn receive(&mut self, mut bytes: &[u8], status: &Status) {
        while !bytes.is_empty() {
            // To the end of a frame, good or bad: a zero byte ends both.
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

    /// Advances a commit by one step of about a millisecond at most, or carries out a request that waited for it; also
    /// sends telemetry and unsolicited changes of state. Call this after every tick or, if there is no time for that,
    /// at least once a telemetry period, and pass on touch reports, orders and bytes between two calls.
    pub fn poll(&mut self, status: &Status) {
        self.commands.poll(status);
    }

    /// Takes a report of the board's touch source that arrived at `tick`.
    pub fn touch(&mut self, touch: Touch, tick: u32) {
        self.commands.motion.report(touch, tick, &self.commands.board);
    }

    /// The next order for the ticker, which takes one before each tick.
    pub fn next_order(&mut self) -> Option<Order<'a>> {
        self.commands.next_order()
    }

    /// Takes back the coefficients that [`Ticker::apply`] returned.
    pub fn take_back(&mut self, spare: &'a mut Active) {
        self.commands.scenes.take_back(spare);
    }

    /// Passes the next order to a ticker on the same thread, and takes back the coefficients that it returns. Returns
    /// whether there was an order. A board whose tick is an interrupt puts a queue between [`Session::next_order`] and
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

    /// The supervisor's state once the ticker has applied every order so far.
    pub fn state(&self) -> State {
        self.commands.states.state()
    }

    /// The bytes of the committed scene; `None` without a scene, or once the upload of another has begun.
    pub fn scene(&self) -> Option<&[u8]> {
        self.commands.scenes.bytes()
    }

    /// Header of the committed scene; `None` without a scene. Unlike [`Session::scene`], it stays available during the
    /// upload of the next scene.
    pub fn scene_header(&self) -> Option<&Header> {
        self.commands.scenes.header()
    }

    /// CRC-32 of the scene that [`Session::scene_to_store`] returns; `None` when that returns `None`.
    #[cfg(feature = "store")]
    pub fn crc32_to_store(&self) -> Option<u32> {
        self.commands.crc32_to_store()
    }

    /// The committed scene with its bitmaps, as bytes to store; `None` without a scene, or if the board is not
    /// disarmed.
    #[cfg(feature = "store")]
    pub fn scene_to_store(&self) -> Option<StoredScene<'_>> {
        self.commands.crc32_to_store().and_then(|_| self.commands.scenes.to_store())
    }

    /// Commits a stored scene: `read` fills a buffer with the bytes at an offset, and returns `false` beyond the end.
    /// Returns whether the bytes are a scene that this firmware can play; other bytes are ignored.
    #[cfg(feature = "store")]
    pub fn restore(&mut self, read: impl Fn(u32, &mut [u8]) -> bool) -> bool {
        self.commands.restore(read)
    }

    /// Whether this start must leave the stored scene alone; if so, the hello says it. See [`SceneStore::new`].
    ///
    /// [`SceneStore::new`]: crate::store::SceneStore::new
    #[cfg(feature = "store")]
    pub(crate) fn skips_stored_scene(&mut self) -> bool {
        self.commands.scenes.skips_stored_scene(&self.commands.board)
    }

    /// Tells the hosts that the scene of this CRC-32 could not be stored.
    #[cfg(feature = "store")]
    pub(crate) fn could_not_store(&mut self, crc32: u32) {
        self.commands.scenes.could_not_store(crc32);
    }

    /// Whether a person has started the board: the power came on, or the reset pin was used.
    #[cfg(feature = "store")]
    pub(crate) fn was_started_by_a_person(&self) -> bool {
        matches!(self.commands.board.reset_cause, ResetCause::PowerOn | ResetCause::Pin)
    }

    /// Number of frames received intact and within the host's credit, and number of frames discarded as corrupt or
    /// beyond the credit.
    pub fn frame_counts(&self) -> (u32, u32) {
        let discarded = self.commands.link.frames_discarded();
        (self.decoder.frames().wrapping_sub(discarded), self.decoder.rejected().wrapping_add(discarded))
    }
}
