//! Playing on the firmware in an emulator.

use std::sync::mpsc;

use crate::rigs::EmulatedStream;
use frixel_driver::{Device, PollingLink};
use frixel_hil_sim::emulated::{BOARD, EmulatedBoard, Image, LinkBoard};
use frixel_hil_sim::{Stroke, World, WorldConfig};
use frixel_scene::{Program, Scene};

use super::follow::follow;
use super::live_scene::LiveScene;
use super::outputs::PlayFiles;
use super::plan::Plan;
use super::simulated_world::SimulatedWorld;
use super::target::Target;
use super::{CommandError, Interrupt, PlayArgs, Played};

/// Plays on the firmware in an emulator, under a simulated finger.
pub(super) fn play_on_emulator(
    args: &PlayArgs,
    scene: &Scene,
    outputs: (PlayFiles, Option<LiveScene>),
    interrupt: &Interrupt,
) -> Result<Played, CommandError> {
    let mut plan = Plan::new(args, scene, Target::Emulator, (&BOARD.limits, BOARD.tick_hz))?;
    let stroke = plan.choose_stroke(args)?;
    let simulated = SimulatedWorld::new(args, scene)?;
    plan.world = Some(simulated.report());
    plan.has_own_reference = simulated.has_own_reference(&stroke);
    let world = world(&plan.program, &simulated, stroke, args.seed)?;
    let image = Image::find(EmulatedBoard::Mps2An386)?;
    let (sender, records) = mpsc::channel();
    let mut board = LinkBoard::start(&image, world, move |record| {
        // The receiver is gone once the play has ended.
        let _ = sender.send(*record);
    })?;
    let device = Device::connect(PollingLink::new(EmulatedStream::open(&board, records)?))?;
    let mut played = follow(args, plan, device, outputs, interrupt)?;
    if !interrupt.is_requested() {
        played.failure = played.failure.or(board.check().err().map(CommandError::from));
    }
    Ok(played)
}

/// Creates the world around the emulated board, with the drawn person's finger or else the one that the scene was made
/// for.
fn world(program: &Program, simulated: &SimulatedWorld, stroke: Stroke, seed: u64) -> Result<World, CommandError> {
    let config = WorldConfig {
        tick_hz: BOARD.tick_hz,
        full_scale_v_peak: f64::from(BOARD.limits.full_scale_v_peak),
        ..WorldConfig::default()
    };
    let mut world = World::new(simulated.config(config), stroke, seed)?;
    world.set_finger(program.header.friction_law().map_err(CommandError::Finger)?);
    simulated.set_finger(&mut world);
    Ok(world)
}
