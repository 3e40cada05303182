//! What happened to a board, apart from the friction: changes of its state, and a host that fell silent.

use frixel_wire::fault::{Fault, Flags, State};
use thiserror::Error;

/// Follows a board's state, and keeps what changed, in the order of time.
#[derive(Clone, Debug)]
pub struct EventLog {
    state: State,
    host_silent: bool,
    stop_reason: Option<StopReason>,
    events: Vec<BoardEvent>,
}

/// A change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoardEvent {
    /// When it was seen, s.
    pub t_s: f64,
    /// What changed.
    pub kind: EventKind,
}

/// What can change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EventKind {
    /// The board went to this state.
    State(State),
    /// The board has not heard from its host for the scene's host timeout.
    HostSilent,
}

/// Why a board stopped without a command.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Error)]
pub enum StopReason {
    /// A fault is latched.
    #[error("stopped with its output at zero: {0}")]
    Fault(Fault),
    /// The host was silent for too long.
    #[error("stopped with its output at zero: it had not heard from this host for the scene's host timeout")]
    HostSilent,
}

impl EventKind {
    /// A word for a column.
    pub fn name(self) -> &'static str {
        match self {
            Self::State(State::Disarmed) => "disarmed",
            Self::State(State::Armed) => "armed",
            Self::State(State::Active) => "active",
            Self::State(State::Faulted) => "faulted",
            Self::HostSilent => "host-silent",
        }
    }
}

impl EventLog {
    /// Follows a board from this state on.
    pub fn new(state: State) -> Self {
        Self { state, host_silent: false, stop_reason: None, events: Vec::new() }
    }

    /// Takes what a board reports at a time, and keeps what differs from the report before.
    pub fn observe(&mut self, t_s: f64, state: State, fault: Option<Fault>, flags: Flags) {
        let host_silent = flags.contains(Flags::HOST_SILENT);
        let begins_silent = host_silent && !self.host_silent;
        if state != self.state {
            self.events.push(BoardEvent { t_s, kind: EventKind::State(state) });
        }
        if begins_silent {
            self.events.push(BoardEvent { t_s, kind: EventKind::HostSilent });
        }
        self.stop_reason = match fault {
            Some(fault) => Some(StopReason::Fault(fault)),
            None if host_silent => Some(StopReason::HostSilent),
            None => None,
        };
        (self.state, self.host_silent) = (state, host_silent);
    }

    /// Why the board stands still, if it stopped without a command.
    pub fn stop_reason(&self) -> Option<StopReason> {
        self.stop_reason
    }

    /// Removes the events so far and returns them.
    pub fn take_events(&mut self) -> Vec<BoardEvent> {
        std::mem::take(&mut self.events)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_change_is_one_event() {
        let mut log = EventLog::new(State::Disarmed);
        let silent = Flags::HOST_SILENT;
        for (t_s, state, flags) in [
            (1.0, State::Disarmed, Flags::default()),
            (2.0, State::Armed, Flags::default()),
            (3.0, State::Active, Flags::STILL),
            (4.0, State::Active, Flags::default()),
            (5.0, State::Disarmed, silent),
            (6.0, State::Disarmed, silent),
            (7.0, State::Armed, Flags::default()),
        ] {
            log.observe(t_s, state, None, flags);
        }
        let events: Vec<_> = log.take_events().iter().map(|event| (event.t_s, event.kind.name())).collect();
        let expected = [(2.0, "armed"), (3.0, "active"), (5.0, "disarmed"), (5.0, "host-silent"), (7.0, "armed")];
        assert_eq!(events, expected);
        assert!(log.take_events().is_empty());
    }

    #[test]
    fn a_board_that_stopped_by_itself_says_why() {
        let mut log = EventLog::new(State::Active);
        assert_eq!(log.stop_reason(), None);
        log.observe(1.0, State::Disarmed, None, Flags::HOST_SILENT);
        assert_eq!(log.stop_reason(), Some(StopReason::HostSilent));
        log.observe(2.0, State::Faulted, Some(Fault::Deadline), Flags::HOST_SILENT);
        assert_eq!(log.stop_reason(), Some(StopReason::Fault(Fault::Deadline)));
    }
}
