//! The host of a scenario: a player over the line that carries out the commands of the scenario at their times.

use std::time::Duration;

use frixel_driver::{DeviceError, ignore_progress};
use frixel_hil_sim::BoardRig as _;
use frixel_play::{PlayError, Player, RigLink, connect, load};
use frixel_scene::{Action, Scenario, ScenarioCommand};
use frixel_wire::frame::FRAME_MAX_LEN;
use frixel_wire::payload::hello_request_frame;

use super::Programs;
use super::line::ScenarioLine;
use super::ticks_of;

/// A command that failed, or a connection that was lost.
pub(super) struct Failure {
    /// Line of the command; of the last one before a connection that was lost.
    pub(super) line: usize,
    pub(super) what: String,
    /// Tick on the rig's clock.
    pub(super) tick: u64,
    pub(super) sentence: String,
    /// Whether an expectation has these words.
    pub(super) is_expected: bool,
}

/// A board at the end of the scenario's line.
type ScenarioPlayer<'r> = Player<RigLink<'r>>;

pub(super) struct Host<'s, 'r> {
    scenario: &'s Scenario,
    programs: &'s Programs,
    line: ScenarioLine<'r>,
    player: Option<ScenarioPlayer<'r>>,
    pub(super) failures: Vec<Failure>,
    /// Line of the last command.
    last_line: usize,
}

/// Why a command is not carried out.
struct CommandFailure {
    sentence: String,
    /// Whether the host keeps its connection.
    goes_on: bool,
}

impl From<PlayError> for CommandFailure {
    fn from(error: PlayError) -> Self {
        Self { sentence: error.to_string(), goes_on: error.is_refusal() }
    }
}

impl From<DeviceError> for CommandFailure {
    fn from(error: DeviceError) -> Self {
        PlayError::from(error).into()
    }
}

impl<'s, 'r> Host<'s, 'r> {
    pub(super) fn new(scenario: &'s Scenario, programs: &'s Programs, line: ScenarioLine<'r>) -> Self {
        Self { scenario, programs, line, player: None, failures: Vec::new(), last_line: 1 }
    }

    /// Plays the scene, then carries out the scenario to its end.
    pub(super) fn run(&mut self) {
        let tick_hz = self.line.board().tick_hz;
        match self.connect() {
            Ok(()) => self.act(&Action::Play),
            Err(failure) => self.failed("the connection", failure),
        }
        self.line.begin_time();
        let mut commands: Vec<&ScenarioCommand> = self.scenario.commands.iter().collect();
        commands.sort_by_key(|command| ticks_of(command.at_ms, tick_hz));
        for command in commands {
            self.wait_until(ticks_of(command.at_ms, tick_hz));
            if self.line.has_ended() {
                break;
            }
            self.last_line = command.line;
            self.act(&command.action);
            self.line.named_event(command.name.as_deref());
        }
        self.wait_until(ticks_of(1e3 * self.scenario.seconds, tick_hz));
    }

    /// Performs an action, and records its outcome in the timeline.
    fn act(&mut self, action: &Action) {
        let verb = verb(action);
        self.line.note(verb);
        match self.perform(action) {
            Ok(()) => self.line.note(format!("{verb}: done")),
            Err(failure) => self.failed(&format!("`{verb}`"), failure),
        }
    }

    fn connect(&mut self) -> Result<(), CommandFailure> {
        self.player = Some(Player::new(connect(Box::new(self.line.clone()))?));
        Ok(())
    }

    /// Waits. A connected program keeps running meanwhile.
    fn wait_until(&mut self, ticks: u64) {
        while self.line.ticks() < ticks && !self.line.has_ended() {
            let left = Duration::from_secs(ticks - self.line.ticks()) / self.line.board().tick_hz;
            match &mut self.player {
                Some(player) => {
                    if let Err(error) = player.wait(left) {
                        self.failed("the connection", error.into());
                    }
                }
                None => self.line.pass_to(ticks),
            }
        }
    }

    fn player(&mut self) -> Result<&mut ScenarioPlayer<'r>, CommandFailure> {
        let sentence = "the connection was closed: add a command `connect` before this one";
        self.player.as_mut().ok_or_else(|| CommandFailure { sentence: sentence.to_owned(), goes_on: true })
    }

    fn perform(&mut self, action: &Action) -> Result<(), CommandFailure> {
        let (programs, first_scene) = (self.programs, &self.scenario.scene);
        match action {
            Action::Connect => {
                self.player = None;
                self.connect()?;
            }
            Action::Hang { ms } => self.line.pass_to(self.line.ticks() + ticks_of(*ms, self.line.board().tick_hz)),
            Action::Die => {
                self.line.set_dead(true);
                self.player = None;
                self.line.set_dead(false);
            }
            Action::OtherClient => {
                let mut frame = [0; FRAME_MAX_LEN];
                self.line.inject(hello_request_frame(&mut frame).map_err(DeviceError::from)?);
            }
            Action::Play => {
                self.line.press_switch();
                let player = self.player()?;
                if let Some(program) = programs.get(first_scene) {
                    player.start(program.clone(), 0, &mut ignore_progress)?;
                }
                // The stroke begins anew with each play, not with the first one of a connection alone.
                self.line.start_stroke();
            }
            Action::Upload => {
                let player = self.player()?;
                if let Some(program) = programs.get(first_scene) {
                    load(player.device_mut(), program, &mut ignore_progress)?;
                }
            }
            Action::Replace { scene } => {
                let player = self.player()?;
                if let Some(program) = programs.get(scene) {
                    player.replace(program.clone())?;
                }
            }
            Action::Stop => self.player()?.stop()?,
            Action::ClearFault => self.player()?.clear_fault()?,
            Action::Trigger { layer, duration_s } => {
                self.player()?.trigger(layer, *duration_s)?;
            }
            Action::SetLayer { layer, gain } => {
                self.player()?.change_layer(layer, None, gain.map(|gain| gain as f32))?;
            }
        }
        Ok(())
    }

    /// Records a failure. A program that cannot continue closes its connection.
    fn failed(&mut self, what: &str, CommandFailure { sentence, goes_on }: CommandFailure) {
        if !goes_on {
            self.player = None;
        }
        self.line.note(format!("{what} failed: {sentence}"));
        let tick = self.line.tick();
        self.failures.push(Failure { line: self.last_line, what: what.to_owned(), tick, sentence, is_expected: false });
    }
}

/// The action as the file calls it.
fn verb(action: &Action) -> &'static str {
    match action {
        Action::Connect => "connect",
        Action::Play => "play",
        Action::Upload => "upload",
        Action::Stop => "stop",
        Action::ClearFault => "clear-fault",
        Action::Replace { .. } => "replace",
        Action::Trigger { .. } => "trigger",
        Action::SetLayer { .. } => "layer",
        Action::Hang { .. } => "hang",
        Action::Die => "die",
        Action::OtherClient => "other-client",
    }
}
