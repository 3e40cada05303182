//! The pings of a link: when the next one is due, and which ones were answered.

use std::collections::VecDeque;
use std::ops::RangeInclusive;
use std::time::Duration;

use frixel_wire::frame::Decoder;
use frixel_wire::message::{Command, FromBoard, Request};
use frixel_wire::payload::Payload;

use super::command::frame_of;

/// Time for which a link keeps the board alive after the application's last call. Afterwards the link sends nothing,
/// and the board sets its output to zero after its host timeout.
pub const KEEP_ALIVE_TIMEOUT: Duration = Duration::from_secs(1);
/// Sequence numbers of pings, used in turn and by no other request. There are enough that no two pings under way share
/// one.
pub(super) const PING_SEQUENCES: RangeInclusive<u16> = 0xffc0..=0xffff;
/// Longest frame of a ping: a zero byte, 9 bytes, and two of the encoding.
const PING_MAX_LEN: usize = 12;
/// Largest number of unanswered pings at the normal period, so that a slow board or line is not flooded with pings.
const UNANSWERED_MAX: usize = 2;
/// Largest number of pings sent in place of damaged ones, to a board that has answered one before. On a line with a bit
/// error rate of 1/1000, this many are damaged in a row once in a hundred thousand pings.
const MADE_UP_MAX: usize = 3;
/// Number of round trips after which an unanswered ping is treated as damaged.
const ROUND_TRIPS: u32 = 4;
/// Longest interval to the next ping after two unanswered ones; also the interval after those treated as damaged.
const LOST_AFTER: Duration = Duration::from_millis(750);
/// Largest number of doublings of this interval.
const DOUBLINGS_MAX: usize = 10;
/// Shortest period. A period of zero could block a call for ever.
const PERIOD_MIN: Duration = Duration::from_millis(1);

/// The pings of a [`Link`](crate::Link), which keep a board alive.
///
/// A ping is due when nothing was written for one period. No ping is due while the previous two are unanswered, since
/// pings would otherwise pile up ahead of every command on a slow board. Two pings that stay unanswered for one period
/// and four round trips count as damaged, and a third one is due; if the board has answered before, two more follow.
/// The next ping is due 0.75 s later, and each further one after twice that time: a board that takes longer than 0.75 s
/// per frame counts as silent. A damaged frame counts as the answer to a ping.
///
/// No ping is due once the application has not called the link for [`KEEP_ALIVE_TIMEOUT`], so that a board does not
/// play on for a program that hangs. The next call resumes the pings.
///
/// A link calls [`Self::due_at`], writes [`Self::next_ping`] at that time, and passes all received bytes to
/// [`Self::hear`]. It reports its writes and, if it also pings outside of calls, the start and end of calls. Times are
/// on the link's clock.
#[derive(Debug)]
pub struct KeepAlive {
    period: Option<Duration>,
    last_write: Duration,
    /// Time at which the application's last call returned; `None` during a call.
    last_call: Option<Duration>,
    /// Sequence number of the next ping.
    next: u16,
    /// Sequence number and time of each unanswered ping.
    unanswered: VecDeque<(u16, Duration)>,
    /// Round trip of the last answered ping; `None` before the first answer.
    round_trip: Option<Duration>,
    decoder: Decoder,
}

impl Default for KeepAlive {
    fn default() -> Self {
        Self {
            period: None,
            last_write: Duration::ZERO,
            last_call: None,
            next: *PING_SEQUENCES.start(),
            unanswered: VecDeque::new(),
            round_trip: None,
            decoder: Decoder::new(),
        }
    }
}

impl KeepAlive {
    /// Sets the time without a write after which a ping is due. By default, no pings are sent.
    pub fn set_period(&mut self, period: Duration) {
        self.period = Some(period.max(PERIOD_MIN));
    }

    /// Records a write of bytes other than a ping.
    pub fn wrote(&mut self, now: Duration) {
        self.last_write = now;
    }

    /// Records that the application begins a call that may wait, during which the board is kept alive.
    pub fn enter_call(&mut self) {
        self.last_call = None;
    }

    /// Records that the application's call returns. Before the first use of this method, a call is assumed to be in
    /// progress.
    pub fn leave_call(&mut self, now: Duration) {
        self.last_call = Some(now);
    }

    /// Time at which the next ping is due; `None` without a period, or if the application has stopped calling.
    pub fn due_at(&self, now: Duration) -> Option<Duration> {
        let period = self.period?;
        if self.last_call.is_some_and(|last_call| now.saturating_sub(last_call) >= KEEP_ALIVE_TIMEOUT) {
            return None;
        }
        let unanswered = self.unanswered.len();
        let damaged_max = UNANSWERED_MAX + self.round_trip.map_or(0, |_| MADE_UP_MAX - 1);
        let wait = if unanswered < UNANSWERED_MAX {
            Duration::ZERO
        } else if unanswered <= damaged_max {
            LOST_AFTER.min(period.max(ROUND_TRIPS * self.round_trip.unwrap_or_default()))
        } else {
            LOST_AFTER * (1 << (unanswered - damaged_max - 1).min(DOUBLINGS_MAX))
        };
        let held_back = self.unanswered.back().map_or(Duration::ZERO, |(_, written)| *written + wait);
        Some(held_back.max(self.last_write + period))
    }

    /// Bytes of the next ping, to be written at the time `now`.
    ///
    /// They start with a zero byte if the previous ping is unanswered, since its last byte may have been damaged. One
    /// damaged byte then costs only one ping.
    pub fn next_ping(&mut self, now: Duration) -> Vec<u8> {
        self.wrote(now);
        let mut bytes = if self.unanswered.is_empty() { Vec::new() } else { vec![0] };
        // A ping always fits into a frame.
        bytes.extend(frame_of(self.next, Command::Ping).unwrap_or_default());
        self.unanswered.push_back((self.next, now));
        if self.unanswered.len() > PING_SEQUENCES.len() {
            self.unanswered.pop_front();
        }
        self.next = if self.next == *PING_SEQUENCES.end() { *PING_SEQUENCES.start() } else { self.next + 1 };
        bytes
    }

    /// Searches received bytes for answers to pings, and returns whether there is one.
    pub fn hear(&mut self, bytes: &[u8], now: Duration) -> bool {
        let mut input = bytes;
        let (before, rejected_before) = (self.unanswered.len(), self.decoder.rejected());
        while let Some(payload) = self.decoder.next_frame(&mut input) {
            let Ok(Payload::FromBoard(FromBoard::Answer(answer))) = Payload::parse_from_board(payload) else {
                continue;
            };
            if let Some(position) = self.unanswered.iter().position(|(sequence, _)| *sequence == answer.sequence) {
                // The board answers in order, so an earlier ping or its answer is lost.
                let answered = self.unanswered.drain(..=position).next_back();
                self.round_trip = answered.map(|(_, written)| now.saturating_sub(written));
            }
        }
        let damaged = self.decoder.rejected().wrapping_sub(rejected_before) as usize;
        self.unanswered.drain(..damaged.min(self.unanswered.len()));
        self.unanswered.len() < before
    }
}

/// The sequence number of a ping that [`KeepAlive::next_ping`] made; `None` for any other frame.
pub(super) fn sequence_of_ping(mut frame: &[u8]) -> Option<u16> {
    if frame.len() > PING_MAX_LEN {
        return None;
    }
    match Payload::parse_from_host(Decoder::new().next_frame(&mut frame)?) {
        Ok(Payload::Request(Request { sequence, command: Command::Ping })) => {
            Some(sequence).filter(|sequence| PING_SEQUENCES.contains(sequence))
        }
        _ => None,
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
    const FIRST: u16 = *PING_SEQUENCES.start();

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
        assert!(pings.hear(&answer(FIRST), 100 * MS));
        pings.next_ping(100 * MS);
        assert_eq!(pings.due_at(100 * MS), Some(110 * MS));
        pings.next_ping(110 * MS);
        assert_eq!(pings.due_at(110 * MS), Some((110 + 4 * 100) * MS), "four round trips of 100 ms");
        assert!(pings.hear(&answer(FIRST + 1), 200 * MS));
        assert_eq!(pings.due_at(110 * MS), Some(120 * MS));
    }

    #[test]
    fn two_damaged_pings_are_made_up_for_by_one() {
        let mut pings = pinging();
        pings.next_ping(Duration::ZERO);
        pings.next_ping(10 * MS);
        assert_eq!(pings.due_at(10 * MS), Some(20 * MS));
        for (sent, wait) in [(20 * MS, LOST_AFTER), (770 * MS, 2 * LOST_AFTER), (2270 * MS, 4 * LOST_AFTER)] {
            pings.next_ping(sent);
            assert_eq!(pings.due_at(sent), Some(sent + wait), "the board is slow or silent");
        }
    }

    #[test]
    fn four_damaged_pings_in_a_row_leave_no_gap_on_a_board_that_has_answered_one() {
        let mut pings = pinging();
        pings.next_ping(Duration::ZERO);
        assert!(pings.hear(&answer(FIRST), MS));
        let mut now = 10 * MS;
        for _ in 0..5 {
            pings.next_ping(now);
            assert_eq!(pings.due_at(now), Some(now + if pings.unanswered.len() < 5 { 10 * MS } else { LOST_AFTER }));
            now += 10 * MS;
        }
    }

    #[test]
    fn an_answer_that_arrives_damaged_settles_a_ping() {
        let mut pings = pinging();
        pings.next_ping(Duration::ZERO);
        let mut damaged = answer(FIRST);
        damaged[2] ^= 4;
        assert!(pings.hear(&damaged, MS) && pings.unanswered.is_empty());
    }

    /// The answer to an early ping is not attributed to a later one, whose round trip would then seem short.
    #[test]
    fn the_round_trip_of_a_board_that_becomes_slow_is_its_own() {
        let mut pings = pinging();
        pings.next_ping(Duration::ZERO);
        assert!(pings.hear(&answer(FIRST), MS));
        for sent in [10 * MS, 20 * MS, 30 * MS] {
            pings.next_ping(sent);
        }
        assert!(pings.hear(&answer(FIRST + 1), 110 * MS));
        assert_eq!(pings.due_at(30 * MS), Some((30 + 4 * 100) * MS), "four round trips of 100 ms");
    }

    #[test]
    fn the_answer_to_a_ping_settles_the_one_before_which_was_lost() {
        let mut pings = pinging();
        for round in 0..100 {
            let [first, second] = [20 * round * MS, (20 * round + 10) * MS];
            pings.next_ping(first);
            pings.next_ping(second);
            let sequence = FIRST + (2 * round as u16 + 1) % 64;
            assert!(pings.hear(&answer(sequence), second));
            assert_eq!(pings.due_at(second), Some(second + 10 * MS), "one ping in two is lost, and none is held back");
        }
    }

    #[test]
    fn answers_to_requests_settle_no_ping() {
        let mut pings = pinging();
        pings.next_ping(Duration::ZERO);
        pings.next_ping(10 * MS);
        pings.next_ping(20 * MS);
        assert!(!pings.hear(&answer(7), 21 * MS));
        assert_eq!(pings.due_at(20 * MS), Some(20 * MS + LOST_AFTER));
    }

    #[test]
    fn a_ping_behind_an_unanswered_one_starts_with_a_zero_byte() {
        let mut pings = pinging();
        assert_ne!(pings.next_ping(Duration::ZERO).first(), Some(&0));
        assert_eq!(pings.next_ping(10 * MS).first(), Some(&0));
    }

    /// Pings that were answered at once, up to the time `now`.
    fn answered(pings: &mut KeepAlive, now: Duration) {
        pings.next_ping(now);
        pings.unanswered.clear();
    }

    #[test]
    fn the_pings_end_when_their_timeout_has_passed_since_the_last_call() {
        let mut pings = pinging();
        pings.leave_call(Duration::ZERO);
        let last = KEEP_ALIVE_TIMEOUT.saturating_sub(10 * MS);
        answered(&mut pings, last);
        assert_eq!(pings.due_at(last), Some(KEEP_ALIVE_TIMEOUT));
        for late in [KEEP_ALIVE_TIMEOUT, KEEP_ALIVE_TIMEOUT + 10 * MS, 1000 * KEEP_ALIVE_TIMEOUT] {
            assert_eq!(pings.due_at(late), None, "{late:?} after the last call");
        }
    }

    #[test]
    fn a_call_that_waits_keeps_the_board_alive_and_its_end_restarts_the_timeout() {
        let mut pings = pinging();
        pings.leave_call(Duration::ZERO);
        pings.enter_call();
        let later = 1000 * KEEP_ALIVE_TIMEOUT;
        answered(&mut pings, later);
        assert_eq!(pings.due_at(later), Some(later + 10 * MS));
        pings.leave_call(later);
        assert_eq!(pings.due_at(later + 999 * MS), Some(later + 10 * MS));
        assert_eq!(pings.due_at(later + 1000 * MS), None);
    }

    #[test]
    fn a_ping_is_told_from_other_frames() {
        let mut pings = pinging();
        for number in 0..200 {
            let ping = pings.next_ping(Duration::ZERO);
            assert!(ping.len() <= PING_MAX_LEN);
            assert_eq!(sequence_of_ping(&ping), Some(FIRST + number % 64));
        }
        for (sequence, command) in [(1, Command::Ping), (FIRST, Command::Arm)] {
            assert_eq!(sequence_of_ping(&frame_of(sequence, command).unwrap()), None);
        }
    }
}
