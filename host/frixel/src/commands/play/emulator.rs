//! Playing on the firmware in an emulator: the one for QEMU, and the image of the Pico.

use crate::commands::error::of_simulation;
use crate::rigs::EmulatedRig;
use anyhow::Result;
use frixel_driver::{Device, PollingLink};
use frixel_hil_sim::emulated::{BOARD, EmulatedBoard, Image, LinkBoard, PicoBoardRig};
use frixel_hil_sim::{Board, RigConfig};
use frixel_play::RigStream;
use frixel_scene::Scene;

use super::Target;
use super::follow::follow;
use super::live_scene::LiveScene;
use super::outputs::PlayFiles;
use super::plan::Plan;
use super::{Interrupt, PlayArgs, Played};

/// Plays on the board of `target` in an emulator, under a simulated finger.
pub(super) fn play_on_emulator(
    args: &PlayArgs,
    scene: &Scene,
    target: Target,
    outputs: (PlayFiles, Option<LiveScene>),
    interrupt: &Interrupt,
) -> Result<Played> {
    let board = if target == Target::Pico { Board::PICO } else { BOARD };
    let mut plan = Plan::new(args, scene, target, (&board.limits, board.tick_hz))?;
    let simulation = plan.simulation(args, scene, &RigConfig::of(board))?.clone();
    let world = simulation.world(&plan.program).map_err(of_simulation)?;
    if target == Target::Pico {
        let rig = PicoBoardRig::start(&Image::find(EmulatedBoard::Pico)?, world)?;
        let device = Device::connect(PollingLink::new(RigStream::new(rig)))?;
        return follow(args, plan, device, outputs, interrupt);
    }
    let mut board = LinkBoard::start(&Image::find(EmulatedBoard::Mps2An386)?, world)?;
    let device = Device::connect(PollingLink::new(RigStream::new(EmulatedRig::open(&board)?)))?;
    let mut played = follow(args, plan, device, outputs, interrupt)?;
    if !interrupt.is_requested() {
        played.failure = played.failure.or(board.check().err().map(anyhow::Error::from));
    }
    Ok(played)
}
