//! The pings of a link: when the next one is due, and which ones the board has answered.

use std::collections::VecDeque;
use std::time::Duration;

use frixel_wire::frame::Decoder;
use frixel_wire::message::{Command, FromBoard};
use frixel_wire::payload::Payload;

use super::command::frame_of;

/// Sequence numbers of two pings in a row. No request has them.
pub(super) const PING_SEQUENCES: [u16; 2] = [0, u16::MAX];
/// Most pings without an answer. A board that is slow, or whose line is, then does not spend its time on pings.
const UNANSWERED_MAX: usize = 2;
/// Time after which the last ping counts as lost when neither it nor the one before was answered.
const LOST_AFTER: Duration = Duration::from_millis(750);
/// Shortest period. Without it, a period of zero could block a call for ever.
const PERIOD_MIN: Duration = Duration::from_millis(1);

/// The pings of a [`Link`](crate::Link), which keep a board alive.
///
/// A ping is due when nothing was written for the period, but not while the two before it are unanswered: a board that
/// answers more slowly than it is pinged would have more and more of them ahead of every command. When both are lost,
/// the next one is due 0.75 s after them; a board that takes longer than that for one frame counts as silent.
///
/// A link asks [`Self::due_at`], writes [`Self::next_ping`] then, and passes everything that arrives to
/// [`Self::hear`]. Times are on the link's clock.
#[derive(Debug)]
pub struct KeepAlive {
    period: Option<Duration>,
    frames: [Vec<u8>; 2],
    /// Index of the next ping's frame.
    next: usize,
    /// Index of the frame of each ping without an answer, and when it was written.
    unanswered: VecDeque<(usize, Duration)>,
    decoder: Decoder,
}

impl Default for KeepAlive {
    fn default() -> Self {
        Self {
            period: None,
            // A ping always fits into a frame.
            frames: PING_SEQUENCES.map(|sequence| frame_of(sequence, Command::Ping).unwrap_or_default()),
            next: 0,
            unanswered: VecDeque::new(),
            decoder: Decoder::new(),
        }
    }
}

impl KeepAlive {
    /// Sets the time without a write after which a ping is due. Without it, none is.
    pub fn set_period(&mut self, period: Duration) {
        self.period = Some(period.max(PERIOD_MIN));
    }

    /// When the next ping is due, after a last write at `last_write`; `None` without a period.
    pub fn due_at(&self, last_write: Duration) -> Option<Duration> {
        let due = last_write + self.period?;
        let is_full = self.unanswered.len() >= UNANSWERED_MAX;
        let lost = self.unanswered.back().filter(|_| is_full).map(|(_, written)| *written + LOST_AFTER);
        Some(lost.map_or(due, |lost| lost.max(due)))
    }

    /// The bytes of the next ping, which the link writes at the time `now`.
    ///
    /// They start with a zero byte while the ping before is unanswered, whose own last byte may have been damaged: one
    /// damaged byte then costs one ping.
    pub fn next_ping(&mut self, now: Duration) -> Vec<u8> {
        while self.unanswered.len() >= UNANSWERED_MAX {
            self.unanswered.pop_front();
        }
        let mut bytes = if self.unanswered.is_empty() { Vec::new() } else { vec![0] };
        bytes.extend(self.frames.get(self.next).into_iter().flatten());
        self.unanswered.push_back((self.next, now));
        self.next = (self.next + 1) % self.frames.len();
        bytes
    }

    /// Takes the bytes that have arrived, and looks for answers to pings in them. Returns whether there is one.
    pub fn hear(&mut self, bytes: &[u8]) -> bool {
        let mut input = bytes;
        let before = self.unanswered.len();
        while let Some(payload) = self.decoder.next_frame(&mut input) {
            let Ok(Payload::FromBoard(FromBoard::Answer(answer))) = Payload::parse_from_board(payload) else {
                continue;
            };
            let is_of = |(index, _): &(usize, Duration)| PING_SEQUENCES.get(*index) == Some(&answer.sequence);
            if let Some(position) = self.unanswered.iter().position(is_of) {
                // The board answers in order: a ping before this one is lost, or its answer is.
                self.unanswered.drain(..=position);
            }
        }
        self.unanswered.len() < before
    }
}

#[cfg(test)]
mod tests {
    use frixel_wire::fault::State;
    use frixel_wire::frame::FRAME_MAX_LEN;
    use frixel_wire::message::{Accepted, Answer};
    use frixel_wire::payload::from_board_frame;

    use super::*;

    const MS: Duration = Duration::from_millis(1);

    fn answer(sequence: u16) -> Vec<u8> {
        let answer = Answer { sequence, received_bytes: 0, state: State::Disarmed, outcome: Ok(Accepted::Done) };
        from_board_frame(&FromBoard::Answer(answer), &mut [0; FRAME_MAX_LEN]).unwrap().to_vec()
    }

    fn pinging() -> KeepAlive {
        let mut pings = KeepAlive::default();
        assert_eq!(pings.due_at(Duration::ZERO), None, "without a period there are no pings");
        pings.set_period(10 * MS);
        pings
    }

    #[test]
    fn no_ping_is_due_while_two_are_unanswered() {
        let mut pings = pinging();
        pings.next_ping(Duration::ZERO);
        assert_eq!(pings.due_at(Duration::ZERO), Some(10 * MS));
        pings.next_ping(10 * MS);
        assert_eq!(pings.due_at(10 * MS), Some(10 * MS + LOST_AFTER), "both count as lost then");
        assert!(pings.hear(&answer(PING_SEQUENCES[0])));
        assert_eq!(pings.due_at(10 * MS), Some(20 * MS));
    }

    #[test]
    fn the_answer_to_a_ping_settles_the_one_before_which_was_lost() {
        let mut pings = pinging();
        for round in 0..100 {
            let [first, second] = [20 * round * MS, (20 * round + 10) * MS];
            pings.next_ping(first);
            pings.next_ping(second);
            assert!(pings.hear(&answer(PING_SEQUENCES[1])));
            assert_eq!(pings.due_at(second), Some(second + 10 * MS), "one ping in two is lost, and none is held back");
        }
    }

    #[test]
    fn answers_to_requests_settle_no_ping() {
        let mut pings = pinging();
        pings.next_ping(Duration::ZERO);
        pings.next_ping(10 * MS);
        assert!(!pings.hear(&answer(7)));
        assert_eq!(pings.due_at(10 * MS), Some(10 * MS + LOST_AFTER));
    }

    #[test]
    fn a_ping_behind_an_unanswered_one_starts_with_a_zero_byte() {
        let mut pings = pinging();
        assert_ne!(pings.next_ping(Duration::ZERO).first(), Some(&0));
        assert_eq!(pings.next_ping(10 * MS).first(), Some(&0));
    }
}
