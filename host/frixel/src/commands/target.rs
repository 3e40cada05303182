//! The kinds of board that `--port` and `--rig` name.

use clap::ValueEnum;
use frixel_hil_sim::RigConfig;
use frixel_scene::{CompileError, Program, Scene, compile, compile_draft};
use frixel_wire::hello::{BoardLimits, Hello};

/// Kind of the board that plays.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub(super) enum Target {
    /// The simulated board in this process.
    #[default]
    Sim,
    /// The firmware in an emulator.
    Qemu,
    /// The image of the Pico in an emulator.
    Pico,
    /// A board on a serial port, real or virtual, which `--rig` does not accept.
    #[value(skip)]
    Port,
}

impl Target {
    /// The kind of board that `--port` names.
    pub(super) fn of(port: &str) -> Self {
        Self::from_str(port, false).unwrap_or(Self::Port)
    }

    /// The names of every kind but a board on a serial port.
    pub(super) fn names() -> impl Iterator<Item = &'static str> {
        Self::value_variants().iter().map(|target| target.name())
    }

    /// Whether the play runs in the board's own time, with a finger that is simulated beside it.
    pub(super) fn is_virtual_time(self) -> bool {
        self != Self::Port
    }

    /// Compiles a scene for this kind of board. Only the simulator in this process plays drafts.
    pub(super) fn compile(self, scene: &Scene, limits: &BoardLimits, tick_hz: u32) -> Result<Program, CompileError> {
        match self {
            Self::Sim => compile_draft(scene, limits, tick_hz),
            Self::Qemu | Self::Pico | Self::Port => compile(scene, limits, tick_hz),
        }
    }

    /// The limits and the tick rate that scenes are compiled for. While the simulator plays, it reports no limit of
    /// tick time, for drafts; scenes are compiled for its usual limits.
    pub(super) fn limits(self, hello: &Hello) -> (BoardLimits, u32) {
        let board = RigConfig::default().board;
        if self == Self::Sim { (board.limits, board.tick_hz) } else { (hello.limits, hello.tick_hz) }
    }

    /// The name of this kind on the command line and in the report.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Sim => "sim",
            Self::Qemu => "qemu",
            Self::Pico => "pico",
            Self::Port => "board",
        }
    }
}
