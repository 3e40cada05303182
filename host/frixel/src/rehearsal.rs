//! Memory, table and line bytes that a simulated board needs for a scene, measured without playing it.

use std::ops::ControlFlow;

use frixel_hil_sim::{BoardMemory, Rig, RigConfig, Stroke, StrokeError, WorldError};
use frixel_layers::Scene as WireScene;
use thiserror::Error;

use crate::rigs::SimStream;
use frixel_driver::{Device, DeviceError, PollingLink};
use frixel_felt::check::BoardCosts;
use frixel_felt::recorder::Recorder;
use frixel_play::load;
use frixel_scene::Program;

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
    let wire_total_bytes = wire_bytes(program, rig)?;
    let scene = program.scene_bytes();
    // This parse does not fail: the board has just parsed the same bytes.
    let taken = WireScene::parse(&scene).ok();
    let active_bytes = taken.as_ref().map_or(0, BoardMemory::bytes_filled);
    let table = taken.and_then(|scene| BoardMemory::table_rows(&scene, &rig.board).ok());
    let (table_rows, table_rows_whole) = table.map_or((0, 0), |rows| (rows.filled, rows.whole));
    Ok(BoardCosts { wire_total_bytes, active_bytes, table_rows, table_rows_whole })
}

/// Bytes that the host sends, without the hello, until an empty board has accepted a scene.
fn wire_bytes(program: &Program, rig: &RigConfig) -> Result<usize, RehearsalError> {
    let mut memory = BoardMemory::new();
    let header = &program.header;
    let stroke = Stroke::sweep(header.screen_width_m.into(), header.screen_height_m.into(), 1.0)?;
    let mut device =
        Device::connect(PollingLink::new(SimStream::new(Rig::new(&mut memory, rig, stroke, 1)?, Recorder::idle())))?;
    let before = device.counters().wire_bytes;
    load(&mut device, program, &mut |_| ControlFlow::Continue(()))?;
    Ok((device.counters().wire_bytes - before) as usize)
}
