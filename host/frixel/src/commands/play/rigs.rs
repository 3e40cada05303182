//! The boards that `--port` can name, and how to open them.

use crate::rigs::SimStream;
use frixel_driver::{Device, PollingLink};
use frixel_felt::recorder::Recorder;
use frixel_hil_sim::{BoardMemory, Rig, RigConfig};
use frixel_scene::{CompileError, Program, Scene, compile, compile_draft};
use frixel_wire::hello::{BoardLimits, Hello};

use super::super::experiment;
#[cfg(unix)]
pub(super) use super::emulator::play_on_emulator;
use super::follow::follow;
use super::live_scene::LiveScene;
use super::outputs::PlayFiles;
use super::plan::{Plan, check_measured};
use super::simulated_world::SimulatedWorld;
use super::{CommandError, Interrupt, PlayArgs, Played};

/// Kind of the board that plays.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Target {
    /// The simulated board in this process.
    Simulator,
    /// The firmware in an emulator.
    Emulator,
    /// A board on a serial port, real or virtual.
    Port,
}

impl Target {
    /// The kind of board that `--port` names.
    pub(super) fn of(port: &str) -> Self {
        match port {
            "sim" => Self::Simulator,
            "qemu" => Self::Emulator,
            _ => Self::Port,
        }
    }

    /// Whether the play runs in the board's own time, with a finger that is simulated beside it.
    pub(super) fn is_virtual_time(self) -> bool {
        self != Self::Port
    }

    /// Compiles a scene for this kind of board. Only the simulator in this process plays drafts.
    pub(super) fn compile(self, scene: &Scene, limits: &BoardLimits, tick_hz: u32) -> Result<Program, CompileError> {
        match self {
            Self::Simulator => compile_draft(scene, limits, tick_hz),
            Self::Emulator | Self::Port => compile(scene, limits, tick_hz),
        }
    }

    /// The limits and the tick rate that scenes are compiled for. The simulator's own limit of time is lifted while it
    /// plays, for drafts.
    pub(super) fn limits(self, hello: &Hello) -> (BoardLimits, u32) {
        let board = RigConfig::default().board;
        if self == Self::Simulator { (board.limits, board.tick_hz) } else { (hello.limits, hello.tick_hz) }
    }

    /// The name of this kind in the report.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Simulator => "sim",
            Self::Emulator => "qemu",
            Self::Port => "board",
        }
    }
}

/// Plays on the simulated board, under a simulated finger.
pub(super) fn play_on_simulator(
    args: &PlayArgs,
    scene: &Scene,
    outputs: (PlayFiles, Option<LiveScene>),
    interrupt: &Interrupt,
) -> Result<Played, CommandError> {
    let world = SimulatedWorld::new(args, scene)?;
    let mut config = RigConfig::default();
    config.world = world.config(config.world);
    let board = (&config.board.limits, config.board.tick_hz);
    let mut plan = Plan::new(args, scene, Target::Simulator, board)?;
    let stroke = plan.choose_stroke(args)?;
    // A draft may take longer than a board has time for.
    config.board.limits.tick_cycles_max = u32::MAX;
    plan.has_own_reference = world.has_own_reference(&stroke);
    let mut memory = BoardMemory::new();
    let mut rig = Rig::new(&mut memory, &config, stroke, args.seed)?;
    world.set_finger(rig.world_mut());
    plan.world = Some(world.report());
    let device = Device::connect(PollingLink::new(SimStream::new(rig, Recorder::idle())))?;
    follow(args, plan, device, outputs, interrupt)
}

/// Rejects the emulator, because its serial port is a pseudo-terminal.
#[cfg(not(unix))]
pub(super) fn play_on_emulator(
    _: &PlayArgs,
    _: &Scene,
    _: (PlayFiles, Option<LiveScene>),
    _: &Interrupt,
) -> Result<Played, CommandError> {
    Err(CommandError::NoPseudoTerminal { what: "--port qemu" })
}

/// Plays on the board on a serial port. The scene is compiled for the limits that this board reports.
pub(super) fn play_on_port(
    args: &PlayArgs,
    scene: &Scene,
    outputs: (PlayFiles, Option<LiveScene>),
    interrupt: &Interrupt,
) -> Result<Played, CommandError> {
    let device = experiment::connect(&args.port, args.arm)?;
    let hello = *device.hello();
    let plan = Plan::new(args, scene, Target::Port, (&hello.limits, hello.tick_hz))?;
    check_measured(&plan.program, hello.board)?;
    follow(args, plan, device, outputs, interrupt)
}
