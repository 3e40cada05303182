//! `--control`: lines on standard input that change the scene while it plays.

use std::io::stdin;
use std::sync::mpsc::{Receiver, RecvTimeoutError, sync_channel};
use std::thread;
use std::time::Duration;

use crate::commands::error::reading;
use crate::input;
use crate::rigs::RecordedLink;
use anyhow::Result;
use frixel_play::{Next, PlayError, Player};

use super::Interrupt;

/// Longest time between two looks at standard input.
const LOOK_PERIOD: Duration = Duration::from_millis(5);
/// Longest time between two looks for Ctrl-C while the play waits for a line.
const INTERRUPT_PERIOD: Duration = Duration::from_millis(50);
/// Lines that are read ahead of the play.
const LINES_AHEAD: usize = 64;

/// Carries out the lines on standard input.
pub(super) struct Control {
    input: Input,
    lines: frixel_play::Control,
}

/// The lines on standard input.
struct Input {
    lines: Receiver<String>,
    /// Whether the play waits for a line, because time is virtual.
    waits: bool,
    interrupt: Interrupt,
}

impl Control {
    /// Reads standard input from now on, in a thread of its own.
    pub(super) fn start(waits: bool, interrupt: &Interrupt) -> Result<Self> {
        let (sender, lines) = sync_channel(LINES_AHEAD);
        let read = move || {
            let mut input = stdin().lock();
            while let Some(line) = input::next_line(&mut input) {
                if sender.send(line).is_err() {
                    return;
                }
            }
        };
        let thread = thread::Builder::new().name("frixel-control".into()).spawn(read);
        thread.map_err(reading("standard input".as_ref()))?;
        let input = Input { lines, waits, interrupt: interrupt.clone() };
        let lines = if waits { frixel_play::Control::keeping_lines() } else { frixel_play::Control::default() };
        Ok(Self { input, lines })
    }

    /// The lines so far, as a recording has them; `None` where time does not wait for them.
    pub(super) fn kept(&self) -> Option<&[String]> {
        self.lines.kept()
    }

    /// Keeps a line that has put a scene on the board: that of this number among the later ones of the recording.
    pub(super) fn keep_replace(&mut self, number: usize) {
        self.lines.keep_replace(number);
    }

    /// Longest time that the play may go on at time `t_s` without a look at the lines.
    pub(super) fn time_max(&self, t_s: f64) -> Duration {
        let until_next = self.lines.time_max(t_s);
        if self.input.waits { until_next } else { until_next.min(LOOK_PERIOD) }
    }

    /// Number of the line that still waits at time `t_s` of the play, if one does.
    pub(super) fn waiting_line(&self, t_s: f64) -> Option<u32> {
        self.lines.waiting_line(t_s)
    }

    /// Carries out the lines that have arrived at time `t_s` of the play. Calls `say` with what is refused or clamped,
    /// a sentence each.
    pub(super) fn step<L: RecordedLink>(
        &mut self,
        player: &mut Player<L>,
        t_s: f64,
        say: &mut dyn FnMut(String),
    ) -> Result<Next, PlayError> {
        let Self { input, lines } = self;
        lines.step(player, t_s, &mut || input.next_line(), say)
    }
}

impl Input {
    fn next_line(&self) -> Option<String> {
        while self.waits && !self.interrupt.is_requested() {
            match self.lines.recv_timeout(INTERRUPT_PERIOD) {
                Ok(line) => return Some(line),
                Err(RecvTimeoutError::Disconnected) => return None,
                Err(RecvTimeoutError::Timeout) => {}
            }
        }
        self.lines.try_recv().ok()
    }
}
