//! Waiting by the core's clock.

use cortex_m::asm;
use embedded_hal::delay::DelayNs;

/// A delay that counts cycles of a core of `CORE_HZ`; longer when interrupts occur meanwhile.
pub struct CycleDelay<const CORE_HZ: u32>;

impl<const CORE_HZ: u32> DelayNs for CycleDelay<CORE_HZ> {
    fn delay_ns(&mut self, ns: u32) {
        asm::delay((CORE_HZ / 1_000_000).saturating_mul(ns.div_ceil(1000)));
    }
}
