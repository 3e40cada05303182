//! The host of a scenario: a player over the line that carries out the commands of the scenario at their times.

use std::time::Duration;

use frixel_driver::{Device, DeviceError, PollingLink, ignore_progress};
use frixel_hil_sim::BoardRig as _;
use frixel_play::{PlayError, Player, RigStream, load};
use frixel_scene::{Action, Program, Scenario, ScenarioCommand};
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
type ScenarioPlayer<'r> = Player<PollingLink<RigStream<'r, ScenarioLine<'r>>>>;

pub(super) struct Host<'s, 'r> {
    scenario: &'s Scenario,
    programs: &'s Programs,
    line: ScenarioLine<'r>,
    player: Option<ScenarioPlayer<'r>>,
    failures: Vec<Failure>,
    /// Line of the last command.
    last_line: usize,
}

/// Why a command is not carried out.
enum CommandFailure {
    Play(PlayError),
    /// The connection was given up.
    NotConnected,
}

impl From<PlayError> for CommandFailure {
    fn from(error: PlayError) -> Self {
        Self::Play(error)
    }
}

impl From<DeviceError> for CommandFailure {
    fn from(error: DeviceError) -> Self {
        Self::Play(error.into())
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

    /// The failures, in the order of time.
    pub(super) fn into_failures(self) -> Vec<Failure> {
        self.failures
    }

    fn connect(&mut self) -> Result<(), CommandFailure> {
        let link = PollingLink::new(RigStream::new(self.line.clone()));
        self.player = Some(Player::new(Device::connect(link)?));
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

    fn perform(&mut self, action: &Action) -> Result<(), CommandFailure> {
        match action {
            Action::Connect => {
                self.player = None;
                return self.connect();
            }
            Action::Hang { ms } => {
                self.line.pass_to(self.line.ticks() + ticks_of(*ms, self.line.board().tick_hz));
                return Ok(());
            }
            Action::Die => {
                self.line.set_dead(true);
                self.player = None;
                self.line.set_dead(false);
                return Ok(());
            }
            Action::OtherClient => {
                let mut frame = [0; FRAME_MAX_LEN];
                self.line.inject(hello_request_frame(&mut frame).map_err(DeviceError::from)?);
                return Ok(());
            }
            Action::Play => self.line.press_switch(),
            _ => {}
        }
        let program = |scene: &str| self.programs.get(scene).cloned();
        let Some(player) = &mut self.player else { return Err(CommandFailure::NotConnected) };
        perform_with(player, action, &self.scenario.scene, &program)?;
        if matches!(action, Action::Play) {
            // The stroke begins anew with each play, not with the first one of a connection alone.
            self.line.start_stroke();
        }
        Ok(())
    }

    /// Records a failure. A program that cannot continue closes its connection.
    fn failed(&mut self, what: &str, failure: CommandFailure) {
        let (sentence, goes_on) = match failure {
            CommandFailure::Play(error) => (error.to_string(), error.is_refusal()),
            CommandFailure::NotConnected => {
                ("the connection was given up: write a command `connect` before".to_owned(), true)
            }
        };
        if !goes_on {
            self.player = None;
        }
        self.line.note(format!("{what} failed: {sentence}"));
        let tick = self.line.tick();
        self.failures.push(Failure { line: self.last_line, what: what.to_owned(), tick, sentence, is_expected: false });
    }
}

/// Performs an action of a connected host.
fn perform_with(
    player: &mut ScenarioPlayer<'_>,
    action: &Action,
    scene: &str,
    program: &dyn Fn(&str) -> Option<Program>,
) -> Result<(), CommandFailure> {
    let goes_on = &mut ignore_progress;
    match action {
        Action::Play => {
            let Some(program) = program(scene) else { return Ok(()) };
            player.start(program, 0, goes_on)?;
        }
        Action::Upload => {
            let Some(program) = program(scene) else { return Ok(()) };
            load(player.device_mut(), &program, goes_on)?;
        }
        Action::Stop => player.stop()?,
        Action::ClearFault => player.clear_fault()?,
        Action::Replace { scene } => {
            let Some(program) = program(scene) else { return Ok(()) };
            player.replace(program)?;
        }
        Action::Trigger { layer, duration_s } => {
            player.trigger(layer, *duration_s)?;
        }
        Action::SetLayer { layer, gain } => {
            player.change_layer(layer, None, gain.map(|gain| gain as f32))?;
        }
        Action::Connect | Action::Hang { .. } | Action::Die | Action::OtherClient => {}
    }
    Ok(())
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
