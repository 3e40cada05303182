//! `--control`: lines on standard input that change the scene while it plays.

use std::fmt::{self, Display};
use std::io::stdin;
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, RecvTimeoutError, sync_channel};
use std::thread;
use std::time::Duration;

use frixel::input;
use frixel::player::{PlayError, Player};
use frixel::rigs::RecordedLink;
use frixel_driver::{ControlLine, DeviceError};
use frixel_scene::{LayerChange, LiveError, LiveLayers, Program};

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
    /// Time of the play before which no line is carried out, s.
    resume_at_s: f64,
    /// On the clock of the play.
    layers: LiveLayers,
}

/// The cause of a change of the scene, as messages name it.
#[derive(Clone, Debug)]
enum Origin {
    /// A line, by its number.
    Line(u32),
    /// The end of a trigger of a layer, by its title.
    TriggerEnd(String),
}

impl Display for Origin {
    fn fmt(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Line(number) => write!(formatter, "line {number} of standard input"),
            Self::TriggerEnd(layer) => write!(formatter, "the end of the trigger of {layer}"),
        }
    }
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

    /// Carries out the lines that have arrived at time `t_s` of the play. Calls `say` with what is refused or clamped,
    /// a sentence each.
    pub(super) fn step<L: RecordedLink>(
        &mut self,
        player: &mut Player<L>,
        program: &Program,
        t_s: f64,
        say: &mut dyn FnMut(String),
    ) -> Result<Next, PlayError> {
        let now = Duration::try_from_secs_f64(t_s).unwrap_or_default();
        while let Some(change) = self.layers.end_trigger(now) {
            let title = program.titles.get(usize::from(change.record)).cloned().unwrap_or_default();
            send(player, &change, &Origin::TriggerEnd(title), say)?;
        }
        while t_s >= self.resume_at_s {
            let Some(line) = self.next_line() else { return Ok(Next::GoOn) };
            self.lines_read += 1;
            let origin = Origin::Line(self.lines_read);
            match ControlLine::parse(&line) {
                Ok(None) => {}
                Ok(Some(ControlLine::Quit)) => return Ok(Next::Quit),
                Ok(Some(ControlLine::Replace { file })) => return Ok(Next::Replace(file.into())),
                Ok(Some(ControlLine::Wait { duration_s })) => self.resume_at_s = t_s + duration_s,
                Ok(Some(ControlLine::Layer { layer, on, gain })) => {
                    let change = self.layers.change(program, &layer, on, gain);
                    carry_out(player, change, &origin, say)?;
                }
                Ok(Some(ControlLine::Trigger { layer, duration_s })) => {
                    let change = self.layers.trigger(program, &layer, now, duration_s);
                    carry_out(player, change, &origin, say)?;
                }
                Err(error) => say(format!("{origin}: {error}")),
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

/// Sends a change to the board, or says why it is refused.
fn carry_out<L: RecordedLink>(
    player: &mut Player<L>,
    change: Result<LayerChange, LiveError>,
    origin: &Origin,
    say: &mut dyn FnMut(String),
) -> Result<(), PlayError> {
    match change {
        Ok(change) => send(player, &change, origin, say),
        Err(error) => {
            say(format!("{origin}: {error}"));
            Ok(())
        }
    }
}

/// Sends a change to the board. Says what is clamped, and why if the board refuses the change.
fn send<L: RecordedLink>(
    player: &mut Player<L>,
    change: &LayerChange,
    origin: &Origin,
    say: &mut dyn FnMut(String),
) -> Result<(), PlayError> {
    if let Some(notice) = change.notice() {
        say(format!("{origin}: {notice}"));
    }
    let LayerChange { record, setting, .. } = *change;
    match player.set_layer(record, setting.on, setting.gain) {
        Err(PlayError::Device(refused @ DeviceError::Refused { .. })) => {
            say(format!("{origin}: {refused}"));
            Ok(())
        }
        outcome => outcome,
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;
    use std::ops::ControlFlow;

    use frixel::rigs::SimLink;
    use frixel_driver::Device;
    use frixel_felt::recorder::Recorder;
    use frixel_hil_sim::{BoardMemory, Rig, RigConfig, Stroke};
    use frixel_scene::{Scene, compile};

    use super::*;

    fn program(live: bool) -> Program {
        let text = format!(
            "version = 2\n[[layer]]\nname = \"ping\"\nkind = \"constant\"\nfriction_fraction = 0.5\nlive = {live}\n"
        );
        let scene = Scene::parse(&text, "test.toml", &BTreeMap::new()).unwrap();
        let board = RigConfig::default().board;
        compile(&scene, &board.limits, board.tick_hz).unwrap()
    }

    /// The board refuses to change a layer that is not live in the scene that it plays.
    #[test]
    fn the_end_of_a_trigger_that_is_refused_is_not_blamed_on_a_line() {
        let (config, mut memory) = (RigConfig::default(), BoardMemory::new());
        let (limits, tick_hz) = (config.board.limits, config.board.tick_hz);
        let playing = program(false);
        let rig = Rig::new(&mut memory, &config, Stroke::sweep(0.12, 0.08, 1.0).unwrap(), 1).unwrap();
        let recorder = Recorder::new(&playing, &limits, tick_hz, u64::MAX, 40).unwrap();
        let device = Device::connect(SimLink::new(rig, Recorder::idle())).unwrap();
        let mut player = Player::new(device, recorder);
        player.start(&playing, 0, &mut |_| ControlFlow::Continue(())).unwrap();

        let (sender, lines) = sync_channel(LINES_AHEAD);
        for line in ["layer ping off", "trigger ping 50", "# nothing"] {
            sender.send(line.to_owned()).unwrap();
        }
        let live = program(true);
        let (layers, interrupt) = (LiveLayers::new(&live), Interrupt::default());
        let mut control = Control { lines, waits: false, interrupt, lines_read: 0, resume_at_s: 0.0, layers };
        let mut said = Vec::new();
        for t_s in [0.01, 0.1] {
            control.step(&mut player, &live, t_s, &mut |sentence| said.push(sentence)).unwrap();
        }
        let origins: Vec<&str> = said.iter().filter_map(|sentence| Some(sentence.split_once(": ")?.0)).collect();
        let trigger_end = "the end of the trigger of layer 1 \"ping\"";
        assert_eq!(origins, ["line 1 of standard input", "line 2 of standard input", trigger_end], "{said:?}");
    }
}
