//! What every rig has: a board with a serial line, and a world around it. A scenario runs on any of them.

use core::time::Duration;

use frixel_control::{Board, Drive, Status};
use thiserror::Error;

use crate::{Felt, OutOfRange, WorldFault};

/// A fault of a rig: of the board, or of the world around it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RigFault {
    /// Of the world, for as long as it is said.
    World(WorldFault),
    /// The board is reset.
    Reset,
    /// The board is reset, and finds wrong option bytes from then on.
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
    /// What the finger felt.
    pub felt: Felt,
    /// The board's status: a [`Status`] on the rig in this process, and on any rig what it knows of one.
    pub status: S,
}

/// What a rig knows of its board after a tick, beyond the levels of the pins.
#[derive(Clone, Copy, Debug)]
#[allow(clippy::large_enum_variant, reason = "the in-process rig, the fast one, always has it")]
pub enum BoardView {
    /// All that the board could report.
    Status(Status),
    /// The board's own count of the tick.
    Tick(u32),
    /// Nothing.
    None,
}

/// Why a rig does not do what it is asked for.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum RigError {
    /// The rig cannot cause a fault.
    #[error("{rig} cannot cause this fault: {reason}")]
    FaultUnavailable {
        /// Name of the rig.
        rig: &'static str,
        /// What it lacks.
        reason: &'static str,
    },
    /// A fault has a number that nothing has.
    #[error(transparent)]
    OutOfRange(#[from] OutOfRange),
    /// The rig has ended by itself.
    #[error("{rig} has ended: {reason}")]
    Ended {
        /// Name of the rig.
        rig: &'static str,
        /// The reason in its words.
        reason: String,
    },
}

/// A board with a serial line, and the world around it, on a clock of ticks.
///
/// A rig that is new implements this, and every scenario runs on it: the line's damage is made by the host's end of the
/// line, and everything that is expected is seen from outside of the board.
pub trait BoardRig {
    /// Name of the rig in messages.
    fn name(&self) -> &'static str;

    /// The board, with the limits and the tick rate for which scenes are compiled.
    fn board(&self) -> &Board;

    /// Ticks that have passed. It never decreases.
    fn tick(&self) -> u64;

    /// The host's time.
    fn now(&self) -> Duration {
        Duration::from_secs_f64(self.tick() as f64 / f64::from(self.board().tick_hz))
    }

    /// Sends bytes from the host.
    fn send(&mut self, bytes: &[u8]) -> Result<(), RigError>;

    /// Whether each tick comes with a [`BoardView::Status`].
    fn sees_board(&self) -> bool {
        false
    }

    /// Lets the rig run until bytes have arrived at the host in this call, which it appends to `received`, until there
    /// are [touch frames](Self::take_touch_frames), or until `until_tick`. Passes each tick to `watch`.
    fn run(&mut self, until_tick: u64, received: &mut Vec<u8>, watch: &mut dyn FnMut(&RigTick))
    -> Result<(), RigError>;

    /// Frames with reports of the touch source that the host has to send. A board with a touch source of its own has
    /// none.
    fn take_touch_frames(&mut self) -> Vec<u8> {
        Vec::new()
    }

    /// Causes a fault from now on, for so many ticks if it lasts.
    fn cause(&mut self, fault: RigFault, ticks: u64) -> Result<(), RigError>;

    /// Starts the finger's stroke.
    fn start_stroke(&mut self);

    /// Lets the person at the arm switch let go of it and press it again, and returns the ticks until the board has
    /// seen it. Without a person who waits to be asked, this does nothing.
    fn press_switch(&mut self) -> u64 {
        0
    }

    /// Most ticks between a request and its effect, or between an event and the time at which it is seen.
    fn lateness_ticks(&self) -> u64 {
        0
    }
}
