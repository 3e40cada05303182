//! Costs of a program on the simulated board, and the judgement of its layers.

use frixel_driver::ignore_progress;
use frixel_felt::check::BoardCosts;
use frixel_felt::judge::{self, Advice, Judgement};
use frixel_hil_sim::{BoardMemory, Point, Rig, RigConfig, Stroke, WorldOptions};
use frixel_scene::Program;

use crate::{GoesOn, Simulation, SimulationError, connect, load, simulate};

/// Random seed of the world, for every element and size.
const SEED: u64 = 1;

/// Judges what a person will feel of each layer of a program.
///
/// The simulated board of `rig` plays [strokes](judge::strokes) in `world` and in virtual time; it also plays drafts.
/// When `goes_on` breaks, the judgement fails with [`SimulationError::Interrupted`].
pub fn judge(
    program: &Program,
    rig: &RigConfig,
    world: &WorldOptions,
    advice: Advice,
    goes_on: GoesOn<'_>,
) -> Result<Judgement, SimulationError> {
    let rig = rig.for_drafts().with(world);
    judge::judge(program, advice, &mut |program, stroke| {
        let mut played = simulate(program, &Simulation::of_stroke(rig, stroke.clone(), SEED), None, goes_on)?;
        if goes_on().is_break() { Err(SimulationError::Interrupted) } else { Ok(played.samples()) }
    })
}

/// Memory, table and line bytes that the simulated board of `rig` needs for a program that was compiled for it. Uploads
/// the program once, without playing it.
pub fn board_costs(program: &Program, rig: &RigConfig) -> Result<BoardCosts, SimulationError> {
    let mut memory = BoardMemory::new();
    // The stroke never starts.
    let stroke = Stroke::still(Point { x_m: 0.0, y_m: 0.0 }, 1.0)?;
    let mut device = connect(Box::new(Rig::new(&mut memory, rig, stroke, SEED)?))?;
    let wire_bytes = load(&mut device, program, &mut ignore_progress).map_err(SimulationError::Refused)?;
    Ok(BoardCosts::of(program, rig, wire_bytes))
}
