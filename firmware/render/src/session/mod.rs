//! The session: bytes in, bytes out, no clock but the tick count it is shown.
//!
//! This module turns bytes into frames and back; [`dialogue`] says what the frames mean, and the others do what they ask
//! for: [`greeting`] the hello, [`states`] arming and playing, [`storing`] uploads, whose bytes [`upload`] gathers,
//! [`commit`] the change of scene, [`live`] what changes while one plays, [`fingers`] touches.

mod commit;
mod credit;
mod dialogue;
mod fingers;
mod greeting;
#[cfg(feature = "store")]
mod kept;
mod live;
mod outbox;
mod states;
mod storing;
mod upload;

use frixel_layers::Header;
use frixel_wire::fault::State;
use frixel_wire::frame::Decoder;
use frixel_wire::message::FromBoard;
use frixel_wire::payload::Payload;

use crate::order::Status;
#[cfg(feature = "stream")]
use crate::stream::StreamBuffer;
use crate::{Active, Board, Order, Touch};
use dialogue::Dialogue;
use frixel_layers::BitmapPool;
#[cfg(feature = "store")]
pub use kept::KeptScene;
use outbox::Outbox;

/// One board's end of the serial line.
pub struct Session<'a> {
    decoder: Decoder,
    dialogue: Dialogue<'a>,
    outbox: Outbox,
    telemetry_sent_at_tick: u32,
    /// A byte of the frame that is being received was beyond the host's credit.
    beyond_credit: bool,
    /// Frames that were discarded because they were beyond the host's credit, modulo 2^32.
    frames_discarded: u32,
}

impl<'a> Session<'a> {
    /// A session that stores bitmaps in `pool` and builds the next scene in `spare`.
    pub fn new(board: Board, pool: &'a BitmapPool, spare: &'a mut Active) -> Self {
        Self {
            decoder: Decoder::new(),
            dialogue: Dialogue::new(board, pool, spare),
            outbox: Outbox::new(),
            telemetry_sent_at_tick: 0,
            beyond_credit: false,
            frames_discarded: 0,
        }
    }

    /// From now on, takes the samples of streams into `buffer`, from which the ticker plays them.
    #[cfg(feature = "stream")]
    #[inline]
    pub fn attach_stream(&mut self, buffer: &'a StreamBuffer) {
        self.dialogue.attach_stream(buffer);
    }

    /// Takes bytes from the serial line. Answers wait in [`Session::transmit`], orders in [`Session::next_order`]. A commit
    /// is left to [`Session::poll`], which does it step by step, so that it does not hold up the signs of life, touches and
    /// stops that come meanwhile. A request that has to know how the commit ended finishes it at once: a host that does not
    /// wait for the answer to a commit makes the board spend the time of many ticks here.
    ///
    /// Frames beyond the host's credit are discarded: they are no sign of life, no touch and no order. Only a hello
    /// request needs no credit.
    #[inline]
    pub fn receive(&mut self, mut bytes: &[u8], status: &Status) {
        while !bytes.is_empty() {
            let before = bytes.len();
            let frame = self.decoder.next_frame(&mut bytes);
            self.beyond_credit |= !self.dialogue.credit.take(before - bytes.len());
            let Some(frame) = frame else { continue };
            let payload = Payload::parse_from_host(frame);
            let beyond_credit = core::mem::take(&mut self.beyond_credit);
            if beyond_credit && !matches!(payload, Ok(Payload::HelloRequest { .. })) {
                self.frames_discarded = self.frames_discarded.wrapping_add(1);
            } else {
                self.dialogue.take(payload, status, &mut self.outbox);
            }
        }
    }

    /// Advances a commit by one step of at most a millisecond, and sends what the host did not request: telemetry, and
    /// changes of state. To be called after every tick or, when there is no time for that, at least once a telemetry
    /// period, and with touch reports, orders and bytes handed over in between.
    #[inline]
    pub fn poll(&mut self, status: &Status) {
        self.dialogue.tracker.expire(status.telemetry.tick);
        self.dialogue.step_commit(&mut self.outbox);
        self.dialogue.report_state(status, &mut self.outbox);
        #[cfg(feature = "stream")]
        self.dialogue.report_stream(status, &mut self.outbox);
        if cfg!(feature = "telemetry")
            && let Some(period_ticks) = self.dialogue.telemetry_period_ticks()
            && status.telemetry.tick.wrapping_sub(self.telemetry_sent_at_tick) >= period_ticks
        {
            self.telemetry_sent_at_tick = status.telemetry.tick;
            self.outbox.send_unasked(&FromBoard::Telemetry(status.telemetry));
        }
    }

    /// Takes a report of the board's touch source that arrived at a tick.
    #[inline]
    pub fn touch(&mut self, touch: Touch, tick: u32) {
        self.dialogue.tracker.report(touch, tick);
    }

    /// The next order for the ticker, which takes one before each tick.
    #[inline]
    pub fn next_order(&mut self) -> Option<Order<'a>> {
        self.dialogue.next_order()
    }

    /// Takes back the coefficients that the ticker has let go.
    #[inline]
    pub fn take_back(&mut self, spare: &'a mut Active) {
        self.dialogue.take_back(spare);
    }

    /// Moves bytes for the serial line into `bytes`, and returns how many.
    #[inline]
    pub fn transmit(&mut self, bytes: &mut [u8]) -> usize {
        let count = self.outbox.drain(bytes);
        if count > 0 {
            self.dialogue.credit.grant_reported();
        }
        count
    }

    /// The supervisor's state once the ticker has applied every order that was given out.
    #[inline]
    pub fn state(&self) -> State {
        self.dialogue.state
    }

    /// The committed scene, as it was sent; `None` without one, and when the upload of another has begun.
    #[inline]
    pub fn scene(&self) -> Option<&[u8]> {
        self.dialogue.scene()
    }

    /// Header of the committed scene; `None` without one. Other than [`Session::scene`], it outlives the upload of the
    /// next scene.
    #[inline]
    pub fn scene_header(&self) -> Option<&Header> {
        self.dialogue.playing.header.as_ref()
    }

    /// CRC-32 of what [`Session::kept`] would give.
    #[cfg(feature = "store")]
    #[inline]
    pub fn kept_crc32(&self) -> Option<u32> {
        self.dialogue.kept_crc32()
    }

    /// The committed scene with its bitmaps as bytes to keep; `None` without one, and unless the board is disarmed.
    #[cfg(feature = "store")]
    #[inline]
    pub fn kept(&self) -> Option<KeptScene<'_>> {
        self.dialogue.kept()
    }

    /// Commits a scene from bytes that were kept: `read` gives those at an offset, and `false` beyond their end. Returns
    /// whether there is a scene that this firmware can play; what is not is as if it had never been kept.
    #[cfg(feature = "store")]
    #[inline]
    pub fn restore(&mut self, read: impl Fn(u32, &mut [u8]) -> bool) -> bool {
        self.dialogue.restore(read).is_some()
    }

    /// Frames that were received whole and within the host's credit, and those that were discarded: bad ones, and those
    /// beyond the credit.
    #[inline]
    pub fn frame_counts(&self) -> (u32, u32) {
        let discarded = self.frames_discarded;
        (self.decoder.frames().wrapping_sub(discarded), self.decoder.rejected().wrapping_add(discarded))
    }
}
