//! `--control`: lines on standard input that change the scene while it plays.

use std::io::{BufRead, stdin};
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

use frixel::player::{PlayError, Player};
use frixel::rigs::RecordedLink;
use frixel_driver::{ControlLine, DeviceError};
use frixel_layers::{Layer, Vibration};
use frixel_scene::{Clamped, LayerSetting, Program};
use thiserror::Error;

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
    /// The settings of each record.
    settings: Vec<LayerSetting>,
}

/// Why a line is not carried out, or not as it was meant.
#[derive(Debug, Error)]
enum ControlRefusal {
    /// The layer is on.
    #[error(
        "layer {layer:?} is on, and a trigger plays a layer that is off: switch it off first, by `layer {layer:?} off`"
    )]
    TriggerOn { layer: String },
    /// The layer may be silent for the whole trigger.
    #[error(
        "layer {layer:?} comes in bursts, one every {period_ms:.0} ms, so that a trigger of {duration_ms:.0} ms may be \
         silent: leave `burst` out in the file, or trigger it for {period_ms:.0} ms or more"
    )]
    TriggerBetweenBursts { layer: String, period_ms: f64, duration_ms: f64 },
    /// A gain leads out of reach.
    #[error("gain {gain} is refused: {clamped}{}", gain_advice(*.range))]
    GainOutOfReach { gain: f32, clamped: Clamped, range: Option<(f32, f32)> },
    /// Layers are out of reach now.
    #[error("{0}; it is clamped there")]
    Clamped(Clamped),
}

fn gain_advice(range: Option<(f32, f32)>) -> String {
    range.map_or(String::new(), |(least, most)| format!("; give a gain from {least} to {most}"))
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
                    if let Some(record) = self.layer(program, &layer) {
                        self.change(player, program, record, on, gain)?;
                    }
                }
                Ok(Some(ControlLine::Trigger { layer, duration_s })) => {
                    if let Some(record) = self.layer(program, &layer) {
                        match self.check_trigger(program, layer, record, duration_s) {
                            Ok(()) => {
                                self.set(player, record, Some(true), None)?;
                                self.triggered.retain(|(triggered, _)| *triggered != record);
                                self.triggered.push((record, t_s + duration_s));
                            }
                            Err(refusal) => self.say(refusal),
                        }
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

    /// Changes a layer, unless its gain leads out of reach in a scene that does not saturate. What a board would clamp
    /// is said.
    fn change<L: RecordedLink>(
        &mut self,
        player: &mut Player<L>,
        program: &Program,
        record: u8,
        on: Option<bool>,
        gain: Option<f32>,
    ) -> Result<(), PlayError> {
        let mut changed = self.settings.clone();
        if let Some(setting) = changed.get_mut(usize::from(record)) {
            *setting = LayerSetting { on: on.unwrap_or(setting.on), gain: gain.unwrap_or(setting.gain) };
        }
        let before = program.clamped_with(&self.settings);
        if let Some(clamped) = program.clamped_with(&changed).filter(|clamped| before.as_ref() != Some(clamped)) {
            match gain.filter(|_| !program.saturates && !program.is_draft()) {
                Some(gain) => {
                    let range = program.gains_in_reach(record, &changed);
                    self.say(ControlRefusal::GainOutOfReach { gain, clamped, range });
                    return Ok(());
                }
                None => self.say(ControlRefusal::Clamped(clamped)),
            }
        }
        if on.is_some() {
            // A layer that is switched by hand stays as it is when its trigger ends.
            self.triggered.retain(|(triggered, _)| *triggered != record);
        }
        self.set(player, record, on, gain)
    }

    /// Refuses a trigger that would leave a layer off that is on, or that may not be felt.
    fn check_trigger(
        &self,
        program: &Program,
        layer: String,
        record: u8,
        duration_s: f64,
    ) -> Result<(), ControlRefusal> {
        let is_on = self.settings.get(usize::from(record)).is_some_and(|setting| setting.on);
        let is_triggered = self.triggered.iter().any(|(triggered, _)| *triggered == record);
        if is_on && !is_triggered {
            return Err(ControlRefusal::TriggerOn { layer });
        }
        match program.records.get(usize::from(record)).map(|record| &record.layer) {
            Some(Layer::Vibration(Vibration { burst, .. })) if duration_s <= f64::from(burst.period_s - burst.on_s) => {
                let (period_ms, duration_ms) = (1e3 * f64::from(burst.period_s), 1e3 * duration_s);
                Err(ControlRefusal::TriggerBetweenBursts { layer, period_ms, duration_ms })
            }
            _ => Ok(()),
        }
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
        *setting = LayerSetting { on: on.unwrap_or(setting.on), gain: gain.unwrap_or(setting.gain) };
        match player.set_layer(layer, setting.on, setting.gain) {
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

fn settings(program: &Program) -> Vec<LayerSetting> {
    program.records.iter().map(|record| LayerSetting { on: true, gain: record.gain }).collect()
}
