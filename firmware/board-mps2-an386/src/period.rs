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
    /// The wait of the interrupt, before the tick.
    pub host_wait: HostWait,
}

impl hardware::Period for Period {
    const PERIOD_CYCLES: u32 = PERIOD_COUNTS;
    const DEADLINE_CYCLES: u32 = PERIOD_COUNTS;

    #[inline]
    fn cycles(&self) -> u32 {
        PERIOD_COUNTS - 1 - SYST::get_current()
    }

    /// Whether the next period has begun. The processor acknowledges the interrupt on entry to the handler.
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

/// Stops the board's clock while a connected host has not answered for its time slice. On a busy machine, the board
/// would otherwise run ahead of a host that gets no processor time.
#[derive(Default)]
pub struct HostWait {
    /// [`layout::HOST_ANSWERED_TO`] as it was last read.
    answered_to: u32,
    /// Tick periods for which the clock has stood still at that tick.
    waited: u32,
}

impl HostWait {
    /// Longest wait in tick periods, 10 s. A host that takes longer has hung or was killed, and the host timeout must
    /// act. Virtual time is never ahead of wall time.
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
