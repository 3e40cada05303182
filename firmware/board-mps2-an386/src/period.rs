//! The period of the tick: `SysTick` at 40 kHz, in counts of 40 ns.

use cortex_m::peripheral::syst::SystClkSource;
use cortex_m::peripheral::{SCB, SYST};
use frixel_board::hardware;
use frixel_exchange::{BOARD, layout};

use crate::shared;

/// Clock of `SysTick` on this machine.
const CLOCK_HZ: u32 = 25_000_000;
const PERIOD_COUNTS: u32 = CLOCK_HZ / BOARD.tick_hz;

/// `SysTick`, as the tick uses it. The simulator takes a drive whenever it comes, so the deadline is the period.
#[derive(Default)]
pub struct Period {
    /// Of the interrupt, before the tick.
    pub host_wait: HostWait,
}

impl hardware::Period for Period {
    const PERIOD_CYCLES: u32 = PERIOD_COUNTS;
    const DEADLINE_CYCLES: u32 = PERIOD_COUNTS;

    #[inline]
    fn cycles(&self) -> u32 {
        PERIOD_COUNTS - 1 - SYST::get_current()
    }

    /// Entry to the handler has acknowledged its own interrupt.
    #[inline]
    fn has_begun(&mut self) -> bool {
        SCB::is_pendst_pending()
    }
}

/// Starts the timer and its interrupt.
pub fn start(mut systick: SYST) {
    systick.set_clock_source(SystClkSource::Core);
    systick.set_reload(PERIOD_COUNTS - 1);
    systick.clear_current();
    systick.enable_interrupt();
    systick.enable_counter();
}

/// Stops the board's clock while a host is connected and has not answered for its slice of time: a busy machine would
/// otherwise let the board run on while it does not let the host run at all.
#[derive(Default)]
pub struct HostWait {
    /// [`layout::HOST_ANSWERED_TO`] as it was last read.
    answered_to: u32,
    /// Tick periods that the clock has stood still there.
    waited: u32,
}

impl HostWait {
    /// Tick periods after which the board no longer waits, 10 s: the host has hung, or was killed, and its host timeout
    /// has to act. Virtual time is never ahead of wall time.
    const MAX: u32 = 10 * BOARD.tick_hz;

    /// Whether the clock stands still in this tick period.
    pub fn is_needed(&mut self) -> bool {
        let answered_to = shared::get(layout::HOST_ANSWERED_TO);
        if answered_to != self.answered_to {
            *self = Self { answered_to, waited: 0 };
        }
        // Both counts wrap at 2^32; their difference always fits in an `i32`.
        let is_ahead = shared::get(layout::DRIVES_WRITTEN).wrapping_sub(answered_to).cast_signed() >= 0;
        if shared::get(layout::HOST_OPEN) == 0 || !is_ahead || self.waited >= Self::MAX {
            return false;
        }
        self.waited += 1;
        true
    }
}
