//! Bring-up: takes a new board step by step from nothing connected to stored limits. `docs/board/hardware.md`,
//! "Bring-up", describes the steps for the person who performs them.
//!
//! [`run`] is the script. It gives instructions and asks for readings through a [`Bench`], which the board implements.
//! The following holds for any behaviour of board and person:
//!
//! - The script keeps no state across a reset: each start begins with the checks without voltage and the test of the
//!   switch.
//! - Every step gates the next. A reading out of its range, a failed check or a fault ends the script with a [`Stop`];
//!   only a reset restarts it.
//! - [`Bench::drive`] takes a [`Pressed`], which only a release of the arm switch followed by a press creates.
//! - Voltage comes from the firmware's own session, ticker and supervisor, with [`Drive`] as the host. Bring-up cannot
//!   clear a fault.

mod amplifier;
mod dialogue;
mod drive;
mod enable_path;
mod fault_injection;
mod line_reader;
mod script;

use core::fmt;

use frixel_wire::hello::BoardLimits;

pub use crate::local_host::DriveError;
pub use drive::{Drive, Reading};
pub use fault_injection::{FAULTS, Injection};
pub use line_reader::{LineReader, Typed};
pub use script::{Pressed, Stop, run};

/// Longest line that a person may type, in bytes.
pub const LINE_MAX_LEN: usize = 32;

/// A typed line.
pub type Line = heapless::String<LINE_MAX_LEN>;

/// Levels of the board's inputs, neither debounced nor latched.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Inputs {
    /// Whether the amplifier reports that it can drive.
    pub amplifier_ready: bool,
    /// Whether the contact of the arm switch is closed.
    pub switch_closed: bool,
}

/// The output of the board while it waits for a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TestOutput {
    /// Amplifier enable and DAC clear are low, and SYNC is high.
    Zero,
    /// The DAC outputs a voltage, in V. The amplifier is disabled.
    Dac(f32),
    /// The DAC outputs zero.
    Enable {
        /// Whether the amplifier enable is kicked.
        kicked: bool,
        /// SYNC rises.
        sync: Sync,
    },
}

/// How often SYNC rises.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sync {
    /// Not at all.
    Never,
    /// In every period, like the tick does.
    EveryPeriod,
    /// Every 2 ms, which is too slow for an external monostable.
    Every2Ms,
}

/// The checks that a board performs by itself. None of them drives anything after the DAC.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Check {
    /// The memory for limits can be written while the firmware runs.
    Storage,
    /// Amplifier enable and DAC clear are low without a kick, high after one, low again within 1 ms of the last one,
    /// and low immediately when disabled.
    OneShot,
    /// A panic, a fault, a stack overflow and a hang each reset the board and stored their reason ([`FAULTS`]). The
    /// board resets meanwhile, and the script restarts.
    FaultsAreStored,
    /// The DAC is configured and has been read back.
    Dac,
    /// The tick and the watchdog run from now on. In one second, the number of ticks matches the tick rate, none is
    /// late, and the supervisor has found no fault.
    Ticks,
}

/// A board and the person operating it.
pub trait Bench {
    /// Shows a line of text to the person.
    fn say(&mut self, text: fmt::Arguments<'_>);

    /// Waits for a line from the person, without its end. Before [`Check::Ticks`], the board outputs `output` meanwhile
    /// while the amplifier is not ready, and zero otherwise.
    fn read_line(&mut self, output: TestOutput) -> Line;

    /// Performs a check; `false` if it failed. Shows the reason.
    fn check(&mut self, check: Check) -> bool;

    /// The current inputs.
    fn inputs(&mut self) -> Inputs;

    /// Whether the arm switch is held, as seen by the firmware; `false` after each disarming until it was released and
    /// pressed. Called after [`Check::Ticks`].
    fn switch_is_held(&mut self) -> bool;

    /// Drives a square wave of `peak_v` with a [`Drive`], and returns with the output at zero. Called after
    /// [`Check::Ticks`].
    fn drive(&mut self, pressed: Pressed, peak_v: f32) -> Result<Reading, DriveError>;

    /// Whether limits are within what the board may store. Shows the ones that are not.
    fn may_store(&mut self, limits: &BoardLimits) -> bool;

    /// Stores limits while the tick runs, and reads them back; `false` if that failed or made a tick late.
    fn store(&mut self, limits: &BoardLimits) -> bool;
}
