//! The period of the tick: TIM3 divides the core's clock into periods of 25 us. It interrupts at the start of each,
//! and its channel 1 is SYNC of the DAC, whose rising edge, [`LATCH_CYCLES`] into the period, updates the DAC's
//! output. So the timer alone sets the instant of the update, without software (RM0440, "General-purpose timers":
//! "Forced output mode", "Output compare mode").
//!
//! A frame is latched only if the tick has begun it with [`begin_frame`]: without ticks there are no edges.
//!
//! | pin | function | |
//! |---|---|---|
//! | PC6 | TIM3_CH1 | SYNC of the DAC |

use frixel_board::hardware;
use frixel_cortex_m::Boot;
use stm32_metapac::timer::vals::Ocm;
use stm32_metapac::{GPIOC, TIM3};

use crate::clock::CORE_HZ;
use crate::pins;

/// Length of a period, in cycles.
pub const PERIOD_CYCLES: u32 = CORE_HZ / crate::board::TICK_HZ;
/// Cycle of the period at which SYNC rises. The rest of the period is the least time that SYNC is high, 0.9 us.
pub const LATCH_CYCLES: u32 = PERIOD_CYCLES - 150;
/// Latest cycle at which a frame may begin: 24 bits at 21.25 MHz are 192 cycles, doubled for DMA and the first byte.
pub const DEADLINE_CYCLES: u32 = LATCH_CYCLES - 400;

/// PC6.
pub(crate) const SYNC: u32 = 6;
const TIM3_FUNCTION: u8 = 2;

const _: () = assert!(CORE_HZ.is_multiple_of(crate::board::TICK_HZ) && PERIOD_CYCLES <= 1 << 16);

/// TIM3, as the tick uses it.
pub struct Period(());

impl hardware::Period for Period {
    const PERIOD_CYCLES: u32 = PERIOD_CYCLES;
    const DEADLINE_CYCLES: u32 = DEADLINE_CYCLES;

    #[inline]
    fn cycles(&self) -> u32 {
        cycles()
    }

    #[inline]
    fn has_begun(&mut self) -> bool {
        let begun = TIM3.sr().read().uif();
        if begun {
            // Zeros clear flags: this clears all of them, and no other is used.
            TIM3.sr().write(|w| w.set_uif(false));
        }
        begun
    }
}

impl Period {
    /// Waits for the start of the next period. For programs without a tick.
    pub fn wait_for_next(&mut self) {
        let _ = hardware::Period::has_begun(self);
        while !hardware::Period::has_begun(self) {}
    }
}

/// Starts the timer, with SYNC high and without interrupts.
pub fn start(_: &Boot) -> Period {
    TIM3.arr().write(|w| w.set_arr((PERIOD_CYCLES - 1) as u16));
    TIM3.ccr(0).write(|w| w.set_ccr(LATCH_CYCLES as u16));
    end_frame();
    TIM3.ccer().write(|w| w.set_cce(0, true));
    pins::alternate(GPIOC, SYNC, TIM3_FUNCTION);
    TIM3.cr1().modify(|w| w.set_cen(true));
    Period(())
}

/// Enables the interrupt at the start of every period, from the next one on.
pub(crate) fn start_interrupts() {
    TIM3.sr().write(|w| w.set_uif(false));
    TIM3.dier().write(|w| w.set_uie(true));
}

/// Cycles since the period began.
#[inline]
pub fn cycles() -> u32 {
    u32::from(TIM3.cnt().read().cnt())
}

/// Sets SYNC low until the timer raises it.
#[inline]
pub(crate) fn begin_frame() {
    TIM3.ccmr_output(0).write(|w| w.set_ocm(0, Ocm::FORCE_INACTIVE));
    TIM3.ccmr_output(0).write(|w| w.set_ocm(0, Ocm::ACTIVE_ON_MATCH));
}

/// Sets SYNC low until [`end_frame`].
pub(crate) fn hold_sync_low() {
    TIM3.ccmr_output(0).write(|w| w.set_ocm(0, Ocm::FORCE_INACTIVE));
}

/// Sets SYNC high at once.
pub(crate) fn end_frame() {
    TIM3.ccmr_output(0).write(|w| w.set_ocm(0, Ocm::FORCE_ACTIVE));
}
