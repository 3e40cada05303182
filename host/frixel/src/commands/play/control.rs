//! `--control`: lines on standard input that change the scene while it plays.

use std::io::{BufRead, stdin};
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

use frixel::player::{PlayError, Player};
use frixel::rigs::RecordedLink;
use frixel_driver::{ControlLine, DeviceError};
use frixel_scene::Program;

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
    /// Layers to switch off, and when, in s.
    triggered: Vec<(u8, f64)>,
    /// Whether each record is on, and its gain.
    settings: Vec<(bool, f32)>,
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
        let (settings, interrupt) = (settings(program), interrupt.clone());
        Ok(Self { lines, waits, interrupt, lines_read: 0, resume_at_s: 0.0, triggered: Vec::new(), settings })
    }

    /// Continues with another program, all of whose layers are on.
    pub(super) fn replace(&mut self, program: &Program) {
        self.settings = settings(program);
        self.triggered.clear();
    }

    /// Longest time that the play may go on at time `t_s` without a look at the lines.
    pub(super) fn time_max(&self, t_s: f64) -> Duration {
        let waited_for = self.triggered.iter().map(|(_, off_at_s)| *off_at_s).chain([self.resume_at_s]);
        let next_s = waited_for.filter(|at_s| *at_s > t_s).fold(f64::INFINITY, f64::min);
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
        while let Some(index) = self.triggered.iter().position(|(_, off_at_s)| *off_at_s <= t_s) {
            let (layer, _) = self.triggered.swap_remove(index);
            self.set(player, layer, Some(false), None)?;
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
                    if let Some(layer) = self.layer(program, &layer) {
                        self.set(player, layer, on, gain)?;
                    }
                }
                Ok(Some(ControlLine::Trigger { layer, duration_s })) => {
                    if let Some(layer) = self.layer(program, &layer) {
                        self.set(player, layer, Some(true), None)?;
                        self.triggered.retain(|(triggered, _)| *triggered != layer);
                        self.triggered.push((layer, t_s + duration_s));
                    }
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

    /// The record of a layer. Prints the reason if the scene has no such layer.
    fn layer(&self, program: &Program, name: &str) -> Option<u8> {
        program.layers.record(name).map_err(|error| self.say(error)).ok()
    }

    /// Changes a layer. Says why if the board refuses it.
    fn set<L: RecordedLink>(
        &mut self,
        player: &mut Player<L>,
        layer: u8,
        on: Option<bool>,
        gain: Option<f32>,
    ) -> Result<(), PlayError> {
        let Some(setting) = self.settings.get_mut(usize::from(layer)) else { return Ok(()) };
        *setting = (on.unwrap_or(setting.0), gain.unwrap_or(setting.1));
        match player.set_layer(layer, setting.0, setting.1) {
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

fn settings(program: &Program) -> Vec<(bool, f32)> {
    program.records.iter().map(|record| (true, record.gain)).collect()
}
