//! The link: the host's credit, waiting requests, and the transmit queue.
//!
//! Takes received bytes, to count them against the host's credit; requests that must wait for a commit; and answers,
//! progress, telemetry and changes of state to send. Returns bytes for the serial line, and waiting requests in the
//! order of arrival. It is independent of scenes, fingers and orders; the state in an answer is passed to it.

mod credit;
mod transmit_queue;

use frixel_control::Status;
use frixel_wire::fault::{Fault, Flags, State};
use frixel_wire::hello::Hello;
use frixel_wire::message::{
    Accepted, Answer, Command, FromBoard, Refusal, Request, TELEMETRY_MAX_HZ, Telemetry, telemetry_period_ticks,
};
use heapless::Deque;

use credit::Credit;
use transmit_queue::TransmitQueue;

/// Largest number of requests that may wait for a commit; further ones are refused as busy. A host that waits for its
/// answers has at most one.
const WAITING_MAX: usize = 8;

/// Credit, waiting requests and transmit queue.
pub(crate) struct Link {
    credit: Credit,
    queue: TransmitQueue,
    /// Requests that arrived during a commit and must be executed after it.
    waiting: Deque<Request, WAITING_MAX>,
    /// Sequence number of the last request of a commit.
    commit_sequence: u16,
    /// Zero without telemetry.
    telemetry_period_ticks: u32,
    telemetry_sent_at_tick: u32,
    /// Whether a byte of the current frame was beyond the host's credit.
    beyond_credit: bool,
    /// Frames discarded for exceeding the host's credit, modulo 2^32.
    frames_discarded: u32,
}

impl Link {
    pub(crate) const fn new(receive_window_bytes: u16) -> Self {
        Self {
            credit: Credit::new(receive_window_bytes),
            queue: TransmitQueue::new(),
            waiting: Deque::new(),
            commit_sequence: 0,
            telemetry_period_ticks: 0,
            telemetry_sent_at_tick: 0,
            beyond_credit: false,
            frames_discarded: 0,
        }
    }

    /// Counts bytes of one frame, at most up to its end. Returns whether a byte of that frame was beyond the credit.
    pub(crate) fn count(&mut self, piece: &[u8]) -> bool {
        self.beyond_credit |= !self.credit.take(piece.len());
        let beyond_credit = self.beyond_credit;
        if piece.ends_with(&[0]) {
            self.beyond_credit = false;
        }
        beyond_credit
    }

    /// Counts a frame discarded for exceeding the credit.
    pub(crate) fn count_discarded(&mut self) {
        self.frames_discarded = self.frames_discarded.wrapping_add(1);
    }

    pub(crate) fn frames_discarded(&self) -> u32 {
        self.frames_discarded
    }

    /// Begins a session with a new client: full credit, no telemetry, and no waiting requests. Waiting requests are not
    /// answered, since their client is gone.
    pub(crate) fn restart(&mut self) {
        self.credit.restart();
        self.telemetry_period_ticks = 0;
        self.waiting.clear();
    }

    /// Replaces all unsent frames by a hello.
    pub(crate) fn send_hello(&mut self, hello: &Hello) {
        self.queue.send_hello(hello);
    }

    /// Keeps a request until the commit has ended, or refuses it.
    pub(crate) fn wait(&mut self, request: Request, state: State) {
        if self.waiting.push_back(request).is_err() {
            self.answer(request.sequence, Err(Refusal::Busy), state);
        }
    }

    /// Whether a request waits.
    pub(crate) fn has_waiting(&self) -> bool {
        !self.waiting.is_empty()
    }

    /// Whether a waiting request begins a stream.
    pub(crate) fn has_waiting_stream(&self) -> bool {
        self.waiting.iter().any(|waiting| matches!(waiting.command, Command::StartStream { .. }))
    }

    /// The oldest waiting request.
    pub(crate) fn next_waiting(&mut self) -> Option<Request> {
        self.waiting.pop_front()
    }

    /// Refuses the requests that wait.
    pub(crate) fn refuse_waiting(&mut self, state: State) {
        while let Some(waiting) = self.waiting.pop_front() {
            self.answer(waiting.sequence, Err(Refusal::Busy), state);
        }
    }

    pub(crate) fn answer(&mut self, sequence: u16, outcome: Result<Accepted, Refusal>, state: State) {
        let answer = Answer { sequence, received_bytes: self.credit.received(), state, outcome };
        self.report(&FromBoard::Answer(answer));
    }

    /// Remembers the request that [`Self::answer_commit`] answers.
    pub(crate) fn commit_begins(&mut self, sequence: u16) {
        self.commit_sequence = sequence;
    }

    pub(crate) fn answer_commit(&mut self, outcome: Result<(), Refusal>, state: State) {
        self.answer(self.commit_sequence, outcome.map(|()| Accepted::Done), state);
    }

    /// Reports the progress of an upload.
    pub(crate) fn report_progress(&mut self, next_chunk: u16) {
        self.report(&FromBoard::Progress { next_chunk, received_bytes: self.credit.received() });
    }

    /// Sends a message that contains the count of received bytes.
    fn report(&mut self, message: &FromBoard) {
        if self.queue.send(message) {
            self.credit.reported();
        }
    }

    /// Reports the progress of a stream: the index after the last received sample, and the room for further ones.
    /// Returns whether the transmit queue had room.
    pub(crate) fn report_stream(&mut self, (next_index, room): (u32, u16), status: &Status) -> bool {
        let progress = FromBoard::StreamProgress {
            next_index,
            room,
            underruns: status.counters.stream_underruns,
            gaps: status.counters.stream_gaps,
            received_bytes: self.credit.received(),
        };
        let is_sent = self.queue.send_unsolicited(&progress);
        if is_sent {
            self.credit.reported();
        }
        is_sent
    }

    /// Reports an unrequested change of state.
    pub(crate) fn report_state(&mut self, state: State, fault: Option<Fault>, flags: Flags) {
        self.queue.send(&FromBoard::StateChanged { state, fault, flags });
    }

    /// Sends telemetry with this period from now on; 0 ends it.
    pub(crate) fn subscribe(&mut self, period_ticks: u32, tick_hz: u32) -> Result<Accepted, Refusal> {
        let period_min_ticks = telemetry_period_ticks(tick_hz, TELEMETRY_MAX_HZ);
        if period_ticks != 0 && period_ticks < period_min_ticks {
            return Err(Refusal::TelemetryTooFast { period_min_ticks });
        }
        self.telemetry_period_ticks = period_ticks;
        Ok(Accepted::Done)
    }

    /// Sends telemetry if its period has passed.
    pub(crate) fn send_telemetry(&mut self, telemetry: &Telemetry) {
        let period_ticks = self.telemetry_period_ticks;
        if period_ticks > 0 && telemetry.tick.wrapping_sub(self.telemetry_sent_at_tick) >= period_ticks {
            self.telemetry_sent_at_tick = telemetry.tick;
            self.queue.send_unsolicited(&FromBoard::Telemetry(*telemetry));
        }
    }

    /// Moves bytes for the serial line into `bytes`, and returns their number.
    pub(crate) fn transmit(&mut self, bytes: &mut [u8]) -> usize {
        let count = self.queue.drain(bytes);
        if count > 0 {
            self.credit.grant_reported();
        }
        count
    }
}
