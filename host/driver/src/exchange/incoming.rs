//! Receives the board's messages: answers, progress and events. Detects a board that has stopped answering.

use std::time::Duration;

use frixel_wire::message::{Command, FromBoard, Telemetry};
use frixel_wire::payload::Payload;

use super::super::Event;
use super::super::command::name_of;
use super::super::error::DeviceError;
use super::super::link::Link;
use super::{ANSWER_TIMEOUT, Exchange, vanished};

/// Largest contribution of one read to the measured silence of a board, so that a suspended host does not count its own
/// pause.
const LISTEN_MAX: Duration = Duration::from_millis(100);
/// The name of waiting in error messages.
const WAITING: &str = "wait";
/// Largest number of stored events; the oldest are dropped first.
const EVENTS_MAX: usize = 4096;

/// A board's report on its stream.
#[derive(Clone, Copy, Debug)]
pub(in super::super) struct StreamReport {
    /// Index after the last sample that the board has room for.
    pub(in super::super) limit: u32,
    /// Underruns since the board's power-on.
    pub(in super::super) underruns: u32,
    /// Runs of samples that were lost, since the board's power-on.
    pub(in super::super) gaps: u32,
}

impl<L: Link> Exchange<L> {
    /// Receives for at most `wait`. Returns an error if the board has not answered pings for too long.
    pub(in super::super) fn listen(&mut self, wait: Duration) -> Result<(), DeviceError> {
        self.receive(wait.min(LISTEN_MAX), WAITING)?;
        if self.quiet >= ANSWER_TIMEOUT {
            return Err(self.silent(name_of(&Command::Ping), self.quiet));
        }
        Ok(())
    }

    /// Receives until the time `until`.
    pub(super) fn receive_until(&mut self, until: Duration, doing: &'static str) -> Result<(), DeviceError> {
        loop {
            let now = self.link.now();
            if now >= until {
                return Ok(());
            }
            self.receive(until.saturating_sub(now), doing)?;
        }
    }

    /// Handles the messages that have arrived, or the first that arrive within `wait`.
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
            // Ignore hellos, and messages unknown to this version.
            if let Ok(Payload::FromBoard(message)) = Payload::parse_from_board(payload) {
                self.handle(message, doing)?;
            }
        }
        self.incoming = incoming;
        Ok(())
    }

    fn handle(&mut self, message: FromBoard, doing: &'static str) -> Result<(), DeviceError> {
        match message {
            FromBoard::Answer(answer) => {
                self.update_credit(answer.received_bytes, doing)?;
                let awaited = self.awaited.iter().find(|one| one.sequence == answer.sequence);
                let written = self.link.written();
                // Lost chunks take up credit until then; this ends an upload without progress.
                if !self.awaited.is_empty() && written.last_ping == Some(answer.sequence) {
                    self.credit.answered(written.bytes, written.bytes);
                }
                if let Some(awaited) = awaited {
                    self.credit.answered(awaited.end, written.bytes);
                    self.answer = Some(answer);
                    if std::mem::take(&mut self.stream_begins) {
                        self.stream = None;
                    }
                }
            }
            FromBoard::Progress { next_chunk, received_bytes } => {
                self.update_credit(received_bytes, doing)?;
                self.next_chunk = Some(next_chunk);
            }
            FromBoard::StreamProgress { next_index, room, underruns, gaps, received_bytes } => {
                self.update_credit(received_bytes, doing)?;
                let limit = next_index.wrapping_add(u32::from(room));
                self.stream = Some(StreamReport { limit, underruns, gaps });
            }
            FromBoard::Telemetry(telemetry) => self.take_telemetry(telemetry)?,
            FromBoard::StateChanged { state, fault, flags } => {
                self.push_event(Event::StateChanged { state, fault, flags });
            }
        }
        Ok(())
    }

    fn update_credit(&mut self, received_bytes: u32, doing: &'static str) -> Result<(), DeviceError> {
        let written = self.link.written().bytes;
        self.credit
            .received(received_bytes, written)
            .map_err(|_| DeviceError::Restarted { port: self.link.name().into(), command: doing })
    }

    /// Stores telemetry. Ignores a second message of the same tick.
    fn take_telemetry(&mut self, telemetry: Telemetry) -> Result<(), DeviceError> {
        let before = self.telemetry_tick.replace(telemetry.tick);
        let passed = before.map(|last_tick| telemetry.tick.wrapping_sub(last_tick) as i32);
        match (before, passed) {
            (Some(_), Some(0)) => return Ok(()),
            (Some(last_tick), Some(passed)) if passed < 0 => {
                let (port, tick) = (self.link.name().into(), telemetry.tick);
                return Err(DeviceError::TelemetryBackwards { port, last_tick, tick });
            }
            _ => {}
        }
        self.push_event(Event::Telemetry(telemetry));
        Ok(())
    }

    fn push_event(&mut self, event: Event) {
        if self.events.len() == EVENTS_MAX {
            self.events.pop_front();
        }
        self.events.push_back(event);
    }
}
