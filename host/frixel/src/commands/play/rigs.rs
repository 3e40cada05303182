//! The boards that `--port` can name, and how each is opened.

use std::sync::mpsc;

use frixel::rigs::{EmulatedLink, PortLink, SimLink};
use frixel_driver::{DEFAULT_BAUD, Device, SerialLink};
use frixel_hil_sim::emulated::{BOARD, Image, LinkBoard};
use frixel_hil_sim::{BoardMemory, Rig, RigConfig, Stroke, World, WorldConfig, contact_of};
use frixel_scene::recorder::Recorder;
use frixel_scene::{Program, Scene};

use super::follow::follow;
use super::live_scene::LiveScene;
use super::plan::Plan;
use super::{CommandError, Interrupt, PlayArgs, Played};

/// What kind of board plays.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Target {
    /// The board in this process.
    Simulator,
    /// The firmware in an emulator.
    Emulator,
    /// A board at a serial port, real or virtual.
    Port,
}

impl Target {
    /// What `--port` names.
    pub(super) fn of(port: &str) -> Self {
        match port {
            "sim" => Self::Simulator,
            "qemu" => Self::Emulator,
            _ => Self::Port,
        }
    }

    /// Whether the play has the board's own time, and a finger that is simulated beside it.
    pub(super) fn is_virtual_time(self) -> bool {
        self != Self::Port
    }

    /// Its name in the report.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Simulator => "sim",
            Self::Emulator => "qemu",
            Self::Port => "board",
        }
    }
}

/// Plays on the simulated board, under a simulated finger.
pub(super) fn play_on_simulator(args: &PlayArgs, scene: &Scene, interrupt: &Interrupt) -> Result<Played, CommandError> {
    let config = RigConfig::default();
    let board = (&config.board.limits, config.board.tick_hz);
    let mut plan = Plan::new(args, scene, Target::Simulator, board)?;
    let stroke = plan.choose_stroke(args)?;
    let mut memory = BoardMemory::new();
    let rig = Rig::new(&mut memory, &config, stroke, args.seed)?;
    let device = Device::connect(SimLink::new(rig, Recorder::idle()))?;
    follow(args, plan, device, None, interrupt)
}

/// Plays on the firmware in an emulator, under a simulated finger.
pub(super) fn play_on_emulator(args: &PlayArgs, scene: &Scene, interrupt: &Interrupt) -> Result<Played, CommandError> {
    let mut plan = Plan::new(args, scene, Target::Emulator, (&BOARD.limits, BOARD.tick_hz))?;
    let stroke = plan.choose_stroke(args)?;
    let world = world(&plan.program, stroke, args.seed)?;
    let image = Image::build()?;
    let (sender, records) = mpsc::channel();
    let mut board = LinkBoard::start(&image, world, move |record| {
        // Nobody receives any more when the play has ended.
        let _ = sender.send(*record);
    })?;
    let device = Device::connect(EmulatedLink::open(&board, records)?)?;
    let mut played = follow(args, plan, device, None, interrupt)?;
    if !interrupt.is_requested() {
        played.failure = played.failure.or(board.check().err().map(CommandError::from));
    }
    Ok(played)
}

/// Plays on the board at a serial port. The scene is compiled for what that board is.
pub(super) fn play_on_port(
    args: &PlayArgs,
    scene: &Scene,
    live_scene: Option<LiveScene>,
    interrupt: &Interrupt,
) -> Result<Played, CommandError> {
    let device = Device::connect(PortLink::new(SerialLink::open(&args.port, DEFAULT_BAUD)?))?;
    let hello = *device.hello();
    if !(args.arm || hello.board.is_simulated()) {
        return Err(CommandError::NotArmed { port: args.port.clone() });
    }
    let plan = Plan::new(args, scene, Target::Port, (&hello.limits, hello.tick_hz))?;
    follow(args, plan, device, live_scene, interrupt)
}

/// The world around the emulated board, with the finger that the scene is meant for.
fn world(program: &Program, stroke: Stroke, seed: u64) -> Result<World, CommandError> {
    let config = WorldConfig {
        tick_hz: BOARD.tick_hz,
        full_scale_v_peak: f64::from(BOARD.limits.full_scale_v_peak),
        ..WorldConfig::default()
    };
    let mut world = World::new(config, stroke, seed)?;
    world.set_finger(contact_of(&program.header).map_err(CommandError::Finger)?);
    Ok(world)
}
