//! The watchdog: resets the chip when the main loop or the tick stops (RP2040, 4.7, "Watchdog"). The firmware resets
//! itself through it, too, because nothing else that software can do resets the state machines of the PIOs.

use cortex_m::asm;
use frixel_board::hardware::{self, Watchdog as _};
use rp_pac::{PSM, WATCHDOG};

use crate::chip::WATCHDOG_COUNTS_PER_TICK;

/// Watchdog timeout with the fastest allowed ring oscillator, us; the slowest one makes it up to seven times as long.
/// The main loop and the tick must both run within this time. No limit of the output depends on it.
const LIFE_US: u32 = 500_000;

/// The watchdog.
pub struct Watchdog(());

impl Watchdog {
    /// Starts the watchdog.
    pub fn start() -> Self {
        reset_all_but_oscillators();
        let mut watchdog = Self(());
        watchdog.feed();
        WATCHDOG.ctrl().write(|w| w.set_enable(true));
        watchdog
    }
}

impl hardware::Watchdog for Watchdog {
    fn feed(&mut self) {
        WATCHDOG.load().write(|w| w.set_load(LIFE_US * WATCHDOG_COUNTS_PER_TICK));
    }

    fn let_debugger_stop_it(&mut self, may_stop: bool) {
        WATCHDOG.ctrl().modify(|w| {
            w.set_pause_dbg0(may_stop);
            w.set_pause_dbg1(may_stop);
            w.set_pause_jtag(may_stop);
        });
    }
}

/// Resets the chip.
pub(crate) fn reset() -> ! {
    reset_all_but_oscillators();
    WATCHDOG.ctrl().modify(|w| w.set_trigger(true));
    loop {
        asm::nop();
    }
}

/// Makes a watchdog reset cover everything, including the PIOs and the pins, except the oscillators.
fn reset_all_but_oscillators() {
    PSM.wdsel().write(|w| {
        w.0 = !0;
        w.set_rosc(false);
        w.set_xosc(false);
    });
}
