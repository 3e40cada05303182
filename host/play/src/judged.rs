//! Judges programs on the simulated board.

use frixel_felt::judge::{self, Advice, Judgement};
use frixel_hil_sim::{Board, RigConfig, TouchConfig, WorldOptions};
use frixel_scene::Program;

use crate::{GoesOn, Simulation, SimulationError, simulate};

/// Seed of all that is random in the world, for every element and size.
const SEED: u64 = 1;

/// The rig on which programs are judged: a board in the realistic world with a touch source. It plays drafts.
pub fn judged_rig(board: Board, touch: TouchConfig) -> RigConfig {
    let world = WorldOptions { touch: Some(touch), ..WorldOptions::default() };
    RigConfig::of(board).for_drafts().with(&world)
}

/// What a person will feel of each layer of a program, by [strokes](judge::strokes) that the simulated board of `rig`
/// plays in virtual time. When `goes_on` breaks, the plays end there.
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
