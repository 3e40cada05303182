//! Costs of a program on the simulated board, and the judgement of its layers.

use frixel_driver::{Device, PollingLink, ignore_progress};
use frixel_felt::check::BoardCosts;
use frixel_felt::judge::{self, Advice, Judgement};
use frixel_hil_sim::{Board, BoardMemory, Point, Rig, RigConfig, Stroke, TouchConfig, WorldOptions};
use frixel_scene::Program;

use crate::{GoesOn, RigStream, Simulation, SimulationError, load, simulate};

/// Random seed of the world, for every element and size.
const SEED: u64 = 1;

/// The rig on which programs are judged: a board in the realistic world with a touch source. It plays drafts.
pub fn judged_rig(board: Board, touch: TouchConfig) -> RigConfig {
    let world = WorldOptions { touch: Some(touch), ..WorldOptions::default() };
    RigConfig::of(board).for_drafts().with(&world)
}

/// Judges what a person will feel of each layer of a program.
///
/// The simulated board of `rig` plays [strokes](judge::strokes) in virtual time. When `goes_on` breaks, the plays end
/// early.
pub fn judge(
    program: &Program,
    rig: &RigConfig,
    advice: Advice,
    goes_on: GoesOn<'_>,
) -> Result<Judgement, SimulationError> {
    judge::judge(program, advice, &mut |program, stroke| {
        if goes_on().is_break() {
            return Ok(Vec::new());
        }
        let simulation = Simulation::of_stroke(*rig, stroke.clone(), SEED);
        Ok(simulate(program, &simulation, None, goes_on)?.samples())
    })
}

/// Memory, table and line bytes that the simulated board of `rig` needs for a program that was compiled for it. Uploads
/// the program once, without playing it.
pub fn board_costs(program: &Program, rig: &RigConfig) -> Result<BoardCosts, SimulationError> {
    let mut memory = BoardMemory::new();
    // The stroke never starts.
    let stroke = Stroke::still(Point { x_m: 0.0, y_m: 0.0 }, 1.0)?;
    let stream = RigStream::new(Rig::new(&mut memory, rig, stroke, SEED)?);
    let mut device = Device::connect(PollingLink::new(stream))?;
    let wire_bytes = load(&mut device, program, &mut ignore_progress).map_err(SimulationError::Refused)?;
    Ok(BoardCosts::of(program, rig, wire_bytes))
}
