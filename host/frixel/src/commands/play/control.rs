//! `--control`: lines on standard input that change the scene while it plays.

use std::io::{BufRead, stdin};
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

use frixel::player::{PlayError, Player};
use frixel::rigs::RecordedLink;
use frixel_driver::{ControlLine, DeviceError};
use frixel_scene::{LayerChange, LiveError, LiveLayers, Program};

use super::{CommandError, Interrupt, note};

/// Longest time between two looks at standard input.
const LOOK_PERIOD: Duration = Duration::from_millis(5);
/// Shortest step, less than a tick: without it, a time that is rounded down would never be reached.
const STEP_MIN: Duration = Duration::from_micros(10);
/// Longest time between two looks for Ctrl-C while the play waits for a line.
const INTERRUPT_PERIOD: Duration = Duration::from_millis(50);

/// Carries out the lines on standard input.
pub(super) struct Control {
    lines: Receiver<String>,
    /// Whether the play waits for a line, because time is virtual.
    waits: bool,
    interrupt: Interrupt,
    lines_read: u32,
    /// Time of the play before which no line is carried out, s.
    resume_at_s: f64,
    /// On the clock of the play.
    layers: LiveLayers,
}

/// What the play does next.
pub(super) enum Next {
    GoOn,
    Replace(PathBuf),
    Quit,
}

impl Control {
    /// Reads standard input from now on, in a thread of its own.
    pub(super) fn start(program: &Program, waits: bool, interrupt: &Interrupt) -> Result<Self, CommandError> {
        let (sender, lines) = channel();
        let read = move || {
            for line in stdin().lock().lines().map_while(Result::ok) {
                if sender.send(line).is_err() {
                    return;
                }
            }
        };
        let thread = thread::Builder::new().name("frixel-control".into()).spawn(read);
        thread.map_err(CommandError::reading("standard input".as_ref()))?;
        let (layers, interrupt) = (LiveLayers::new(program), interrupt.clone());
        Ok(Self { lines, waits, interrupt, lines_read: 0, resume_at_s: 0.0, layers })
    }

    /// Continues with another program, all of whose layers are on.
    pub(super) fn replace(&mut self, program: &Program) {
        self.layers = LiveLayers::new(program);
    }

    /// The layers that are off, by their index from the bottom.
    pub(super) fn layers_off(&self) -> Vec<usize> {
        self.layers.off()
    }

    /// Longest time that the play may go on at time `t_s` without a look at the lines.
    pub(super) fn time_max(&self, t_s: f64) -> Duration {
        let ends_at_s = self.layers.next_end().map(|ends_at| ends_at.as_secs_f64());
        let next_s =
            ends_at_s.into_iter().chain([self.resume_at_s]).filter(|at_s| *at_s > t_s).fold(f64::INFINITY, f64::min);
        let until_next = Duration::try_from_secs_f64(next_s - t_s).unwrap_or(Duration::MAX).max(STEP_MIN);
        if self.waits { until_next } else { until_next.min(LOOK_PERIOD) }
    }

    /// Carries out the lines that have arrived at time `t_s` of the play.
    pub(super) fn step<L: RecordedLink>(
        &mut self,
        player: &mut Player<L>,
        program: &Program,
        t_s: f64,
    ) -> Result<Next, PlayError> {
        let now = Duration::try_from_secs_f64(t_s).unwrap_or_default();
        while let Some(change) = self.layers.end_trigger(now) {
            self.send(player, &change)?;
        }
        while t_s >= self.resume_at_s {
            let Some(line) = self.next_line() else { return Ok(Next::GoOn) };
            self.lines_read += 1;
            match ControlLine::parse(&line) {
                Ok(None) => {}
                Ok(Some(ControlLine::Quit)) => return Ok(Next::Quit),
                Ok(Some(ControlLine::Replace { file })) => return Ok(Next::Replace(file.into())),
                Ok(Some(ControlLine::Wait { duration_s })) => self.resume_at_s = t_s + duration_s,
                Ok(Some(ControlLine::Layer { layer, on, gain })) => {
                    let change = self.layers.change(program, &layer, on, gain);
                    self.carry_out(player, change)?;
                }
                Ok(Some(ControlLine::Trigger { layer, duration_s })) => {
                    let change = self.layers.trigger(program, &layer, now, duration_s);
                    self.carry_out(player, change)?;
                }
                Err(error) => self.say(error),
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

    /// Sends a change to the board, or prints why it is refused.
    fn carry_out<L: RecordedLink>(
        &mut self,
        player: &mut Player<L>,
        change: Result<LayerChange, LiveError>,
    ) -> Result<(), PlayError> {
        match change {
            Ok(change) => self.send(player, &change),
            Err(error) => {
                self.say(error);
                Ok(())
            }
        }
    }

    /// Sends a change to the board. Says what is clamped, and why if the board refuses the change.
    fn send<L: RecordedLink>(&mut self, player: &mut Player<L>, change: &LayerChange) -> Result<(), PlayError> {
        if let Some(notice) = change.notice() {
            self.say(notice);
        }
        let LayerChange { record, setting, .. } = *change;
        match player.set_layer(record, setting.on, setting.gain) {
            Err(PlayError::Device(refused @ DeviceError::Refused { .. })) => {
                self.say(refused);
                Ok(())
            }
            outcome => outcome,
        }
    }

    fn say(&self, error: impl std::fmt::Display) {
        note(format_args!("frixel: line {} of standard input: {error}", self.lines_read));
    }
}
