//! The kinds of board that `--port` and `--rig` name.

use anyhow::Result;
use clap::ValueEnum;
#[cfg(unix)]
use frixel_hil_sim::emulated::{BOARD, EmulatedBoard, Image, LinkBoard, PicoBoardRig};
use frixel_hil_sim::{Board, BoardMemory, BoardRig, RigConfig};
use frixel_play::Simulation;
use frixel_scene::{CompileError, Program, Scene, compile, compile_draft};
use frixel_wire::hello::{BoardLimits, Hello};

use super::error::of_simulation;
#[cfg(unix)]
use crate::rigs::EmulatedRig;

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
        let board = Board::SIMULATOR;
        if self == Self::Sim { (board.limits, board.tick_hz) } else { (hello.limits, hello.tick_hz) }
    }

    /// Configuration of the rig, in an ideal world: that of the simulator for a board on a serial port.
    pub(super) fn rig(self) -> RigConfig {
        RigConfig::of(match self {
            #[cfg(unix)]
            Self::Qemu => BOARD,
            Self::Pico => Board::PICO,
            _ => Board::SIMULATOR,
        })
    }

    /// Starts the board of [`Self::rig`] in the world of `simulation`, with the finger of `program`, and calls `run`.
    /// Returns its result, and whether an emulator has run to the end.
    pub(super) fn on_rig<T>(
        self,
        simulation: &Simulation,
        program: &Program,
        run: impl FnOnce(Box<dyn BoardRig + '_>) -> Result<T>,
    ) -> Result<(T, Result<()>)> {
        match self {
            #[cfg(unix)]
            Self::Qemu => {
                let world = simulation.world(program).map_err(of_simulation)?;
                let mut board = LinkBoard::start(&Image::find(EmulatedBoard::Mps2An386)?, world)?;
                let result = run(Box::new(EmulatedRig::open(&board)?))?;
                Ok((result, board.check().map_err(Into::into)))
            }
            #[cfg(unix)]
            Self::Pico => {
                let world = simulation.world(program).map_err(of_simulation)?;
                let rig = PicoBoardRig::start(&Image::find(EmulatedBoard::Pico)?, world)?;
                Ok((run(Box::new(rig))?, Ok(())))
            }
            #[cfg(not(unix))]
            Self::Qemu | Self::Pico => Err(super::error::no_pseudo_terminal(self.name())),
            Self::Sim | Self::Port => Ok((run(Box::new(simulation.rig(&mut BoardMemory::new())?))?, Ok(()))),
        }
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
