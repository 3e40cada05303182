//! Bytes on their way to the host.

use frixel_wire::frame::FRAME_MAX_LEN;
use frixel_wire::hello::Hello;
use frixel_wire::message::FromBoard;
use frixel_wire::payload;
use heapless::Deque;

/// Answers that may be outstanding (`PROTOCOL.md`, section 5). A host waits for its answers, so that it has one or two.
const ANSWERS_MAX: usize = 64;
/// The longest frame of an answer, that a scene is too costly, with a sequence number and a count of the longest form.
/// A piece of a fault's text is longer, 52 bytes; a text has seven of them at most.
const ANSWER_MAX_LEN: usize = 37;
/// Frames that nobody waits for are left out while more than this is queued, 2.5 ms of a line of 2 Mbaud. So they leave
/// room for all answers, and what comes of them is not old.
const UNASKED_MAX_LEN: usize = 512;
/// Room for all of them, and for what tells how an upload goes and what the board's state is.
const QUEUE_LEN: usize = 3072;

const _: () = assert!(ANSWERS_MAX * ANSWER_MAX_LEN + UNASKED_MAX_LEN + FRAME_MAX_LEN <= QUEUE_LEN);

/// A queue of whole frames, the first of which may have left in part.
pub(crate) struct TransmitQueue {
    bytes: Deque<u8, QUEUE_LEN>,
    /// The last byte that left did not end a frame.
    is_inside_frame: bool,
}

impl TransmitQueue {
    pub(crate) const fn new() -> Self {
        Self { bytes: Deque::new(), is_inside_frame: false }
    }

    /// Queues a message, and returns whether there was room. One that does not fit is left out whole, and the host asks
    /// again after its deadline.
    pub(crate) fn send(&mut self, message: &FromBoard) -> bool {
        self.send_within(QUEUE_LEN, message)
    }

    /// Queues a message that no request asked for, such as telemetry, unless the line is behind.
    pub(crate) fn send_unasked(&mut self, message: &FromBoard) -> bool {
        self.send_within(UNASKED_MAX_LEN, message)
    }

    /// Queues a message when no more than `len_max` bytes are queued then.
    // Code of its own: many lines call it.
    #[inline(never)]
    fn send_within(&mut self, len_max: usize, message: &FromBoard) -> bool {
        let mut frame = [0; FRAME_MAX_LEN];
        payload::from_board_frame(message, &mut frame)
            .is_ok_and(|frame| self.bytes.len() + frame.len() <= len_max && self.push(frame))
    }

    /// Queues a hello in the place of all that waits: that was meant for the client before.
    pub(crate) fn send_hello(&mut self, hello: &Hello) {
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
        let fits = QUEUE_LEN - self.bytes.len() >= frame.len();
        if fits {
            for byte in frame {
                // There is room: it was looked for above.
                let _ = self.bytes.push_back(*byte);
            }
        }
        fits
    }

    pub(crate) fn drain(&mut self, bytes: &mut [u8]) -> usize {
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
