//! Constants that differ between the two chips, and registers with different names.

use frixel_drivers::rp2::ResetFlags;
use rp_pac::WATCHDOG;

#[cfg(feature = "rp2040")]
pub use rp2040::*;
#[cfg(feature = "rp2350")]
pub use rp2350::*;

#[cfg(feature = "rp2350")]
mod rp2350 {
    use frixel_control::Board;

    /// The board's description, until bring-up has stored other limits.
    pub const BOARD: Board = Board::PICO_2;
    /// Clock of the core, in Hz.
    pub const CORE_HZ: u32 = 150_000_000;
    /// PLL settings: 12 MHz * 125 / 5 / 2.
    pub(crate) const PLL: crate::clock::PllSettings = crate::clock::PllSettings { multiply: 125, divide: [5, 2] };
    /// Interrupts of the chip.
    pub(crate) const INTERRUPTS: usize = 52;
    /// Largest frequency of the ring oscillator: 4.6 to 19.6 MHz are guaranteed (RP2350, 8.1.2.2, "Ring oscillator").
    pub(crate) const RING_OSCILLATOR_MAX_HZ: u32 = 20_000_000;
    /// Counts of the watchdog in a tick.
    pub(crate) const WATCHDOG_COUNTS_PER_TICK: u32 = 1;
}

#[cfg(feature = "rp2040")]
mod rp2040 {
    use frixel_control::Board;

    /// The board's description, until bring-up has stored other limits.
    pub const BOARD: Board = Board::PICO;
    /// Clock of the core, in Hz: the most that the vendor supports, at 1.15 V.
    pub const CORE_HZ: u32 = 200_000_000;
    /// PLL settings: 12 MHz * 100 / 6 / 1.
    pub(crate) const PLL: crate::clock::PllSettings = crate::clock::PllSettings { multiply: 100, divide: [6, 1] };
    /// Interrupts of the chip.
    pub(crate) const INTERRUPTS: usize = 26;
    /// Largest frequency of the ring oscillator: 1.8 to 12 MHz, typically 6.5 (RP2040, 2.17.2, "Frequency Variation").
    pub(crate) const RING_OSCILLATOR_MAX_HZ: u32 = 12_000_000;
    /// Counts of the watchdog in a tick: it decrements twice (erratum RP2040-E1).
    pub(crate) const WATCHDOG_COUNTS_PER_TICK: u32 = 2;
}

/// Ticks a second.
pub const TICK_HZ: u32 = BOARD.tick_hz;

/// The chip's flags about its last reset.
pub(crate) fn reset_flags() -> ResetFlags {
    let reason = WATCHDOG.reason().read();
    let flags = ResetFlags { watchdog_timer: reason.timer(), watchdog_forced: reason.force(), ..ResetFlags::default() };
    #[cfg(feature = "rp2040")]
    {
        let chip = rp_pac::VREG_AND_CHIP_RESET.chip_reset().read();
        ResetFlags { power_on: chip.had_por(), run_pin: chip.had_run(), ..flags }
    }
    #[cfg(feature = "rp2350")]
    {
        let chip = rp_pac::POWMAN.chip_reset().read();
        ResetFlags {
            power_on: chip.had_por(),
            brown_out: chip.had_bor() || chip.had_glitch_detect(),
            run_pin: chip.had_run_low(),
            ..flags
        }
    }
}
