//! Plays compiled scenes on the simulated board, and records the plays.

use std::time::Duration;

use frixel_driver::{Counters, DeviceError, StreamStatus, ignore_progress};
use frixel_felt::GoesOn;
use frixel_felt::fidelity::{FidelitySample, ticks_per_sample};
use frixel_felt::recorder::Recorder;
use frixel_hil_sim::{BoardMemory, Rig, RigConfig, Stroke, StrokeError, World, WorldError};
use frixel_scene::Program;
use frixel_wire::hello::Hello;
use thiserror::Error;

use crate::{Feed, PlayError, Player, RigLink, connect};

/// Settings of a play on the simulator.
#[derive(Clone, Debug)]
pub struct Simulation {
    /// The simulated board, world and serial line.
    pub rig: RigConfig,
    /// Path of the simulated finger.
    pub stroke: Stroke,
    /// Duration, in seconds from the beginning of the stroke.
    pub seconds: f64,
    /// Seed of every random process.
    pub seed: u64,
    /// Ticks between two rows of the record.
    pub ticks_per_row: u32,
}

/// A simulated board on which a program plays.
pub type SimPlayer<'a> = Player<RigLink<'a>>;

/// Results of a simulation.
pub struct Simulated {
    /// Recorder with the felt friction and its reference.
    pub recorder: Recorder,
    /// The board's hello.
    pub board: Hello,
    /// Traffic counters of the serial line.
    pub counters: Counters,
    /// Final status of the stream; `None` without one.
    pub stream: Option<StreamStatus>,
}

/// Why a play on the simulator ended early.
#[derive(Debug, Error)]
pub enum SimulationError {
    /// The simulated world could not be built.
    #[error(transparent)]
    World(#[from] WorldError),
    /// The finger's stroke could not be built.
    #[error(transparent)]
    Stroke(#[from] StrokeError),
    /// The board refused the scene.
    #[error("the board refused this scene: {0}")]
    Refused(#[source] DeviceError),
    /// The play failed.
    #[error(transparent)]
    Play(#[from] PlayError),
    /// [`GoesOn`] broke before the result was complete.
    #[error("interrupted")]
    Interrupted,
}

impl From<DeviceError> for SimulationError {
    fn from(error: DeviceError) -> Self {
        Self::Play(error.into())
    }
}

impl Simulation {
    /// Simulates one complete stroke, with a row for each [`FidelitySample`].
    pub fn of_stroke(rig: RigConfig, stroke: Stroke, seed: u64) -> Self {
        let seconds = stroke.duration_s();
        let ticks_per_row = ticks_per_sample(rig.board.tick_hz);
        Self { rig, stroke, seconds, seed, ticks_per_row }
    }

    /// The world of a board in another process, with a finger of its own, or else the one that `program` is for.
    pub fn world(&self, program: &Program) -> Result<World, SimulationError> {
        let mut world = World::new(self.rig.world, self.stroke.clone(), self.seed)?;
        let law = program.header.friction_law().map_err(PlayError::Finger)?;
        world.set_finger(law, program.carrier.half_period_ticks);
        Ok(world)
    }

    /// The recorder of a play of `program`, until the last tick. The reference goes through the simulated finger.
    pub fn recorder(&self, program: &Program) -> Result<Recorder, PlayError> {
        let board = &self.rig.board;
        let ticks = (self.seconds * f64::from(board.tick_hz)).round() as u64;
        Ok(Recorder::new(program, &board.limits, board.tick_hz, ticks, self.ticks_per_row)?.through_finger())
    }

    /// The board after power-on, in its world.
    pub fn rig<'a>(&self, memory: &'a mut BoardMemory) -> Result<Rig<'a>, WorldError> {
        Rig::new(memory, &self.rig, self.stroke.clone(), self.seed)
    }
}

impl Simulated {
    /// Felt friction and its reference, row by row.
    pub fn samples(&mut self) -> Vec<FidelitySample> {
        let start_s = self.recorder.start_s().unwrap_or(0.0);
        self.recorder.take_rows().iter().map(|row| FidelitySample::of_row(row, start_s)).collect()
    }
}

/// Plays `program` on the simulated board under a simulated finger. `feed` supplies the samples of its stream layers.
///
/// The program must have been compiled for the limits and the tick rate of the simulation's board.
pub fn simulate(
    program: &Program,
    simulation: &Simulation,
    feed: Option<Feed>,
    goes_on: GoesOn<'_>,
) -> Result<Simulated, SimulationError> {
    simulate_by(program, simulation, feed, &mut |player| play_on(player, goes_on))
}

/// Like [`simulate`], but `play` advances the time, and may change what plays.
pub fn simulate_by(
    program: &Program,
    simulation: &Simulation,
    feed: Option<Feed>,
    play: &mut dyn FnMut(&mut SimPlayer<'_>) -> Result<(), PlayError>,
) -> Result<Simulated, SimulationError> {
    let recorder = simulation.recorder(program)?;
    let mut memory = BoardMemory::new();
    let mut player = Player::recording(connect(Box::new(simulation.rig(&mut memory)?))?, recorder);
    player.start(program.clone(), 0, &mut ignore_progress)?;
    if let Some(feed) = feed {
        player.stream(feed)?;
    }
    play(&mut player)?;
    player.stop()?;
    let device = player.device();
    let (board, counters, stream) = (*device.hello(), device.counters(), device.stream_status());
    Ok(Simulated { recorder: player.into_recorder(), board, counters, stream })
}

/// Plays until the record is full, or `goes_on` breaks.
fn play_on(player: &mut SimPlayer<'_>, goes_on: GoesOn<'_>) -> Result<(), PlayError> {
    while player.recorder_mut().ticks_left() > 0 && goes_on().is_continue() {
        player.step(Duration::MAX)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use frixel_hil_sim::WorldFault;
    use frixel_scene::{Scene, compile};
    use frixel_wire::fault::Fault;

    use super::*;
    use crate::StopReason;

    /// In virtual time as on a serial port, a fault ends the play, and the record holds everything up to the fault.
    #[test]
    fn a_board_that_stops_by_itself_ends_the_play() {
        let config = RigConfig::default();
        let board = &config.board;
        let text = "version = 1\n[[layer]]\nkind = \"constant\"\nfriction_fraction = 0.5\n";
        let scene = Scene::parse(text, "constant.toml", &BTreeMap::<String, Vec<u8>>::new()).unwrap();
        let program = compile(&scene, &board.limits, board.tick_hz).unwrap();
        let mut memory = BoardMemory::new();
        let mut rig = Rig::new(&mut memory, &config, Stroke::sweep(0.12, 0.11, 1.0).unwrap(), 1).unwrap();
        rig.world_mut().schedule_fault(20_000..u64::MAX, WorldFault::AmplifierNotReady).unwrap();
        let recorder = Recorder::new(&program, &board.limits, board.tick_hz, 400_000, 40).unwrap();
        let mut player = Player::recording(connect(Box::new(rig)).unwrap(), recorder);
        player.start(program, 0, &mut ignore_progress).unwrap();
        let error = (0..100).find_map(|_| player.step(Duration::MAX).err()).unwrap();
        assert!(matches!(error, PlayError::Stopped(StopReason::Fault(Fault::Amplifier))), "{error}");
        let recorder = player.into_recorder();
        assert!((10_000..25_000).contains(&recorder.ticks()), "{} ticks", recorder.ticks());
        assert!(!recorder.rows().is_empty());
    }
}
