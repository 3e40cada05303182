//! The independent watchdog: resets when main loop or tick stand still (RM0440, "Independent watchdog").

use stm32_metapac::iwdg::vals::{Key, Pr};
use stm32_metapac::{DBGMCU, IWDG};

use crate::{tick, wait_until};

/// Counts until it resets, of 4 clocks of its oscillator, 32 kHz: 100 ms. The longest that the main loop does in one go: the table of a
/// scene that is committed, 14 ms when it was measured on the emulated board (2026-11-20), and the check of a scene that was written, 85 KiB through a CRC
/// without a table, some 30 ms.
const RELOAD: u16 = 800;

/// The watchdog.
pub struct Watchdog {
    fed_at_tick: u32,
}

impl Watchdog {
    /// Starts it. It cannot be stopped again.
    pub fn start() -> Self {
        IWDG.kr().write(|w| w.set_key(Key::START));
        IWDG.kr().write(|w| w.set_key(Key::ENABLE));
        IWDG.pr().write(|w| w.set_pr(Pr::DIVIDE_BY4));
        IWDG.rlr().write(|w| w.set_rl(RELOAD));
        wait_until(|| !IWDG.sr().read().pvu() && !IWDG.sr().read().rvu(), "the watchdog");
        let mut watchdog = Self { fed_at_tick: tick::count() };
        watchdog.freeze_with_debugger(false);
        feed();
        watchdog
    }

    /// Feeds it, if there was a tick since.
    pub fn feed(&mut self) {
        let now_tick = tick::count();
        if now_tick != self.fed_at_tick {
            self.fed_at_tick = now_tick;
            feed();
        }
    }

    /// Whether it waits while a debugger halts the core: only when the board is disarmed.
    pub fn freeze_with_debugger(&mut self, freeze: bool) {
        if DBGMCU.apb1lfzr().read().iwdg() != freeze {
            DBGMCU.apb1lfzr().modify(|w| w.set_iwdg(freeze));
        }
    }
}

fn feed() {
    IWDG.kr().write(|w| w.set_key(Key::RESET));
}
