//! The states that a board has reported to its host.

use frixel_wire::fault::{Fault, State};
use frixel_wire::frame::Decoder;
use frixel_wire::message::FromBoard;
use frixel_wire::payload::Payload;

/// State and fault of a board, at each change.
#[derive(Default)]
pub(super) struct StateHistory {
    decoder: Decoder,
    history: Vec<(u64, State, Option<Fault>)>,
}

impl StateHistory {
    /// Takes bytes that have arrived at the host at a tick.
    pub(super) fn hear(&mut self, bytes: &[u8], tick: u64) {
        let mut input = bytes;
        while let Some(frame) = self.decoder.next_frame(&mut input) {
            let (state, fault) = match Payload::parse_from_board(frame) {
                Ok(Payload::Hello(hello)) => (hello.state, hello.last_fault),
                Ok(Payload::FromBoard(FromBoard::Answer(answer))) => (answer.state, self.fault()),
                Ok(Payload::FromBoard(FromBoard::StateChanged { state, fault, .. })) => (state, fault),
                _ => continue,
            };
            let fault = fault.filter(|_| state == State::Faulted);
            if self.history.last().is_none_or(|(_, last, known)| (*last, *known) != (state, fault)) {
                self.history.push((tick, state, fault));
            }
        }
    }

    fn fault(&self) -> Option<Fault> {
        self.history.last().and_then(|(.., fault)| *fault)
    }

    /// The last report up to a tick, with its tick.
    pub(super) fn by(&self, tick: u64) -> Option<(u64, State, Option<Fault>)> {
        self.history.iter().rev().find(|(heard, ..)| *heard <= tick).copied()
    }

    /// All reports, for the timeline.
    pub(super) fn entries(&self) -> impl Iterator<Item = (u64, String)> {
        self.history.iter().map(|(tick, state, fault)| {
            let fault = fault.map_or_else(String::new, |fault| format!(" ({fault})"));
            (*tick, format!("the board reports: {state}{fault}"))
        })
    }
}
