//! The beginning of every program of this board.

use frixel_board::fault::LastReset;
use frixel_cortex_m::{Boot, guard};
use frixel_drivers::fault_record::Text;

use crate::output::Output;
use crate::period::Period;
use crate::{clock, fault, output, period};

/// Parts of a board that has started: the output is zero, and nothing drives the DAC.
pub struct Started {
    /// For the other parts of the tick.
    pub boot: Boot,
    /// The one-shot.
    pub output: Output,
    /// The timer of the tick, without its interrupt.
    pub period: Period,
    /// The last reset.
    pub last_reset: LastReset,
}

/// Sets the output to zero, guards the stack, takes the cause of the last reset, and starts clocks, one-shot and timer.
pub fn begin(text: &'static mut Text) -> Started {
    output::zero_for_good();
    let (boot, mut core) = Boot::take();
    let output = Output::new(&boot);
    guard::start(&mut core.MPU);
    let last_reset = fault::last_reset(text);
    // First, so that a board that fails during start-up has logged the cause of its last reset.
    last_reset.log();
    clock::start();
    clock::start_peripherals();
    clock::keep_timers_running_in_debug();
    clock::start_cycle_counter(&mut core.DCB, &mut core.DWT);
    let period = period::start(&boot);
    Started { boot, output, period, last_reset }
}
