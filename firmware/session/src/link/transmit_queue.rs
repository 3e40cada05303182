//! The transmit queue: bytes to be sent to the host.

use frixel_wire::frame::FRAME_MAX_LEN;
use frixel_wire::hello::Hello;
use frixel_wire::message::FromBoard;
use frixel_wire::payload;
use heapless::Deque;

/// Largest number of outstanding answers (`PROTOCOL.md`, section 5). A host waits for its answers, so usually there are
/// one or two.
const ANSWERS_MAX: usize = 64;
/// Length of the longest frame of an answer: the refusal of a scene that is too costly, with the longest forms of
/// sequence number and count. A piece of a fault's text (52 bytes) takes the room of two answers, and tick times (79
/// bytes) that of three.
const ANSWER_MAX_LEN: usize = 37;
/// Unsolicited frames are dropped while more than this is queued, 2.5 ms of a line of 2 Mbaud. This leaves room for all
/// answers, and keeps unsolicited frames recent.
const UNSOLICITED_MAX_LEN: usize = 512;
/// Bytes of the queue: room for all answers and unsolicited frames, and for reports of progress and state.
const QUEUE_LEN: usize = 3072;

const _: () = assert!(ANSWERS_MAX * ANSWER_MAX_LEN + UNSOLICITED_MAX_LEN + FRAME_MAX_LEN <= QUEUE_LEN);

/// A queue of whole frames, of which the first may be partly sent.
pub(crate) struct TransmitQueue {
    bytes: Deque<u8, QUEUE_LEN>,
    /// Whether the last sent byte did not end a frame.
    is_inside_frame: bool,
}

impl TransmitQueue {
    pub(crate) const fn new() -> Self {
        Self { bytes: Deque::new(), is_inside_frame: false }
    }

    /// Queues a message, and returns whether there was room. A message that does not fit is dropped entirely; the host
    /// repeats its request after a timeout.
    pub(crate) fn send(&mut self, message: &FromBoard) -> bool {
        self.send_within(QUEUE_LEN, message)
    }

    /// Queues an unsolicited message, such as telemetry, unless more than [`UNSOLICITED_MAX_LEN`] bytes are queued.
    pub(crate) fn send_unsolicited(&mut self, message: &FromBoard) -> bool {
        self.send_within(UNSOLICITED_MAX_LEN, message)
    }

    /// Queues a message if at most `len_max` bytes are then queued.
    // Not inlined, since it has many callers.
    #[inline(never)]
    fn send_within(&mut self, len_max: usize, message: &FromBoard) -> bool {
        let mut frame = [0; FRAME_MAX_LEN];
        payload::from_board_frame(message, &mut frame)
            .is_ok_and(|frame| self.bytes.len() + frame.len() <= len_max && self.push(frame))
    }

    /// Replaces all waiting frames, which were for the previous client, by a hello.
    pub(crate) fn send_hello(&mut self, hello: &Hello) {
        self.keep_begun_frame();
        let mut frame = [0; FRAME_MAX_LEN];
        if let Ok(frame) = payload::hello_frame(hello, &mut frame) {
            self.push(frame);
        }
    }

    /// Drops all frames except the rest of a partly sent one.
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
