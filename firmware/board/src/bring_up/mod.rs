//! Bring-up: takes a new board step by step from nothing connected to stored limits. `docs/hardware.md`, "Bring-up",
//! describes the steps for the person who does them.
//!
//! [`run`] is the script. It says what to do and asks for readings through a [`Bench`], which the board implements.
//! These hold whatever board and person do:
//!
//! - The script keeps nothing over a reset: each start begins with the checks without voltage and the test of the
//!   switch.
//! - Every step gates the next. A reading out of its range, a check that fails and a fault end the script with a
//!   [`Stop`]; only a reset begins it again.
//! - [`Bench::drive`] takes a [`Pressed`], which only a release of the arm switch and a press after it make.
//! - Voltage comes from the firmware's own session, ticker and supervisor, to which [`Drive`] is the host. Bring-up has
//!   no way to clear a fault.

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

/// A line that a person has typed.
pub type Line = heapless::String<LINE_MAX_LEN>;

/// Levels of the board's inputs, neither debounced nor latched.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Inputs {
    /// The amplifier reports that it can drive.
    pub amplifier_ready: bool,
    /// The contact of the arm switch is closed.
    pub switch_closed: bool,
}

/// The output of the board while it waits for a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum TestOutput {
    /// Amplifier enable and DAC clear are low, and SYNC is high.
    Zero,
    /// The DAC puts out a voltage, in V. The amplifier is disabled.
    Dac(f32),
    /// The DAC puts out zero.
    Enable {
        /// Amplifier enable is kicked.
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
    /// In every period, as the tick lets it.
    EveryPeriod,
    /// Every 2 ms, which is longer than an external monostable may wait for it.
    Every2Ms,
}

/// The checks that a board makes by itself. None of them drives anything behind the DAC.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Check {
    /// The memory in which limits are stored can be written while the firmware runs.
    Storage,
    /// Amplifier enable and DAC clear are low without a kick, high after one, low again within 1 ms of the last one,
    /// and low at once when told so.
    OneShot,
    /// A panic, a fault, a stack overflow and a hang have each reset the board and stored why ([`FAULTS`]). The board
    /// resets meanwhile, and the script begins again.
    FaultsAreStored,
    /// The DAC is configured and has been read back.
    Dac,
    /// The tick and the watchdog run from now on. In one second there are as many ticks as the board claims, none of
    /// them late, and the supervisor has found no fault.
    Ticks,
}

/// A board and the person in front of it.
pub trait Bench {
    /// Shows a line of text to the person.
    fn say(&mut self, text: fmt::Arguments<'_>);

    /// Waits for a line from the person, without its end. Before [`Check::Ticks`], the board puts out `output`
    /// meanwhile, as long as the amplifier is not ready, and zero otherwise.
    fn read_line(&mut self, output: TestOutput) -> Line;

    /// Does a check; `false` if it failed. Says what was wrong.
    fn check(&mut self, check: Check) -> bool;

    /// The inputs now.
    fn inputs(&mut self) -> Inputs;

    /// Whether the arm switch is held, as the firmware sees it; `false` after each disarming until it was released and
    /// pressed. Called after [`Check::Ticks`].
    fn switch_is_held(&mut self) -> bool;

    /// Drives a square wave of `peak_v` with a [`Drive`], and returns with the output at zero. Called after
    /// [`Check::Ticks`].
    fn drive(&mut self, pressed: Pressed, peak_v: f32) -> Result<Reading, DriveError>;

    /// Whether limits are within what the board may store. Says what is not.
    fn may_store(&mut self, limits: &BoardLimits) -> bool;

    /// Stores limits while the tick runs, and reads them back; `false` if that failed or made a tick late.
    fn store(&mut self, limits: &BoardLimits) -> bool;
}
