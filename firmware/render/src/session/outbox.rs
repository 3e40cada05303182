//! Bytes on their way to the host.

use frixel_wire::frame::FRAME_MAX_LEN;
use frixel_wire::hello::Hello;
use frixel_wire::message::FromBoard;
use frixel_wire::payload;
use heapless::Deque;

/// Room for the answers to 64 requests, or to fewer with telemetry between them. A host waits for its answers, so that it
/// has one or two outstanding.
const OUTBOX_LEN: usize = 2048;

/// A queue of whole frames, the first of which may have left in part.
pub(super) struct Outbox {
    bytes: Deque<u8, OUTBOX_LEN>,
    /// The last byte that left did not end a frame.
    is_inside_frame: bool,
}

impl Outbox {
    pub(super) const fn new() -> Self {
        Self { bytes: Deque::new(), is_inside_frame: false }
    }

    #[inline]
    pub(super) fn is_mostly_free(&self) -> bool {
        self.bytes.len() < OUTBOX_LEN / 2
    }

    // Code of its own, as what it calls: many lines call it.
    /// Queues a message, and returns whether there was room. One that does not fit is left out whole, and the host asks
    /// again after its deadline.
    #[inline(never)]
    pub(super) fn send(&mut self, message: &FromBoard) -> bool {
        let mut frame = [0; FRAME_MAX_LEN];
        payload::from_board_frame(message, &mut frame).is_ok_and(|frame| self.push(frame))
    }

    /// Queues a hello in the place of all that waits: that was meant for the client before.
    #[inline]
    pub(super) fn send_hello(&mut self, hello: &Hello) {
        self.keep_begun_frame();
        let mut frame = [0; FRAME_MAX_LEN];
        if let Ok(frame) = payload::hello_frame(hello, &mut frame) {
            self.push(frame);
        }
    }

    /// Drops all frames but the rest of one that has left in part.
    fn keep_begun_frame(&mut self) {
        let rest = self.bytes.iter().position(|byte| *byte == 0).map_or(0, |end| end + 1);
        let kept = if self.is_inside_frame { rest } else { 0 };
        while self.bytes.len() > kept {
            let _ = self.bytes.pop_back();
        }
    }

    #[inline(never)]
    fn push(&mut self, frame: &[u8]) -> bool {
        let fits = OUTBOX_LEN - self.bytes.len() >= frame.len();
        if fits {
            for byte in frame {
                // There is room: it was looked for above.
                let _ = self.bytes.push_back(*byte);
            }
        }
        fits
    }

    #[inline]
    pub(super) fn drain(&mut self, bytes: &mut [u8]) -> usize {
        let mut count = 0;
        for byte in bytes {
            let Some(next) = self.bytes.pop_front() else { break };
            *byte = next;
            self.is_inside_frame = next != 0;
            count += 1;
        }
        count
    }
}
