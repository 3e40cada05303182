//! Self-test: measures a new board with a few wires between its own pins, without DAC, amplifier and voltage.
//! `docs/first-board.md` describes it for the person who does it.
//!
//! [`run`] is the script. It drives and measures the pins through a [`LoopedBoard`], which the board implements, and
//! says each [`Measurement`] in a line that a program can read: `frixel board selftest --wires` writes them to a
//! report. These hold whatever board and person do:
//!
//! - It ends when the amplifier's ready is high or the arm switch is closed: at once during a pulse of the enable, else
//!   before the next measurement. It ends, too, while the monitor's pin is driven or not at zero volts.
//! - The enable is pulsed only after its wire was found with the enable low, and the person has said that the amplifier
//!   is unplugged. It is low whenever the tick runs: [`LoopedBoard::round`] kicks nothing and sends zeros to the DAC.
//! - A missing wire ends it. A measurement out of its range does not: the rest is measured, and all of it is reported.

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
pub use measurement::{Measurement, Said};
pub use script::{GREETING, LINE_TEST, SKIP, Stop, UNPLUGGED, run};

/// Version of the lines that the script says. A change of their form or meaning changes it.
pub const VERSION: u32 = 1;

/// The wires of the self-test, but for the one from SDI to SDO, on which nothing rests.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wire {
    /// SCLK to the input that counts it. It rests high.
    Clock,
    /// SYNC to a capture. It rests high.
    Sync,
    /// The processor's enable to a capture. It rests low.
    Enable,
    /// A voltage of the processor to the monitor's input. It rests undriven.
    Monitor,
}

/// What the input at the end of a wire reads through a weak resistor to either side.
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

/// A fall of the enable, as it was captured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fall {
    /// Its cycle.
    pub at: u32,
    /// It is not the first one since [`LoopedBoard::forget_edges`].
    pub had_fallen_before: bool,
}

/// What the script needs of a round of the main loop.
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
    /// Cycle of the tick's period at which a code is put out.
    const LATCH_CYCLES: u32;
    /// Time from the last kick until the enable falls, us.
    const ONE_SHOT_US: u32;
    /// Cycles of [`LoopedBoard::cycles`] in a microsecond.
    const CYCLES_PER_US: u32;
    /// Voltage of the monitor's pin for 0 V at the amplifier, mV.
    const MONITOR_ZERO_MV: u32;
    /// Voltage of the monitor's pin for one volt at the amplifier, mV.
    const MONITOR_MV_PER_V: f32;

    /// The board's description.
    fn board(&self) -> &Board;

    /// Shows a line of text to the person.
    fn say(&mut self, text: fmt::Arguments<'_>);

    /// Waits for a line from the person, without its end.
    fn read_line(&mut self) -> Line;

    /// What has to go on while the script waits, before [`LoopedBoard::start_ticks`].
    fn idle(&mut self);

    /// The inputs now, as the pins show them. Called all the while that the enable may be high: it does not wait.
    fn inputs(&mut self) -> Inputs;

    /// The levels at the end of a wire, with the pins at its beginning at rest. That of the monitor is driven by
    /// nothing.
    fn levels(&mut self, wire: Wire) -> Levels;

    /// Drives this voltage into the monitor's wire, and returns what the monitor's ADC reads, in mV. The wire is driven
    /// from then on.
    fn loop_mv(&mut self, driven_mv: u32) -> u32;

    /// Sends bytes over SDI, and replaces them by what SDO received meanwhile; `false` if the bus failed.
    fn exchange(&mut self, bytes: &mut [u8]) -> bool;

    /// Sends a frame, and counts its clocks; `None` if SYNC did not fall and rise.
    fn clocks(&mut self) -> Option<Clocks>;

    /// Cycle of the period at which SYNC has risen: of a frame that this sends, and while the tick runs of its last
    /// frame.
    fn latch_cycles(&mut self) -> Option<u32>;

    /// The time, in cycles modulo 2^32.
    fn cycles(&mut self) -> u32;

    /// Forgets the edges of the enable that were captured, and returns the time.
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

    /// Runs the main loop once. `held` is what the tick takes for the arm switch; it takes ready for high, whatever the
    /// pins show, so that it can be armed without an amplifier. What the session sends is discarded.
    fn round(&mut self, held: bool) -> Round<'_>;

    /// How long the ticks have taken since their start.
    fn tick_times(&mut self) -> TickTimes;

    /// Takes received bytes, and returns their number, without waiting.
    fn read(&mut self, bytes: &mut [u8]) -> usize;

    /// Begins to send bytes, and returns the number of those that were taken, without waiting.
    fn write(&mut self, bytes: &[u8]) -> usize;
}
