//! The independent watchdog: resets the processor when the main loop or the tick stops (RM0440, "Independent
//! watchdog").

use frixel_board::hardware::{self, Watchdog as _};
use stm32_metapac::iwdg::vals::{Key, Pr};
use stm32_metapac::{DBGMCU, IWDG};

use crate::{clock, wait_until};

/// Reload value, in counts of 4 clocks of the 32 kHz oscillator: 100 ms. The longest operation of the main loop, the
/// table of a committed scene, takes 14 ms on the emulated board.
const RELOAD: u16 = 800;

/// The watchdog.
pub struct Watchdog(());

impl Watchdog {
    /// Starts the watchdog. It cannot be stopped again.
    pub fn start() -> Self {
        IWDG.kr().write(|w| w.set_key(Key::START));
        IWDG.kr().write(|w| w.set_key(Key::ENABLE));
        IWDG.pr().write(|w| w.set_pr(Pr::DIVIDE_BY4));
        IWDG.rlr().write(|w| w.set_rl(RELOAD));
        wait_until(|| !IWDG.sr().read().pvu() && !IWDG.sr().read().rvu(), "the watchdog");
        let mut watchdog = Self(());
        watchdog.let_debugger_stop_it(false);
        feed();
        watchdog
    }
}

impl hardware::Watchdog for Watchdog {
    fn feed(&mut self) {
        feed();
    }

    fn let_debugger_stop_it(&mut self, may_stop: bool) {
        if DBGMCU.apb1lfzr().read().iwdg() != may_stop {
            DBGMCU.apb1lfzr().modify(|w| w.set_iwdg(may_stop));
        }
        clock::keep_timers_running_in_debug();
    }
}

/// Feeds the watchdog regardless of ticks, for a program that has not started them. A watchdog that runs from reset on
/// (option byte `IWDG_SW`) would otherwise reset it after half a second. Has no effect while the watchdog is stopped.
pub fn feed() {
    IWDG.kr().write(|w| w.set_key(Key::RESET));
}
