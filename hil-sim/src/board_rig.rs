//! The common interface of all rigs: a board with a serial line, and a world around it. Every scenario runs on any of
//! them.

use core::time::Duration;

use frixel_control::{Board, Drive, Status};
use thiserror::Error;

use crate::{Felt, OutOfRange, WorldFault};

/// A fault of a rig: of the board or of its world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RigFault {
    /// A fault of the world, for the given duration.
    World(WorldFault),
    /// The board is reset.
    Reset,
    /// The board is reset, and its option bytes are wrong from then on.
    OptionBytes,
    /// One tick of the board is late.
    LateTick,
    /// The board's tick count is set to this many ticks before its 32 bits wrap around.
    WrapSoon {
        /// Ticks before the wrap.
        ticks: u32,
    },
}

/// One tick of a board and its world.
#[derive(Clone, Copy, Debug)]
pub struct RigTick<S = BoardView> {
    /// Ticks on the rig's clock since power-on, this one included.
    pub tick: u64,
    /// The board's output.
    pub drive: Drive,
    /// Friction under the finger, with the finger's state.
    pub felt: Felt,
    /// The board's status: a complete [`Status`] on the in-process rig, partial on others.
    pub status: S,
}

/// The board's state as known to a rig after a tick, besides the levels of the pins.
#[derive(Clone, Copy, Debug)]
#[allow(clippy::large_enum_variant, reason = "the in-process rig, the fast one, always has it")]
pub enum BoardView {
    /// The complete status.
    Status(Status),
    /// The board's own tick count only.
    Tick(u32),
    /// Nothing.
    None,
}

/// Why a rig cannot carry out a request.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum RigError {
    /// The rig cannot cause a fault.
    #[error("{rig} cannot cause this fault: {reason}")]
    FaultUnavailable {
        /// Name of the rig.
        rig: &'static str,
        /// The missing ability.
        reason: &'static str,
    },
    /// A number of a fault is out of range.
    #[error(transparent)]
    OutOfRange(#[from] OutOfRange),
    /// The rig has stopped unexpectedly.
    #[error("{rig} has ended: {reason}")]
    Ended {
        /// Name of the rig.
        rig: &'static str,
        /// The reason.
        reason: String,
    },
}

/// A board with a serial line and the world around it, on a clock of ticks.
///
/// Implement this for a new rig to run every scenario on it. Line damage is applied at the host's end of the line, and
/// all expectations are observed from outside the board.
pub trait BoardRig {
    /// Name of the rig in messages.
    fn name(&self) -> &'static str;

    /// The board, whose limits and tick rate are used to compile scenes.
    fn board(&self) -> &Board;

    /// Number of ticks so far. It never decreases.
    fn tick(&self) -> u64;

    /// Time on the host's clock.
    fn now(&self) -> Duration {
        Duration::from_secs_f64(self.tick() as f64 / f64::from(self.board().tick_hz))
    }

    /// Sends bytes from the host.
    fn send(&mut self, bytes: &[u8]) -> Result<(), RigError>;

    /// Whether each tick comes with a [`BoardView::Status`].
    fn sees_board(&self) -> bool {
        false
    }

    /// Runs the rig until this call has received bytes for the host, which it appends to `received`, until there are
    /// [touch frames](Self::take_touch_frames), or until `until_tick`. Passes each tick to `watch`.
    fn run(&mut self, until_tick: u64, received: &mut Vec<u8>, watch: &mut dyn FnMut(&RigTick))
    -> Result<(), RigError>;

    /// Frames with touch reports for the host to send. Empty for a board with its own touch source.
    fn take_touch_frames(&mut self) -> Vec<u8> {
        Vec::new()
    }

    /// Causes a fault from now on, for this many ticks if it has a duration.
    fn cause(&mut self, fault: RigFault, ticks: u64) -> Result<(), RigError>;

    /// Starts the finger's stroke.
    fn start_stroke(&mut self);

    /// Releases the arm switch and presses it again, and returns the ticks until the board has registered it. Does
    /// nothing on a rig without a simulated person at the switch.
    fn press_switch(&mut self) -> u64 {
        0
    }

    /// Largest delay between a request and its effect, or between an event and its observation, in ticks.
    fn lateness_ticks(&self) -> u64 {
        0
    }
}
