//! Memory, table and line bytes that a simulated board needs for a scene, measured without playing it.

use frixel_driver::{Device, DeviceError, PollingLink, ignore_progress};
use frixel_felt::check::BoardCosts;
use frixel_hil_sim::{BoardMemory, Rig, RigConfig, Stroke, StrokeError, WorldError};
use frixel_play::{RigStream, load};
use frixel_scene::Program;
use thiserror::Error;

/// Why a simulated board did not accept a scene.
#[derive(Debug, Error)]
pub enum RehearsalError {
    /// The simulated world could not be built.
    #[error(transparent)]
    World(#[from] WorldError),
    /// The screen is too small for a stroke.
    #[error("no stroke can be generated for this scene's screen: {0}")]
    Stroke(#[from] StrokeError),
    /// The board rejected the scene; the error states the exceeded limit.
    #[error("the board does not take this scene: {0}")]
    Device(#[from] DeviceError),
}

/// What the simulated board of `rig` needs for a program that was compiled for it. Uploads the program once.
pub fn board_costs(program: &Program, rig: &RigConfig) -> Result<BoardCosts, RehearsalError> {
    let mut memory = BoardMemory::new();
    let header = &program.header;
    let stroke = Stroke::sweep(header.screen_width_m.into(), header.screen_height_m.into(), 1.0)?;
    let stream = RigStream::new(Rig::new(&mut memory, rig, stroke, 1)?);
    let mut device = Device::connect(PollingLink::new(stream))?;
    let wire_bytes = load(&mut device, program, &mut ignore_progress)?;
    Ok(BoardCosts::of(program, rig, wire_bytes))
}
