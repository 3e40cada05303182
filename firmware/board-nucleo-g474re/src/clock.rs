//! The processor's clock: 170 MHz from the internal oscillator, which needs no crystal. Its accuracy of 1 % is within
//! the tolerance of a serial port: 3.3 % between both sides, for the divider in use (RM0440, "Tolerance of the USART
//! receiver to clock deviation", not read).

use cortex_m::asm;
use cortex_m::peripheral::{DCB, DWT};
use stm32_metapac::rcc::vals::{Hpre, Pllm, Plln, Pllr, Pllsrc, Ppre, Sw};
use stm32_metapac::{DBGMCU, FLASH, PWR, RCC};

use crate::wait_until;

/// Clock of the core, of both peripheral buses and of all timers, in Hz.
pub const CORE_HZ: u32 = 170_000_000;

/// Switches to 170 MHz: boost mode of voltage range 1, four wait states, PLL of 16 MHz / 4 * 85 / 2
/// (RM0440, "Dynamic voltage scaling management", "Read access latency", "PLL").
pub fn start() {
    RCC.apb1enr1().modify(|w| w.set_pwren(true));
    let _ = RCC.apb1enr1().read();
    // Otherwise PB6, amplifier enable, is pulled down by 5 kOhm for USB-C (RM0440, "PWR_CR3"), which is useful only in
    // reset.
    PWR.cr3().modify(|w| w.set_ucpd1_dbdis(true));

    FLASH.acr().modify(|w| {
        w.set_latency(stm32_metapac::flash::vals::Latency::WS4);
        w.set_prften(true);
        w.set_icen(true);
        w.set_dcen(true);
    });
    wait_until(|| FLASH.acr().read().latency() == stm32_metapac::flash::vals::Latency::WS4, "the flash's wait states");

    // Boost mode before the PLL runs: the normal mode of range 1 ends at 150 MHz.
    PWR.cr5().modify(|w| w.set_r1mode(false));
    RCC.pllcfgr().write(|w| {
        w.set_pllsrc(Pllsrc::HSI);
        w.set_pllm(Pllm::DIV4);
        w.set_plln(Plln::MUL85);
        w.set_pllr(Pllr::DIV2);
        w.set_pllren(true);
    });
    RCC.cr().modify(|w| w.set_pllon(true));
    wait_until(|| RCC.cr().read().pllrdy(), "the PLL");

    // Above 80 MHz, the core must first run at half the frequency for at least 1 us (RM0440, "System clock (SYSCLK)").
    RCC.cfgr().modify(|w| w.set_hpre(Hpre::DIV2));
    RCC.cfgr().modify(|w| w.set_sw(Sw::PLL1_R));
    wait_until(|| RCC.cfgr().read().sws() == Sw::PLL1_R, "the PLL as system clock");
    asm::delay(CORE_HZ / 1_000_000);
    RCC.cfgr().modify(|w| {
        w.set_hpre(Hpre::DIV1);
        w.set_ppre1(Ppre::DIV1);
        w.set_ppre2(Ppre::DIV1);
    });
}

/// Enables the peripherals that the board uses, except the pins.
pub fn start_peripherals() {
    RCC.ahb1enr().modify(|w| {
        w.set_dma1en(true);
        w.set_dmamux1en(true);
    });
    RCC.ahb2enr().modify(|w| w.set_adc12en(true));
    RCC.apb1enr1().modify(|w| {
        w.set_tim3en(true);
        w.set_spi2en(true);
        w.set_usart2en(true);
        w.set_i2c3en(cfg!(feature = "optical-frame"));
    });
    // A peripheral is accessible two clocks after its enable (RM0440, "Peripheral clock enable register"); the read
    // takes them.
    let _ = RCC.apb1enr1().read();
}

/// A delay of this core.
pub type CycleDelay = frixel_cortex_m::CycleDelay<CORE_HZ>;

/// Starts the cycle counter and checks that it counts. The counter of an emulator stands still, and every time limit
/// measured with it would be met.
pub fn start_cycle_counter(dcb: &mut DCB, dwt: &mut DWT) {
    dcb.enable_trace();
    dwt.enable_cycle_counter();
    let before = DWT::cycle_count();
    asm::delay(100);
    let counted = DWT::cycle_count().wrapping_sub(before);
    assert!(counted >= 100, "the cycle counter does not count");
}

/// Keeps the one-shot timer running while a debugger halts the core, so that the output goes to zero (RM0440, "Debug
/// support for timers"). To be called repeatedly, because a debugger may change the setting.
pub fn keep_timers_running_in_debug() {
    let frozen = DBGMCU.apb1lfzr().read();
    if frozen.tim3() || frozen.tim4() {
        DBGMCU.apb1lfzr().modify(|w| {
            w.set_tim3(false);
            w.set_tim4(false);
        });
    }
}
