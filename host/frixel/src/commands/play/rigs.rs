//! Opens the board that `--port` names, and plays on it.

use anyhow::Result;
use frixel_hil_sim::BoardRig;
use frixel_play::{check_measured, connect};
use frixel_scene::Scene;

use super::super::port;
use super::Target;
use super::follow::follow;
use super::live_scene::LiveScene;
use super::outputs::PlayFiles;
use super::plan::Plan;
use super::{Interrupt, PlayArgs, Played};

/// Plays on the board of `target`, simulated or emulated, under a simulated finger.
pub(super) fn play_on_rig(
    args: &PlayArgs,
    scene: &Scene,
    target: Target,
    outputs: (PlayFiles, Option<LiveScene>),
    interrupt: &Interrupt,
) -> Result<Played> {
    let rig = target.rig();
    let mut plan = Plan::new(args, scene, target, (&rig.board.limits, rig.board.tick_hz))?;
    let simulation = plan.simulation(args, scene, &rig)?.clone();
    let program = plan.program.clone();
    let follow = |rig: Box<dyn BoardRig + '_>| follow(args, plan, connect(rig)?, outputs, interrupt);
    let (mut played, ended) = target.on_rig(&simulation, &program, follow)?;
    if !interrupt.is_requested() {
        played.failure = played.failure.or(ended.err());
    }
    Ok(played)
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
