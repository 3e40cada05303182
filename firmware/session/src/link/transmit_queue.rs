//! The transmit queue: bytes to be sent to the host.

use frixel_wire::frame::FRAME_MAX_LEN;
use frixel_wire::hello::Hello;
use frixel_wire::message::FromBoard;
use frixel_wire::payload;
use heapless::Deque;

/// Answers that may be outstanding (`PROTOCOL.md`, section 5). A host waits for its answers, so usually one or two are.
const ANSWERS_MAX: usize = 64;
/// Length of the longest frame of an answer: the refusal of a scene that is too costly, with a sequence number and a
/// count of the longest form. A piece of a fault's text, 52 bytes, and tick times, 79 bytes, take the room of two and
/// of three answers.
const ANSWER_MAX_LEN: usize = 37;
/// Unsolicited frames are dropped while more than this is queued, 2.5 ms of a line of 2 Mbaud. They thus leave room for
/// all answers, and those that are sent are recent.
const UNSOLICITED_MAX_LEN: usize = 512;
/// Bytes of the queue: room for all answers and unsolicited frames, and for reports of progress and state.
const QUEUE_LEN: usize = 3072;

const _: () = assert!(ANSWERS_MAX * ANSWER_MAX_LEN + UNSOLICITED_MAX_LEN + FRAME_MAX_LEN <= QUEUE_LEN);

/// A queue of whole frames; the first may have been sent in part.
pub(crate) struct TransmitQueue {
    bytes: Deque<u8, QUEUE_LEN>,
    /// The last byte sent did not end a frame.
    is_inside_frame: bool,
}

impl TransmitQueue {
    pub(crate) const fn new() -> Self {
        Self { bytes: Deque::new(), is_inside_frame: false }
    }

    /// Queues a message, and returns whether there was room. A message that does not fit is dropped whole; the host
    /// repeats its request after a timeout.
    pub(crate) fn send(&mut self, message: &FromBoard) -> bool {
        self.send_within(QUEUE_LEN, message)
    }

    /// Queues an unsolicited message, such as telemetry, unless more than [`UNSOLICITED_MAX_LEN`] bytes are queued.
    pub(crate) fn send_unsolicited(&mut self, message: &FromBoard) -> bool {
        self.send_within(UNSOLICITED_MAX_LEN, message)
    }

    /// Queues a message if at most `len_max` bytes are then queued.
    // Not inlined, because it has many callers.
    #[inline(never)]
    fn send_within(&mut self, len_max: usize, message: &FromBoard) -> bool {
        let mut frame = [0; FRAME_MAX_LEN];
        payload::from_board_frame(message, &mut frame)
            .is_ok_and(|frame| self.bytes.len() + frame.len() <= len_max && self.push(frame))
    }

    /// Replaces all waiting frames by a hello: they were meant for the previous client.
    pub(crate) fn send_hello(&mut self, hello: &Hello) {
        self.keep_begun_frame();
        let mut frame = [0; FRAME_MAX_LEN];
        if let Ok(frame) = payload::hello_frame(hello, &mut frame) {
            self.push(frame);
        }
    }

    /// Drops all frames except the rest of one that has been sent in part.
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
                // There is room: it was checked above.
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
