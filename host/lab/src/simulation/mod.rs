//! Plays compiled scenes on the simulator, and records the plays.

use std::ops::ControlFlow;
use std::time::Duration;

use frixel_driver::{Counters, Device, PollingLink, StreamStatus};
use frixel_felt::recorder::Recorder;
use frixel_hil_sim::{BoardMemory, Rig, RigConfig, Stroke};
use frixel_model::FrictionLaw;
use frixel_play::{Feed, PlayError, Player};
use frixel_scene::Program;
use frixel_wire::hello::Hello;

mod rehearsal;

pub use frixel_play::{SimStream, SimulationError};
pub use rehearsal::{RehearsalError, board_costs};

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
pub(crate) type SimPlayer<'a> = Player<PollingLink<SimStream<'a>>>;
/// Lets the time of a play pass, and changes what plays.
pub(crate) type Play<'p> = dyn FnMut(&mut SimPlayer<'_>) -> Result<(), PlayError> + 'p;

/// Results of a simulation.
pub struct Simulated {
    /// Recorder with the felt friction and its reference.
    pub recorder: Recorder,
    /// What the board said of itself.
    pub board: Hello,
    /// Traffic counters of the serial line.
    pub counters: Counters,
    /// Final status of the stream; `None` without one.
    pub stream: Option<StreamStatus>,
}

/// Plays `program` on the simulated board under a simulated finger. `feed` supplies the samples of its stream layers.
///
/// The program must have been compiled for the limits and the tick rate of the simulation's board.
pub fn simulate(program: &Program, simulation: &Simulation, feed: Option<Feed>) -> Result<Simulated, SimulationError> {
    run(program, simulation, recorder(program, simulation)?, None, feed, &mut play_to_end)
}

/// As [`simulate`], under a finger that is not the program's if there is one, and with a reference that goes through
/// the simulated finger.
pub fn simulate_through_finger(
    program: &Program,
    simulation: &Simulation,
    own_finger: Option<FrictionLaw>,
) -> Result<Simulated, SimulationError> {
    let recorder = recorder(program, simulation)?.through_finger();
    run(program, simulation, recorder, own_finger, None, &mut play_to_end)
}

/// As [`simulate`], or as [`simulate_through_finger`] with `through_finger`. `goes_on` is asked many times a second of
/// the play; when it breaks, the record ends there.
pub fn simulate_while(
    program: &Program,
    simulation: &Simulation,
    own_finger: Option<FrictionLaw>,
    through_finger: bool,
    goes_on: &mut dyn FnMut() -> ControlFlow<()>,
) -> Result<Simulated, SimulationError> {
    simulate_by(program, simulation, (own_finger, through_finger), None, &mut |player| play_while(player, goes_on))
}

/// As [`simulate_while`], with a feed for stream layers, and with `play` in place of [`play_while`].
pub(crate) fn simulate_by(
    program: &Program,
    simulation: &Simulation,
    (own_finger, through_finger): (Option<FrictionLaw>, bool),
    feed: Option<Feed>,
    play: &mut Play<'_>,
) -> Result<Simulated, SimulationError> {
    let recorder = recorder(program, simulation)?;
    let recorder = if through_finger { recorder.through_finger() } else { recorder };
    run(program, simulation, recorder, own_finger, feed, play)
}

/// Plays until the record is full, or `goes_on` breaks.
pub(crate) fn play_while(
    player: &mut SimPlayer<'_>,
    goes_on: &mut dyn FnMut() -> ControlFlow<()>,
) -> Result<(), PlayError> {
    while player.recorder_mut().ticks_left() > 0 && goes_on().is_continue() {
        player.step(Duration::MAX)?;
    }
    Ok(())
}

fn play_to_end(player: &mut SimPlayer<'_>) -> Result<(), PlayError> {
    play_while(player, &mut || ControlFlow::Continue(()))
}

fn recorder(program: &Program, simulation: &Simulation) -> Result<Recorder, PlayError> {
    let board = &simulation.rig.board;
    let ticks = (simulation.seconds * f64::from(board.tick_hz)).round() as u64;
    Recorder::new(program, &board.limits, board.tick_hz, ticks, simulation.ticks_per_row).map_err(PlayError::Finger)
}

fn run(
    program: &Program,
    simulation: &Simulation,
    recorder: Recorder,
    own_finger: Option<FrictionLaw>,
    feed: Option<Feed>,
    play: &mut Play<'_>,
) -> Result<Simulated, SimulationError> {
    let mut memory = BoardMemory::new();
    let mut rig = Rig::new(&mut memory, &simulation.rig, simulation.stroke.clone(), simulation.seed)?;
    if let Some(contact) = own_finger {
        rig.world_mut().set_own_finger(contact);
    }
    let stream = SimStream::new(rig, Recorder::default());
    let mut player = Player::recording(Device::connect(PollingLink::new(stream))?, recorder);
    player.start(program.clone(), 0, &mut |_| ControlFlow::Continue(()))?;
    if let Some(feed) = feed {
        player.stream(feed)?;
    }
    play(&mut player)?;
    player.stop()?;
    let device = player.device();
    let (board, counters, stream) = (*device.hello(), device.counters(), device.stream_status());
    Ok(Simulated { recorder: player.into_recorder(), board, counters, stream })
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use frixel_hil_sim::WorldFault;
    use frixel_play::StopReason;
    use frixel_scene::{Scene, compile};
    use frixel_wire::fault::Fault;

    use super::*;

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
        let mut player = Player::recording(
            Device::connect(PollingLink::new(SimStream::new(rig, Recorder::default()))).unwrap(),
            recorder,
        );
        player.start(program, 0, &mut |_| ControlFlow::Continue(())).unwrap();
        let error = (0..100).find_map(|_| player.step(Duration::MAX).err()).unwrap();
        assert!(matches!(error, PlayError::Stopped(StopReason::Fault(Fault::Amplifier))), "{error}");
        let recorder = player.into_recorder();
        assert!((10_000..25_000).contains(&recorder.ticks()), "{} ticks", recorder.ticks());
        assert!(!recorder.rows().is_empty());
    }
}
