//! Opens the board that `--port` names, and plays on it.

use anyhow::Result;
use frixel_driver::{Device, PollingLink};
use frixel_hil_sim::{BoardMemory, Rig, RigConfig};
use frixel_play::{RigStream, check_measured};
use frixel_scene::Scene;

use super::super::port;
use super::Target;
#[cfg(unix)]
pub(super) use super::emulator::play_on_emulator;
use super::follow::follow;
use super::live_scene::LiveScene;
use super::outputs::PlayFiles;
use super::plan::Plan;
use super::{Interrupt, PlayArgs, Played};

/// A simulated board under a simulated finger.
pub(super) type Simulator<'a> = Device<PollingLink<RigStream<'a, Rig<'a>>>>;

/// Plays on the simulated board, under a simulated finger.
pub(super) fn play_on_simulator(
    args: &PlayArgs,
    scene: &Scene,
    outputs: (PlayFiles, Option<LiveScene>),
    interrupt: &Interrupt,
) -> Result<Played> {
    let mut memory = BoardMemory::new();
    let (plan, device) = simulator(args, scene, &mut memory)?;
    follow(args, plan, device, outputs, interrupt)
}

/// Opens the simulated board for a play.
pub(super) fn simulator<'a>(
    args: &PlayArgs,
    scene: &Scene,
    memory: &'a mut BoardMemory,
) -> Result<(Plan, Simulator<'a>)> {
    let config = RigConfig::default();
    let board = (&config.board.limits, config.board.tick_hz);
    let mut plan = Plan::new(args, scene, Target::Sim, board)?;
    let rig = plan.simulation(args, scene, &config)?.rig(memory)?;
    let device = Device::connect(PollingLink::new(RigStream::new(rig)))?;
    Ok((plan, device))
}

/// Rejects the emulators, which are built for Unix only.
#[cfg(not(unix))]
pub(super) fn play_on_emulator(
    _: &PlayArgs,
    _: &Scene,
    target: Target,
    _: (PlayFiles, Option<LiveScene>),
    _: &Interrupt,
) -> Result<Played> {
    Err(crate::commands::error::no_pseudo_terminal(&format!("--port {}", target.name())))
}

/// Plays on the board on a serial port. The scene is compiled for the limits that this board reports.
pub(super) fn play_on_port(
    args: &PlayArgs,
    scene: &Scene,
    outputs: (PlayFiles, Option<LiveScene>),
    interrupt: &Interrupt,
) -> Result<Played> {
    let device = port::connect_to_play(&args.port, &Target::names().collect::<Vec<_>>(), args.arm)?;
    let hello = *device.hello();
    let plan = Plan::new(args, scene, Target::Port, (&hello.limits, hello.tick_hz))?;
    check_measured(&plan.program, hello.board)?;
    follow(args, plan, device, outputs, interrupt)
}
