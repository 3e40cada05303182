//! What a board says: answers, progress, events, and its silence.

use std::time::Duration;

use frixel_wire::message::{Command, FromBoard};
use frixel_wire::payload::Payload;

use super::super::Event;
use super::super::command::name_of;
use super::super::error::DeviceError;
use super::super::link::Link;
use super::{ANSWER_TIMEOUT, Exchange, vanished};

/// Most that one listening adds to the silence of a board, so that a host that was itself suspended does not take that for silence.
const LISTEN_MAX: Duration = Duration::from_millis(100);
/// What is under way while nothing is asked.
const WAITING: &str = "wait";
/// Events kept for a caller who does not fetch them; the oldest go first.
const EVENTS_MAX: usize = 4096;

/// What the board said last of a stream.
#[derive(Clone, Copy, Debug)]
pub(in super::super) struct StreamReport {
    /// Index behind the last sample that the board has room for.
    pub(in super::super) limit: u32,
    /// Times that a stream ran dry, and gaps in one, since the board's power-on.
    pub(in super::super) underruns: u32,
    pub(in super::super) gaps: u32,
}

impl<L: Link> Exchange<L> {
    /// Takes the first that comes within `wait`, or less. An error when the pings have not been answered for too long.
    pub(in super::super) fn listen(&mut self, wait: Duration) -> Result<(), DeviceError> {
        self.receive(wait.min(LISTEN_MAX), WAITING)?;
        if self.quiet >= ANSWER_TIMEOUT {
            return Err(self.silent(name_of(&Command::Ping), self.quiet));
        }
        Ok(())
    }

    /// Takes what comes until `until`.
    pub(super) fn receive_until(&mut self, until: Duration, doing: &'static str) -> Result<(), DeviceError> {
        loop {
            let now = self.link.now();
            if now >= until {
                return Ok(());
            }
            self.receive(until.saturating_sub(now), doing)?;
        }
    }

    /// Takes what has come, or the first that comes within `wait`.
    pub(in super::super) fn receive(&mut self, wait: Duration, doing: &'static str) -> Result<(), DeviceError> {
        let mut incoming = std::mem::take(&mut self.incoming);
        incoming.clear();
        let started = self.link.now();
        self.link.read(&mut incoming, wait).map_err(|closed| vanished(closed, doing))?;
        if incoming.is_empty() {
            self.quiet += self.link.now().saturating_sub(started).min(wait);
        } else {
            self.quiet = Duration::ZERO;
        }
        let mut input = incoming.as_slice();
        while let Some(payload) = self.decoder.next_frame(&mut input) {
            // Hellos and what this version does not know are none of a caller's business.
            if let Ok(Payload::FromBoard(message)) = Payload::parse_from_board(payload) {
                self.take(message, doing)?;
            }
        }
        self.incoming = incoming;
        Ok(())
    }

    fn take(&mut self, message: FromBoard, doing: &'static str) -> Result<(), DeviceError> {
        match message {
            FromBoard::Answer(answer) => {
                self.take_count(answer.received_bytes, doing)?;
                let awaited = self.awaited.iter().find(|one| one.sequence == answer.sequence);
                if let Some(awaited) = awaited {
                    self.credit.answered(awaited.end, self.link.written().bytes);
                    self.answer = Some(answer);
                    if std::mem::take(&mut self.stream_begins) {
                        self.stream = None;
                    }
                }
            }
            FromBoard::Progress { next_chunk, received_bytes } => {
                self.take_count(received_bytes, doing)?;
                self.next_chunk = Some(next_chunk);
            }
            FromBoard::StreamProgress { next_index, room, underruns, gaps, received_bytes } => {
                self.take_count(received_bytes, doing)?;
                let limit = next_index.wrapping_add(u32::from(room));
                self.stream = Some(StreamReport { limit, underruns, gaps });
            }
            FromBoard::Telemetry(telemetry) => self.keep(Event::Telemetry(telemetry)),
            FromBoard::StateChanged { state, fault, flags } => self.keep(Event::StateChanged { state, fault, flags }),
        }
        Ok(())
    }

    fn take_count(&mut self, received_bytes: u32, doing: &'static str) -> Result<(), DeviceError> {
        let written = self.link.written().bytes;
        self.credit
            .received(received_bytes, written)
            .map_err(|_| DeviceError::Restarted { port: self.link.name().into(), command: doing })
    }

    fn keep(&mut self, event: Event) {
        if self.events.len() == EVENTS_MAX {
            self.events.pop_front();
        }
        self.events.push_back(event);
    }
}
