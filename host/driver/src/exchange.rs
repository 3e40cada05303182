//! Requests and their answers, over a [`Link`].

mod incoming;

use std::collections::VecDeque;
use std::ops::ControlFlow;
use std::time::Duration;

use frixel_wire::fault::State;
use frixel_wire::frame::Decoder;
use frixel_wire::hello::Hello;
use frixel_wire::message::{Accepted, Answer, Command, Refusal};

use super::Event;
use super::command::{frame_of, name_of, state_after};
use super::credit::Credit;
use super::error::{DeviceError, LinkClosed};
use super::keep_alive::PING_SEQUENCES;
use super::link::Link;
pub(super) use incoming::StreamReport;

/// Sequence number of requests whose answer is ignored.
const UNAWAITED: u16 = 0;
/// Timeout of an answer after its request has reached the board; also the timeout of a stalled line.
pub(super) const ANSWER_TIMEOUT: Duration = Duration::from_millis(750);
/// Retry interval of a request, measured like [`ANSWER_TIMEOUT`], in case its frame was damaged.
const REPEAT_AFTER: Duration = Duration::from_millis(250);
/// Timeout of a request regardless of other traffic.
const REQUEST_TIMEOUT: Duration = Duration::from_secs(10);
/// Time for an orderly end of a wait that a person interrupts.
const GRACE: Duration = Duration::from_secs(1);
/// Longest interval between calls of a watcher.
const WAITING_PERIOD: Duration = Duration::from_millis(100);
/// Retry interval while the board is busy.
const BUSY_RETRY_AFTER: Duration = Duration::from_millis(5);
/// Credit that uploads leave free for commands and pings, bytes: enough for about a dozen. Lost ones take up credit
/// until a command is answered.
const RESERVE_LEN: usize = 256;
/// Credit that commands leave free for pings, bytes: up to ten of them may be unanswered after a minute.
const PING_RESERVE_LEN: usize = 128;

/// State of a waiting call; see [`Device::while_waiting`](crate::Device::while_waiting).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Waiting {
    /// The command whose answer is awaited, or the upload to be acknowledged.
    pub command: &'static str,
    /// Time since the board's last answer, or since it last acknowledged a byte.
    pub waited: Duration,
    /// Timeout of the call.
    pub waited_max: Duration,
}

impl Waiting {
    /// Whether the wait has had time for an orderly end, so that an interrupted program may break it off.
    pub fn may_break_off(&self) -> bool {
        self.waited >= GRACE
    }
}

/// A function that observes a waiting call, and may end it.
pub(super) type Watcher = Box<dyn FnMut(&Waiting) -> ControlFlow<()> + Send>;

/// The connection to a board that has answered the hello, with everything in transit in both directions.
pub(super) struct Exchange<L> {
    pub(super) link: L,
    decoder: Decoder,
    /// Frames rejected by the decoder before the hello, left over from an earlier connection.
    rejected_before: u32,
    incoming: Vec<u8>,
    pub(super) credit: Credit,
    sequence: u16,
    awaited: Vec<Awaited>,
    answer: Option<Answer>,
    /// Whether the last answer was to a resent request, which the board may have executed twice.
    pub(super) repeated: bool,
    /// The chunk that the board expects next, until an upload takes it.
    pub(super) next_chunk: Option<u16>,
    /// The board's last report on the stream.
    pub(super) stream: Option<StreamReport>,
    /// Whether the next answer starts a new stream, so that earlier reports belong to the old one.
    pub(super) stream_begins: bool,
    pub(super) events: VecDeque<Event>,
    /// Tick of the last telemetry message.
    telemetry_tick: Option<u32>,
    /// Time spent reading since the last received bytes.
    quiet: Duration,
    pub(super) watcher: Option<Watcher>,
}

/// A request that waits for its answer.
struct Awaited {
    sequence: u16,
    /// Position of the end of its frame.
    end: u64,
}

impl<L: Link> Exchange<L> {
    pub(super) fn new(link: L, decoder: Decoder, hello: &Hello) -> Self {
        let written = link.written().bytes;
        Self {
            credit: Credit::new(hello.limits.receive_window_bytes, written),
            rejected_before: decoder.rejected(),
            quiet: Duration::ZERO,
            watcher: None,
            link,
            decoder,
            incoming: Vec::new(),
            sequence: UNAWAITED,
            awaited: Vec::new(),
            answer: None,
            repeated: false,
            next_chunk: None,
            stream: None,
            stream_begins: false,
            events: VecDeque::new(),
            telemetry_tick: None,
        }
    }

    /// Number of damaged frames from the board since the hello.
    pub(super) fn frames_rejected(&self) -> u32 {
        self.decoder.rejected().wrapping_sub(self.rejected_before)
    }

    /// Calls the watcher, and returns the time until its next call.
    pub(super) fn watch(&mut self, waiting: &Waiting) -> Result<Duration, DeviceError> {
        match self.watcher.as_mut().map(|watcher| watcher(waiting)) {
            None => Ok(Duration::MAX),
            Some(ControlFlow::Continue(())) => Ok(WAITING_PERIOD),
            Some(ControlFlow::Break(())) => {
                Err(DeviceError::BrokenOff { port: self.link.name().into(), command: waiting.command })
            }
        }
    }

    /// Sets the commands that the link sends when it is dropped.
    pub(super) fn set_shutdown_commands(&mut self, commands: &[Command]) -> Result<(), DeviceError> {
        let frames: Result<Vec<_>, _> = commands.iter().map(|command| frame_of(UNAWAITED, *command)).collect();
        self.link.set_shutdown_frames(frames?.concat());
        Ok(())
    }

    /// Sends a command and waits until the board accepts it. A refusal is an error.
    pub(super) fn request(&mut self, command: Command) -> Result<Accepted, DeviceError> {
        match self.try_request(command)? {
            Ok(accepted) => Ok(accepted),
            Err(refusal) => Err(self.refused(&command, refusal)),
        }
    }

    pub(super) fn refused(&self, command: &Command, refusal: Refusal) -> DeviceError {
        DeviceError::Refused { port: self.link.name().into(), command: name_of(command), refusal }
    }

    pub(super) fn stalled(&self, arrived_bytes: usize, total_bytes: usize) -> DeviceError {
        DeviceError::UploadStalled { port: self.link.name().into(), arrived_bytes, total_bytes }
    }

    pub(super) fn interrupted(&self) -> DeviceError {
        DeviceError::Interrupted { port: self.link.name().into() }
    }

    /// Sends a command and waits for its outcome. Tries again while the board is busy.
    pub(super) fn try_request(&mut self, command: Command) -> Result<Result<Accepted, Refusal>, DeviceError> {
        let mut busy_until = None;
        let deadline = self.link.now() + REQUEST_TIMEOUT;
        loop {
            let outcome = self.try_request_once(command, deadline)?;
            let now = self.link.now();
            let busy_until = *busy_until.get_or_insert(now + ANSWER_TIMEOUT);
            if outcome != Err(Refusal::Busy) || now + BUSY_RETRY_AFTER >= busy_until {
                return Ok(outcome);
            }
            self.receive_until(now + BUSY_RETRY_AFTER, name_of(&command))?;
        }
    }

    fn try_request_once(
        &mut self,
        command: Command,
        last_deadline: Duration,
    ) -> Result<Result<Accepted, Refusal>, DeviceError> {
        let started = self.link.now();
        // The time at which bytes last left the line towards the board, until the request itself left.
        let (mut moved_at, mut settled, mut arrived) = (started, self.credit.settled(), false);
        let mut sent_at = None;
        self.awaited.clear();
        self.answer = None;
        loop {
            let now = self.link.now();
            if self.credit.settled() > settled && !arrived {
                (moved_at, settled) = (now, self.credit.settled());
                arrived = self.awaited.first().is_some_and(|first| first.end <= settled);
            }
            let waited = now.saturating_sub(started);
            let deadline = last_deadline.min(moved_at + ANSWER_TIMEOUT);
            if now >= last_deadline {
                return Err(DeviceError::TooSlow { port: self.link.name().into(), command: name_of(&command), waited });
            }
            if now >= deadline {
                return Err(self.silent(name_of(&command), waited));
            }
            let watch_in = self.watch(&Waiting { command: name_of(&command), waited, waited_max: REQUEST_TIMEOUT })?;
            let send_at = sent_at.map_or(now, |sent_at: Duration| sent_at.max(moved_at) + REPEAT_AFTER);
            if now >= send_at && self.send(command)? {
                sent_at = Some(now);
            }
            let send_at = sent_at.map_or(deadline, |sent_at| sent_at.max(moved_at) + REPEAT_AFTER);
            let wake_at = if send_at > now { send_at.min(deadline) } else { deadline };
            self.receive(wake_at.saturating_sub(now).min(watch_in), name_of(&command))?;
            if let Some(answer) = self.answer.take() {
                self.repeated = self.awaited.first().is_some_and(|first| first.sequence != answer.sequence);
                self.awaited.clear();
                let outcome = self.outcome(command, &answer);
                if outcome.is_ok() {
                    self.check_state(&command, answer.state)?;
                }
                return Ok(outcome);
            }
        }
    }

    /// Sends a request if there is credit for it.
    fn send(&mut self, command: Command) -> Result<bool, DeviceError> {
        let mut sequence = self.sequence.wrapping_add(1);
        while sequence == UNAWAITED || PING_SEQUENCES.contains(&sequence) {
            sequence = sequence.wrapping_add(1);
        }
        let frame = frame_of(sequence, command)?;
        if !self.credit.allows(frame.len(), PING_RESERVE_LEN, self.link.written().bytes) {
            return Ok(false);
        }
        self.sequence = sequence;
        let end = self.write(&frame, name_of(&command))?;
        self.awaited.push(Awaited { sequence, end });
        Ok(true)
    }

    /// The outcome of a command. A resent command may be refused if the board executed the first copy, and only its
    /// answer was lost.
    fn outcome(&self, command: Command, answer: &Answer) -> Result<Accepted, Refusal> {
        match answer.outcome {
            Err(Refusal::WrongState(state)) if self.repeated && state_after(&command) == Some(state) => {
                Ok(Accepted::Done)
            }
            outcome => outcome,
        }
    }

    /// Compares the state in the answer with the state that the accepted command results in.
    fn check_state(&self, command: &Command, found: State) -> Result<(), DeviceError> {
        match state_after(command) {
            Some(expected) if expected != found => Err(DeviceError::WrongState {
                port: self.link.name().into(),
                command: name_of(command),
                found,
                expected,
            }),
            _ => Ok(()),
        }
    }

    /// Sends a bulk frame if there is credit for it, and returns the position of its end.
    pub(super) fn send_bulk(&mut self, frame: &[u8], doing: &'static str) -> Result<Option<u64>, DeviceError> {
        if !self.credit.allows(frame.len(), RESERVE_LEN, self.link.written().bytes) {
            return Ok(None);
        }
        self.write(frame, doing).map(Some)
    }

    fn write(&mut self, frame: &[u8], doing: &'static str) -> Result<u64, DeviceError> {
        self.link.write(frame).map_err(|closed| vanished(closed, doing))
    }

    fn silent(&self, command: &'static str, waited: Duration) -> DeviceError {
        DeviceError::Silent { port: self.link.name().into(), command, waited }
    }
}

fn vanished(closed: LinkClosed, command: &'static str) -> DeviceError {
    DeviceError::Vanished { command, closed }
}
