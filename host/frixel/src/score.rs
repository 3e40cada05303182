//! Plays a trial, and records what was felt and what the reference was.

use frixel_felt::fidelity::{FidelitySample, SAMPLE_HZ};
use frixel_hil_sim::RigConfig;
use frixel_lab::score::Trial;
use frixel_scene::Program;

use crate::player::{Simulation, SimulationError, simulate_through_finger};

/// Plays a trial on a simulated board, for [`Score::of`](frixel_lab::score::Score::of); returns a sample for every
/// quarter of a millisecond.
pub fn samples(program: &Program, rig: &RigConfig, trial: &Trial) -> Result<Vec<FidelitySample>, SimulationError> {
    let simulation = Simulation {
        rig: RigConfig { world: trial.world(rig.world), ..*rig },
        stroke: trial.stroke.clone(),
        seconds: trial.stroke.duration_s(),
        seed: trial.seed,
        ticks_per_row: (f64::from(rig.board.tick_hz) / SAMPLE_HZ).round().max(1.0) as u32,
    };
    let own_finger = trial.finger.map(|finger| finger.contact);
    let mut recorder = simulate_through_finger(program, &simulation, own_finger.map(Into::into))?.recorder;
    let start_s = recorder.start_s().unwrap_or(0.0);
    Ok(recorder.take_rows().iter().map(|row| FidelitySample::of_row(row, start_s)).collect())
}
