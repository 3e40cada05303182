//! Judges programs on the simulated board.

use frixel_felt::judge::{self, Advice, Judgement};
use frixel_hil_sim::{Board, RigConfig, TouchConfig, WorldConfig};
use frixel_model::FrictionLaw;
use frixel_scene::Program;
use frixel_wire::hello::BoardLimits;

use crate::{GoesOn, Simulation, SimulationError, simulate};

/// Seed of all that is random in the world, for every element and size.
const SEED: u64 = 1;

/// The rig on which programs are judged: a board in the world with every effect that was measured, and a touch source.
/// It plays drafts: a tick may take longer than the board has time for.
pub fn judged_rig(board: Board, touch: TouchConfig) -> RigConfig {
    let limits = BoardLimits { tick_cycles_max: u32::MAX, ..board.limits };
    let rig = RigConfig::of(Board { limits, ..board });
    RigConfig { world: WorldConfig { touch, ..rig.world.realistic() }, ..rig }
}

/// What a person will feel of each layer of a program, by [strokes](judge::strokes) that the simulated board of `rig`
/// plays in virtual time, under a finger that is not the program's if there is one. When `goes_on` breaks, the plays end
/// there.
pub fn judge(
    program: &Program,
    rig: &RigConfig,
    own_finger: Option<FrictionLaw>,
    advice: Advice,
    goes_on: GoesOn<'_>,
) -> Result<Judgement, SimulationError> {
    judge::judge(program, advice, &mut |program, stroke| {
        if goes_on().is_break() {
            return Ok(Vec::new());
        }
        let simulation = Simulation::of_stroke(*rig, stroke.clone(), SEED, own_finger);
        Ok(simulate(program, &simulation, None, goes_on)?.samples())
    })
}
