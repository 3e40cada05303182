//! Log of the events of a board: changes of its state, and a silent host.

use frixel_wire::fault::{Flags, State};

/// Tracks the state of a board and keeps its changes in order of time.
#[derive(Clone, Debug)]
pub(crate) struct EventLog {
    state: State,
    host_silent: bool,
    events: Vec<BoardEvent>,
}

/// A change of the board's state, with its time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct BoardEvent {
    /// Time at which the change was observed, s.
    pub t_s: f64,
    /// Kind of the change.
    pub kind: EventKind,
}

/// Kind of a change.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum EventKind {
    /// The board entered this state.
    State(State),
    /// The board has not received a frame from its host for the scene's host timeout.
    HostSilent,
    /// A virtual board was too far behind the wall clock, and dropped time.
    TimeDropped,
}

impl EventKind {
    /// The name of the kind, for a column of a CSV file.
    pub(crate) fn name(self) -> &'static str {
        match self {
            Self::State(State::Disarmed) => "disarmed",
            Self::State(State::Armed) => "armed",
            Self::State(State::Active) => "active",
            Self::State(State::Faulted) => "faulted",
            Self::HostSilent => "host-silent",
            Self::TimeDropped => "time-dropped",
        }
    }
}

impl EventLog {
    /// Starts tracking a board that is in this state.
    pub(crate) fn new(state: State) -> Self {
        Self { state, host_silent: false, events: Vec::new() }
    }

    /// Compares a report of the board with the previous one, and logs the changes.
    pub(crate) fn observe(&mut self, t_s: f64, state: State, flags: Flags) {
        let host_silent = flags.contains(Flags::HOST_SILENT);
        let begins_silent = host_silent && !self.host_silent;
        if state != self.state {
            self.events.push(BoardEvent { t_s, kind: EventKind::State(state) });
        }
        if begins_silent {
            self.events.push(BoardEvent { t_s, kind: EventKind::HostSilent });
        }
        (self.state, self.host_silent) = (state, host_silent);
    }

    /// Removes the logged events and returns them.
    pub(crate) fn take_events(&mut self) -> Vec<BoardEvent> {
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
            log.observe(t_s, state, flags);
        }
        let events: Vec<_> = log.take_events().iter().map(|event| (event.t_s, event.kind.name())).collect();
        let expected = [(2.0, "armed"), (3.0, "active"), (5.0, "disarmed"), (5.0, "host-silent"), (7.0, "armed")];
        assert_eq!(events, expected);
        assert!(log.take_events().is_empty());
    }
}
