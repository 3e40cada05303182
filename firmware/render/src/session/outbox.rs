//! Bytes on their way to the host.

use frixel_wire::frame::FRAME_MAX_LEN;
use frixel_wire::hello::Hello;
use frixel_wire::message::FromBoard;
use frixel_wire::payload;
use heapless::Deque;

/// Room for the answers to 64 requests, or to fewer with telemetry between them. A host waits for its answers, so that it
/// has one or two outstanding.
const OUTBOX_LEN: usize = 2048;

/// A queue of whole frames.
pub(super) struct Outbox {
    bytes: Deque<u8, OUTBOX_LEN>,
}

impl Outbox {
    pub(super) const fn new() -> Self {
        Self { bytes: Deque::new() }
    }

    #[inline]
    pub(super) fn is_mostly_free(&self) -> bool {
        self.bytes.len() < OUTBOX_LEN / 2
    }

    // Code of its own, as what it calls: many lines call it.
    /// Queues a message; one that does not fit is left out whole, and the host asks again after its deadline.
    #[inline(never)]
    pub(super) fn send(&mut self, message: &FromBoard) {
        let mut frame = [0; FRAME_MAX_LEN];
        if let Ok(frame) = payload::from_board_frame(message, &mut frame) {
            self.push(frame);
        }
    }

    #[inline]
    pub(super) fn send_hello(&mut self, hello: &Hello) {
        let mut frame = [0; FRAME_MAX_LEN];
        if let Ok(frame) = payload::hello_frame(hello, &mut frame) {
            self.push(frame);
        }
    }

    #[inline(never)]
    fn push(&mut self, frame: &[u8]) {
        if OUTBOX_LEN - self.bytes.len() >= frame.len() {
            for byte in frame {
                // There is room: it was looked for above.
                let _ = self.bytes.push_back(*byte);
            }
        }
    }

    #[inline]
    pub(super) fn drain(&mut self, bytes: &mut [u8]) -> usize {
        let mut count = 0;
        for byte in bytes {
            let Some(next) = self.bytes.pop_front() else { break };
            *byte = next;
            count += 1;
        }
        count
    }
}
