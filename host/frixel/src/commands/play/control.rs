//! `--control`: lines on standard input that change the scene while it plays.

use std::io::stdin;
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, RecvTimeoutError, sync_channel};
use std::thread;
use std::time::Duration;

use crate::input;
use crate::rigs::RecordedLink;
use frixel_driver::ControlLine;
use frixel_play::{PlayError, Player};

use super::{CommandError, Interrupt};

/// Longest time between two looks at standard input.
const LOOK_PERIOD: Duration = Duration::from_millis(5);
/// Shortest step, less than a tick: without it, a time that is rounded down would never be reached.
const STEP_MIN: Duration = Duration::from_micros(10);
/// Longest time between two looks for Ctrl-C while the play waits for a line.
const INTERRUPT_PERIOD: Duration = Duration::from_millis(50);
/// Lines that are read ahead of the play.
const LINES_AHEAD: usize = 64;

/// Carries out the lines on standard input.
pub(super) struct Control {
    lines: Receiver<String>,
    /// Whether the play waits for a line, because time is virtual.
    waits: bool,
    interrupt: Interrupt,
    lines_read: u32,
    /// The lines so far that a recording has, so that they can be carried out again; none where time does not wait for
    /// them.
    kept: Vec<String>,
    /// Time of the play before which no line is carried out, s.
    resume_at_s: f64,
}

/// What the play does next.
pub(super) enum Next {
    GoOn,
    Replace(PathBuf),
    Quit,
}

impl Control {
    /// Reads standard input from now on, in a thread of its own.
    pub(super) fn start(waits: bool, interrupt: &Interrupt) -> Result<Self, CommandError> {
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
        thread.map_err(CommandError::reading("standard input".as_ref()))?;
        Ok(Self::of(lines, waits, interrupt))
    }

    /// Carries out the lines of a recording again, in virtual time.
    pub(super) fn of_recording(lines: Vec<String>, interrupt: &Interrupt) -> Self {
        let (sender, receiver) = sync_channel(lines.len());
        for line in lines {
            // There is room for all of them, and the receiver is there.
            let _ = sender.send(line);
        }
        Self::of(receiver, true, interrupt)
    }

    fn of(lines: Receiver<String>, waits: bool, interrupt: &Interrupt) -> Self {
        Self { lines, waits, interrupt: interrupt.clone(), lines_read: 0, kept: Vec::new(), resume_at_s: 0.0 }
    }

    /// The lines so far, as a recording has them; `None` where time does not wait for them.
    pub(super) fn kept(&self) -> Option<&[String]> {
        self.waits.then_some(&self.kept)
    }

    /// Keeps a line that has put a scene on the board: that of this number among the later ones of the recording.
    pub(super) fn keep_replace(&mut self, number: usize) {
        if self.waits {
            self.kept.push(format!("replace {number}"));
        }
    }

    /// Longest time that the play may go on at time `t_s` without a look at the lines.
    pub(super) fn time_max(&self, t_s: f64) -> Duration {
        let until_next_s = if self.resume_at_s > t_s { self.resume_at_s - t_s } else { f64::INFINITY };
        let until_next = Duration::try_from_secs_f64(until_next_s).unwrap_or(Duration::MAX).max(STEP_MIN);
        if self.waits { until_next } else { until_next.min(LOOK_PERIOD) }
    }

    /// Carries out the lines that have arrived at time `t_s` of the play. Calls `say` with what is refused or clamped,
    /// a sentence each.
    pub(super) fn step<L: RecordedLink>(
        &mut self,
        player: &mut Player<L>,
        t_s: f64,
        say: &mut dyn FnMut(String),
    ) -> Result<Next, PlayError> {
        while t_s >= self.resume_at_s {
            let Some(line) = self.next_line() else { return Ok(Next::GoOn) };
            self.lines_read += 1;
            let origin = format!("line {} of standard input", self.lines_read);
            let parsed = ControlLine::parse(&line);
            let is_kept = !matches!(parsed, Ok(None | Some(ControlLine::Replace { .. })) | Err(_));
            if self.waits && is_kept {
                self.kept.push(line);
            }
            let changed = match parsed {
                Ok(None) => continue,
                Ok(Some(ControlLine::Quit)) => return Ok(Next::Quit),
                Ok(Some(ControlLine::Replace { file })) => return Ok(Next::Replace(file.into())),
                Ok(Some(ControlLine::Wait { duration_s })) => {
                    self.resume_at_s = t_s + duration_s;
                    continue;
                }
                Ok(Some(ControlLine::Layer { layer, on, gain })) => player.change_layer(&layer, on, gain),
                Ok(Some(ControlLine::Trigger { layer, duration_s })) => player.trigger(&layer, duration_s),
                Err(error) => {
                    say(format!("{origin}: {error}"));
                    continue;
                }
            };
            match changed {
                Ok(change) => change.notice().into_iter().for_each(|notice| say(format!("{origin}: {notice}"))),
                Err(error) if error.is_refusal() => say(format!("{origin}: {error}")),
                Err(error) => return Err(error),
            }
        }
        Ok(Next::GoOn)
    }

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
