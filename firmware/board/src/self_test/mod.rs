//! Self-test: measures a new board with a few wires between its own pins, without DAC, amplifier and voltage.
//! `docs/board/first-board.md` describes it for the person who performs it.
//!
//! [`run`] is the script. It drives and measures the pins through a [`LoopedBoard`], which the board implements, and
//! prints each [`Measurement`] as a machine-readable line: `frixel board selftest --wires` writes them to a report. The
//! following holds for any behaviour of board and person:
//!
//! - It ends when the amplifier's ready is high or the arm switch is closed: at once during a pulse of the enable,
//!   otherwise before the next measurement. It also ends if the monitor's pin is driven, or not at zero volts.
//! - The enable is pulsed only after its wire was found with the enable low, and the person has confirmed that the
//!   amplifier is unplugged. It is low whenever the tick runs: [`LoopedBoard::round`] kicks nothing and sends zeros to
//!   the DAC.
//! - A missing wire ends it. A measurement out of range does not: the rest is measured, and everything is reported.

mod enable;
mod line;
mod load;
mod measurement;
mod script;

use core::fmt;

use frixel_control::{Board, Status};
use frixel_session::Session;
use frixel_wire::message::TickTimes;

pub use crate::bring_up::{Inputs, Line, LineReader, Typed};
pub use line::LineTest;
pub use measurement::{Measurement, ScriptLine};
pub use script::{GREETING, LINE_TEST, SKIP, Stop, UNPLUGGED, run};

/// Version of the printed lines, which changes with their form or meaning.
pub const VERSION: u32 = 1;

/// The wires of the self-test, except the one from SDI to SDO, which has no resting level.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wire {
    /// From SCLK to the input that counts it; high at rest.
    Clock,
    /// From SYNC to a capture; high at rest.
    Sync,
    /// From the processor's enable to a capture; low at rest.
    Enable,
    /// From a voltage of the processor to the monitor's input; undriven at rest.
    Monitor,
}

/// Readings of the input at the end of a wire with a weak resistor to either side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Levels {
    /// Its level while it is pulled up.
    pub pulled_up: bool,
    /// Its level while it is pulled down.
    pub pulled_down: bool,
}

impl Levels {
    /// Something drives the input high.
    pub const HIGH: Self = Self { pulled_up: true, pulled_down: true };
    /// Something drives the input low.
    pub const LOW: Self = Self { pulled_up: false, pulled_down: false };
    /// Nothing drives the input.
    pub const FREE: Self = Self { pulled_up: true, pulled_down: false };
}

/// Clocks of one frame, counted at SCLK.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Clocks {
    /// From the start of the frame until SYNC fell.
    pub before: u16,
    /// While SYNC was low.
    pub inside: u16,
    /// From the rise of SYNC to the end of the period.
    pub after: u16,
}

/// A captured fall of the enable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fall {
    /// Its cycle.
    pub at: u32,
    /// Whether it is not the first one since [`LoopedBoard::forget_edges`].
    pub had_fallen_before: bool,
}

/// The data of a round of the main loop needed by the script.
pub struct Round<'b> {
    /// The last status of the tick.
    pub status: &'b Status,
    /// Ticks since reset, modulo 2^32.
    pub now_tick: u32,
    /// The session.
    pub session: &'b mut Session<'static>,
}

/// A board with its wires, and the person at its serial port.
pub trait LoopedBoard {
    /// Cycle of the tick's period at which a code is latched.
    const LATCH_CYCLES: u32;
    /// Time from the last kick until the enable falls, us.
    const ONE_SHOT_US: u32;
    /// Cycles of [`LoopedBoard::cycles`] per microsecond.
    const CYCLES_PER_US: u32;
    /// Voltage of the monitor's pin for 0 V at the amplifier, mV.
    const MONITOR_ZERO_MV: u32;
    /// Voltage of the monitor's pin per volt at the amplifier, mV.
    const MONITOR_MV_PER_V: f32;

    /// The board's description.
    fn board(&self) -> &Board;

    /// Shows a line of text to the person.
    fn say(&mut self, text: fmt::Arguments<'_>);

    /// Waits for a line from the person, without its end.
    fn read_line(&mut self) -> Line;

    /// Background work while the script waits, before [`LoopedBoard::start_ticks`].
    fn idle(&mut self);

    /// The current levels of the input pins. Called throughout while the enable may be high; does not wait.
    fn inputs(&mut self) -> Inputs;

    /// The levels at the end of a wire, with the pins at its start at rest. The monitor's wire is undriven.
    fn levels(&mut self, wire: Wire) -> Levels;

    /// Drives this voltage into the monitor's wire, and returns the reading of the monitor's ADC, in mV. The wire stays
    /// driven.
    fn loop_mv(&mut self, driven_mv: u32) -> u32;

    /// Sends bytes over SDI, and replaces them by the bytes received on SDO; `false` if the bus failed.
    fn exchange(&mut self, bytes: &mut [u8]) -> bool;

    /// Sends a frame, and counts its clocks; `None` if SYNC did not fall and rise.
    fn clocks(&mut self) -> Option<Clocks>;

    /// Cycle of the period at which SYNC rose: for a frame sent by this call or, while the tick runs, for its last
    /// frame.
    fn latch_cycles(&mut self) -> Option<u32>;

    /// The time, in cycles modulo 2^32.
    fn cycles(&mut self) -> u32;

    /// Discards the captured edges of the enable, and returns the time.
    fn forget_edges(&mut self) -> u32;

    /// Kicks the enable, with the DAC at zero. It falls by itself [`Self::ONE_SHOT_US`] after the last kick.
    fn kick(&mut self);

    /// Disables the enable at once.
    fn disable(&mut self);

    /// The cycle at which the enable rose since the last call; `None` if it did not.
    fn enable_rose(&mut self) -> Option<u32>;

    /// The last fall of the enable since the last call; `None` if it did not fall.
    fn enable_fell(&mut self) -> Option<Fall>;

    /// Starts the tick and the main loop, with the enable at rest. Called once.
    fn start_ticks(&mut self);

    /// Runs the main loop once. `held` replaces the arm switch for the tick, and ready is always high for it, so that
    /// it can be armed without an amplifier. The session's output is discarded.
    fn round(&mut self, held: bool) -> Round<'_>;

    /// Durations of the ticks since their start.
    fn tick_times(&mut self) -> TickTimes;

    /// Takes received bytes, and returns their number, without waiting.
    fn read(&mut self, bytes: &mut [u8]) -> usize;

    /// Begins to send bytes, and returns the number accepted, without waiting.
    fn write(&mut self, bytes: &[u8]) -> usize;
}
