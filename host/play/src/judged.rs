//! Judges programs on the simulated board.

use std::ops::ControlFlow;
use std::time::Duration;

use frixel_driver::{Device, DeviceError, PollingLink};
use frixel_felt::fidelity::{FidelitySample, SAMPLE_HZ};
use frixel_felt::judge::{self, Advice, Judgement};
use frixel_felt::recorder::Recorder;
use frixel_hil_sim::{Board, BoardMemory, Rig, RigConfig, TouchConfig, WorldConfig, WorldError};
use frixel_model::FrictionLaw;
use frixel_scene::Program;
use frixel_wire::hello::{BoardLimits, Hello};
use thiserror::Error;

use crate::{PlayError, Player, SimStream};

/// Seed of all that is random in the world, for every element and size.
const SEED: u64 = 1;

/// Why a play on the simulator ended early.
#[derive(Debug, Error)]
pub enum SimulationError {
    /// The simulated world could not be built.
    #[error(transparent)]
    World(#[from] WorldError),
    /// The play failed.
    #[error(transparent)]
    Play(#[from] PlayError),
}

impl From<DeviceError> for SimulationError {
    fn from(error: DeviceError) -> Self {
        Self::Play(error.into())
    }
}

/// The rig on which programs are judged: a board in the world with every effect that was measured, and a touch source.
/// It plays drafts: a tick may take longer than the board has time for.
pub fn judged_rig(board: Board, touch: TouchConfig) -> RigConfig {
    let limits = BoardLimits { tick_cycles_max: u32::MAX, ..board.limits };
    let rig = RigConfig::of(Board { limits, ..board });
    RigConfig { world: WorldConfig { touch, ..rig.world.realistic() }, ..rig }
}

/// What a person will feel of each layer of a program, by [strokes](judge::strokes) that the simulated board of `rig`
/// plays in virtual time, under a finger that is not the program's if there is one.
///
/// `goes_on` is asked many times a second of each play; when it breaks, the plays end there.
pub fn judge(
    program: &Program,
    rig: &RigConfig,
    own_finger: Option<FrictionLaw>,
    advice: Advice,
    goes_on: &dyn Fn() -> ControlFlow<()>,
) -> Result<Judgement, SimulationError> {
    let mut memory = BoardMemory::new();
    judge::judge(program, advice, &mut |program, stroke| {
        if goes_on().is_break() {
            return Ok(Vec::new());
        }
        let mut rig = Rig::new(&mut memory, rig, stroke.clone(), SEED)?;
        if let Some(finger) = own_finger {
            rig.world_mut().set_own_finger(finger);
        }
        felt_by(rig, program, stroke.duration_s(), goes_on)
    })
}

/// Samples of what the finger on a rig feels of a program, under its whole stroke.
fn felt_by(
    rig: Rig<'_>,
    program: &Program,
    duration_s: f64,
    goes_on: &dyn Fn() -> ControlFlow<()>,
) -> Result<Vec<FidelitySample>, SimulationError> {
    let device = Device::connect(PollingLink::new(SimStream::new(rig, Recorder::default())))?;
    let Hello { limits, tick_hz, .. } = *device.hello();
    let ticks = (duration_s * f64::from(tick_hz)).round() as u64;
    let ticks_per_row = (f64::from(tick_hz) / SAMPLE_HZ).round().max(1.0) as u32;
    let recorder = Recorder::new(program, &limits, tick_hz, ticks, ticks_per_row);
    let recorder = recorder.map_err(PlayError::Finger)?.through_finger();
    let mut player = Player::recording(device, recorder);
    player.start(program.clone(), 0, &mut |_| ControlFlow::Continue(()))?;
    while player.recorder_mut().ticks_left() > 0 && goes_on().is_continue() {
        player.step(Duration::MAX)?;
    }
    player.stop()?;
    let mut recorder = player.into_recorder();
    let start_s = recorder.start_s().unwrap_or(0.0);
    Ok(recorder.take_rows().iter().map(|row| FidelitySample::of_row(row, start_s)).collect())
}
